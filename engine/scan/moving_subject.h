// Frames of one camera of a person who moves, and a rough body that tells where to: what the
// scanners of moving people are fed.
#pragma once

#include "scan/closing.h"
#include "scan/intake.h"
#include "scan/template_motion.h"

namespace toile::scan {

/// A view and its number among all frames.
struct NumberedView {
    std::uint32_t number = 0;
    DepthView view;
};

struct MovingSubjectOptions {
    FilterOptions filter;
    bool choose_radius = true;   ///< rougher readings are smoothed more widely
    std::size_t most_views = 72; ///< kept of all frames, spread evenly
};

class MovingSubject {
  public:
    /// \throw Error for impossible intrinsics
    MovingSubject(IntakeCamera camera, const MovingSubjectOptions& options, RowLoop rows);

    /// As `Intake::view`.
    void add(std::span<const float> depth, std::span<const Rgba8> color);
    /// The body as it stood at a frame, counted from 0; in the camera's world or, without one, in
    /// its frame. `labels` (nv) or none. \throw Error when it is another surface than before
    void guide(std::uint32_t instant, geometry::TriangleMesh body,
               std::span<const std::uint8_t> labels);

    /// \throw Error when nobody was seen, saying why
    void check() const;
    /// All views from the first guided frame on; only once.
    [[nodiscard]] std::vector<NumberedView> take_views();

    [[nodiscard]] const Intake& intake() const { return intake_; }
    [[nodiscard]] bool guided() const { return !poses_.empty(); }
    [[nodiscard]] const std::vector<NumberedView>& views() const { return views_; }
    /// At the first guided instant, before the camera.
    [[nodiscard]] const geometry::TriangleMesh& shape() const { return shape_; }
    [[nodiscard]] const std::vector<std::uint8_t>& labels() const { return labels_; }
    [[nodiscard]] const TemplatePoses& poses() const { return poses_; }

  private:
    void thin();

    MovingSubjectOptions options_;
    Intake intake_;
    std::vector<NumberedView> views_;
    std::uint32_t stride_ = 1; // every so many frames are kept
    geometry::TriangleMesh shape_;
    std::vector<std::uint8_t> labels_;
    TemplatePoses poses_;
};

} // namespace toile::scan
