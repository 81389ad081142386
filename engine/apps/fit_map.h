// The fit drawn on garments: colours for room or stretch, and the legend beside the picture.
#pragma once

#include "garment/cloth_strain.h"
#include "garment/fit.h"
#include "garment/skin_gap.h"
#include "pipeline/dressed_person.h"
#include "render/renderer.h"

#include <string>
#include <vector>

namespace toile::apps {

enum class FitMapKind { none, ease, strain };

/// "", "ease", "strain". \throw UsageError
[[nodiscard]] FitMapKind fit_map_from_name(const std::string& name);

/// What each render vertex of a dressed person is coloured by. Ease: how far the cloth stands off
/// the skin, 0 to 6 cm. Strain: the larger stretch of warp and weft, 0 to 10 %. Not movable.
class FitMap {
  public:
    /// \throw Error when a garment cannot be measured
    FitMap(const pipeline::DressedPerson& person, FitMapKind kind);
    FitMap(const FitMap&) = delete;
    FitMap& operator=(const FitMap&) = delete;

    /// Of the person as it stands now. Allocates nothing. [frame]
    void update() noexcept;

    /// Texture coordinates (nr) of a garment's surface into `material`.
    [[nodiscard]] std::span<const Vec2f> texcoords(std::size_t garment, std::size_t surface) const {
        return garments_[garment].texcoords[surface];
    }
    /// \throw Error
    [[nodiscard]] render::MaterialId material(render::Renderer& renderer) const;
    [[nodiscard]] FitMapKind kind() const { return kind_; }

  private:
    struct Mapped {
        garment::SkinGap gap;
        garment::ClothStrain strain;
        std::vector<float> simulation;             ///< (nv) share of the scale
        std::vector<float> values;                 ///< (largest surface)
        std::vector<std::vector<Vec2f>> texcoords; ///< per surface (nr)
    };
    void measure(Mapped& mapped, const pipeline::WornGarment& worn) const noexcept;

    const pipeline::DressedPerson& person_;
    FitMapKind kind_;
    std::vector<Mapped> garments_;
};

/// The scale in words and colours, and below it what each region's verdict is (if `fit` is given).
/// As high as the picture beside it, pixels.
[[nodiscard]] imaging::Image fit_legend(FitMapKind kind, int height,
                                        const garment::FitReport* fit = nullptr);

} // namespace toile::apps
