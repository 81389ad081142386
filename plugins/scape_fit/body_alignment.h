// Moves what was seen in a frame of its own onto a body that stands in another: by joints, then by
// the surface.
#pragma once

#include "core/row_loop.h"
#include "geometry/point_tree.h"
#include "scape_fit/fit_model.h"
#include "scape_fit/observation.h"

#include <span>

namespace toile::scape_fit {

/// How a frame may lie in another.
enum class Freedom : std::uint8_t {
    level = 1, ///< turned about +Y and moved along y = 0: both know their floor
    any = 2,
};

/// Weighted least squares, far pairs counting less from round to round (Kabsch; Umeyama 1991
/// without scale). Maps `from` onto `to`; as many weights.
[[nodiscard]] Eigen::Isometry3d aligned(std::span<const Vec3f> from, std::span<const Vec3f> to,
                                        std::span<const double> weights, Freedom freedom);

/// A body's surface at one instant, to be looked up.
struct StandingBody {
    explicit StandingBody(const PosedLevel& posed);
    geometry::PointTree tree;
    std::vector<Vec3f> normals;
    std::array<Vec3f, body::kJointCount> joints;
    Vec3f middle; ///< of its box
};

/// Some points of one camera at one instant.
struct SeenPoints {
    std::size_t instant = 0;
    std::vector<Vec3f> points;
    Vec3f eye = Vec3f::Zero();
};

/// Every n-th point, at most `count`.
[[nodiscard]] SeenPoints some_of(const Observation& from, std::size_t count);

struct Alignment {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity(); ///< of the seen points' frame
    double distance_m = 1e9; ///< mean distance of the points to the side that the eye sees
};

/// Distance of points in `place` to the bodies, far and hidden ones counted as 10 cm.
[[nodiscard]] double distance(std::span<const StandingBody> bodies,
                              std::span<const SeenPoints> seen, const Eigen::Isometry3d& place);

/// The places in which the bodies explain the points best, best first, no two turned alike: from
/// `starts` and from all sides to the nearest points of the surface. At least one.
[[nodiscard]] std::vector<Alignment> find_places(std::span<const StandingBody> bodies,
                                                 std::span<const SeenPoints> seen,
                                                 std::span<const Eigen::Isometry3d> starts,
                                                 Freedom freedom, const RowLoop& rows);

} // namespace toile::scape_fit
