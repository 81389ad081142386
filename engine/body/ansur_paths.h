// The measurements of ANSUR II (NATICK/TR-15/007), read on the template along ANSUR's own paths,
// with derivatives. Populations are matched on these; tailors' (ISO 8559-1) are another matter.
#pragma once

#include "body/avatar_template.h"
#include "body/body_model.h"
#include "body/tape.h"
#include "body/target_basis.h"

#include <string>
#include <vector>

namespace toile::body {

/// One measurement of a person; metres, kilograms for the weight.
struct AnsurMeasure {
    const char* name;   ///< ours: "ansur_waist_girth"
    const char* column; ///< ANSUR's: "waistcircumference"
    double factor;      ///< what ANSUR's value is multiplied with to compare with the template's
    bool matched;       ///< the population's statistics are held to it; else it only guides
};

/// In the order of `AnsurPaths::measure`.
[[nodiscard]] const std::vector<AnsurMeasure>& ansur_measures();

inline constexpr double kBodyDensity = 1000.0; ///< kg/m^3, lungs half filled

/// Reads bodies on the template. Landmarks are vertices, found once on the template's own shape.
class AnsurPaths {
  public:
    AnsurPaths(const AvatarTemplate& avatar, std::span<const Part> parts);

    [[nodiscard]] std::vector<Measured> measure(const BodyShape& body) const;

  private:
    void find_marks(std::span<const Part> labels);
    [[nodiscard]] std::vector<Triangle>
    triangles_of(std::span<const Part> parts, std::span<const Part> labels, bool left_only) const;

    const AvatarTemplate& avatar_;
    std::vector<Triangle> trunk_, seat_, neck_, arm_, leg_;
    std::vector<std::uint32_t> seat_back_; ///< vertices where the buttock may stand out most
    std::vector<std::uint32_t> soles_;
    std::uint32_t crown_, nipple_, navel_, crotch_, acromion_, radiale_, stylion_, cervicale_,
        patella_;
};

} // namespace toile::body
