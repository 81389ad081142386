// From a camera's frames to views of the subject: found, cut out, filtered.
#pragma once

#include "geometry/mesh.h"
#include "scan/depth_filter.h"
#include "scan/subject.h"

#include <string>

namespace toile::scan {

struct IntakeCamera {
    imaging::Intrinsics intrinsics;
    std::optional<Eigen::Isometry3d> world_from_camera; ///< when the camera knows its place
};

class Intake {
  public:
    /// \throw Error for impossible intrinsics
    Intake(IntakeCamera camera, const FilterOptions& filter, bool choose_radius, RowLoop rows);

    /// Nothing when the frame shows nobody: `trouble` says why. `depth` (pixels) metres, NaN or 0
    /// where unknown; `color` (pixels) or empty. Rough readings of the first view widen the
    /// filter's radius, where that may be chosen.
    [[nodiscard]] std::optional<DepthView> view(std::span<const float> depth,
                                                std::span<const Rgba8> color);

    /// Filters as another camera's intake chose to.
    void filter_as(const Intake& other) {
        filter_ = other.filter_;
        choose_radius_ = false;
    }
    /// Counts a frame that is not looked at.
    void pass() { ++fed_, ++passed_; }

    [[nodiscard]] const IntakeCamera& camera() const { return camera_; }
    [[nodiscard]] const FilterOptions& filter() const { return filter_; }
    /// Of the first view, in the camera's coordinates, normal up.
    [[nodiscard]] const std::optional<geometry::Plane>& floor() const { return floor_; }
    /// The same of the last one.
    [[nodiscard]] const std::optional<geometry::Plane>& last_floor() const { return last_floor_; }
    [[nodiscard]] std::size_t fed() const { return fed_; }
    [[nodiscard]] std::size_t empty() const { return empty_; }
    [[nodiscard]] const std::string& trouble() const { return trouble_; }
    /// World from camera: the camera's, or upright with the surface's lowest point at 0.
    [[nodiscard]] Eigen::Isometry3d upright(const geometry::TriangleMesh& surface) const;

  private:
    [[nodiscard]] Vec3f up() const;

    IntakeCamera camera_;
    FilterOptions filter_;
    bool choose_radius_;
    RowLoop rows_;
    std::optional<geometry::Plane> floor_, last_floor_;
    std::size_t fed_ = 0, passed_ = 0, empty_ = 0;
    std::string trouble_;
};

} // namespace toile::scan
