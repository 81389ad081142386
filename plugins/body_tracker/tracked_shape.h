// The shape of somebody who is tracked as the plugin boundary tells it.
#pragma once

#include "abi/body.h"
#include "body/fit_model.h"

#include <memory>
#include <vector>

namespace toile::body_tracker {

/// Owns what `abi` points to; made anew for every shape.
class TrackedShape {
  public:
    TrackedShape(const body::FitModel& model, const body::ShapeVector& coefficients,
                 std::uint64_t revision);
    TrackedShape(const TrackedShape&) = delete;
    TrackedShape& operator=(const TrackedShape&) = delete;

    [[nodiscard]] const toile_body& abi() const noexcept { return abi_; }

  private:
    std::vector<float> coefficients_;
    std::vector<Vec3f> rest_, normals_, joints_;
    std::vector<std::uint8_t> parts_;
    std::vector<toile_landmark> landmarks_;
    toile_body abi_{};
};

/// The pose on another body: the same turns, bones of its own length, soles as high as before.
[[nodiscard]] body::JointTransforms on_body(const body::Skeleton& other,
                                            const body::Skeleton& tracked,
                                            const body::JointTransforms& world) noexcept;

} // namespace toile::body_tracker
