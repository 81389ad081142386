// What is known of a person's surface: points of a scan, or of one camera at one instant.
#pragma once

#include "geometry/mesh.h"
#include "imaging/camera.h"

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace toile::scape_fit {

/// A depth picture and where its camera stands.
struct DepthView {
    imaging::Intrinsics camera;
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
    imaging::DepthImage depth; ///< metres, NaN where unknown
    imaging::Image color;      ///< of the same pixels, or empty

    /// Depth along the camera's axis and pixel of a world point; nothing out of sight.
    struct Sight {
        float depth = 0.0f;
        int x = 0, y = 0;
    };
    [[nodiscard]] std::optional<Sight> sight(const Vec3f& point) const;
};

/// What a point shows, as its colour tells.
enum class Cover : std::uint8_t { unknown, cloth, skin };

/// Points of a person, metres, world. Rows of all vectors belong together.
struct Observation {
    std::size_t instant = 0; ///< which pose it shows
    std::size_t camera = 0;
    std::vector<Vec3f> points;
    std::vector<Vec3f> normals; ///< unit, outwards; empty: the camera is all that is known
    std::vector<float> areas;   ///< of the surface that a point stands for, m^2
    std::vector<Vec2f> hues;    ///< of the points (skin_tone.h), or none
    std::vector<Cover> covers;  ///< of the points, or none
    std::vector<Vec3f> outline; ///< unit directions from the eye to the person's outline, or none
    std::optional<Vec3f> eye;   ///< the camera's place: a point is seen from there
    std::shared_ptr<const DepthView> view; ///< of a depth picture: tells what is free space
    /// Where there is no point there is no body, but for what lies beyond `rim` points (beside a
    /// scan's holes and borders; empty: none).
    bool complete = false;
    std::vector<std::uint8_t> rim;
};

/// A mesh turned into points, at most `count`, spread evenly over its area; normals from its
/// triangles. Deterministic.
[[nodiscard]] Observation sampled(const geometry::TriangleMesh& mesh, std::size_t count);

/// A cloud thinned to at most `count` points; where `normals` is empty they are found from the
/// nearest neighbours, and point away from the cloud's middle line.
[[nodiscard]] Observation thinned(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                                  std::size_t count);

/// Pixels of a view as points, those that `mask` (width * height, 1: the person) names.
[[nodiscard]] Observation seen(std::shared_ptr<const DepthView> view,
                               std::span<const std::uint8_t> mask);

} // namespace toile::scape_fit
