#include "scape_fit/scan_input.h"

#include "geometry/floor_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace toile::scape_fit {
namespace {

struct Unit {
    const char* name;
    double metres;
};
// Those that scanners and modelling programs use, the likelier first.
constexpr std::array<Unit, 6> kUnits{
    {{"m", 1.0}, {"mm", 0.001}, {"cm", 0.01}, {"inch", 0.0254}, {"dm", 0.1}, {"foot", 0.3048}}};
constexpr float kSmallest = 1.25f, kLargest = 2.25f; // metres: a person's largest extent
constexpr float kLargestScene = 12.0f;               // with what stands around
constexpr float kStanding = 1.0f; // metres that a person is at least tall above a floor
constexpr float kOnFloor = 0.03f, kFloorExtent = 0.8f; // metres
constexpr float kFloorTilt = 0.5f;                     // radians a floor may be off an axis
constexpr std::size_t kFewPoints = 300;
constexpr std::size_t kPieceSamples = 200000;

float largest_extent(std::span<const Vec3f> points, const Vec3f& axis) {
    float low = 1e30f, high = -1e30f;
    for (const Vec3f& p : points) {
        low = std::min(low, axis.dot(p));
        high = std::max(high, axis.dot(p));
    }
    return high - low;
}

Vec3f main_axis(std::span<const Vec3f> points) {
    Vec3d mean = Vec3d::Zero();
    for (const Vec3f& p : points)
        mean += p.cast<double>();
    mean /= static_cast<double>(points.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Vec3f& p : points) {
        const Vec3d d = p.cast<double>() - mean;
        covariance += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    return solver.eigenvectors().col(2).cast<float>().normalized();
}

geometry::TriangleMesh without_bad_points(const geometry::TriangleMesh& scan) {
    geometry::TriangleMesh out;
    std::vector<std::uint32_t> at(scan.positions.size(), ~0u);
    for (std::size_t v = 0; v < scan.positions.size(); ++v) {
        if (!scan.positions[v].allFinite()) continue;
        at[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(scan.positions[v]);
        if (!scan.normals.empty()) out.normals.push_back(scan.normals[v]);
    }
    for (const Triangle& t : scan.triangles)
        if (at[t[0]] != ~0u && at[t[1]] != ~0u && at[t[2]] != ~0u)
            out.triangles.push_back({at[t[0]], at[t[1]], at[t[2]]});
    return out;
}

geometry::TriangleMesh scaled(geometry::TriangleMesh mesh, double factor) {
    for (Vec3f& p : mesh.positions)
        p *= static_cast<float>(factor);
    return mesh;
}

geometry::TriangleMesh part(const geometry::TriangleMesh& mesh,
                            std::span<const std::uint8_t> mask) {
    geometry::TriangleMesh out;
    std::vector<std::uint32_t> at(mesh.positions.size(), ~0u);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (mask[v] == 0) continue;
        at[v] = static_cast<std::uint32_t>(out.positions.size());
        out.positions.push_back(mesh.positions[v]);
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[v]);
    }
    for (const Triangle& t : mesh.triangles)
        if (at[t[0]] != ~0u && at[t[1]] != ~0u && at[t[2]] != ~0u)
            out.triangles.push_back({at[t[0]], at[t[1]], at[t[2]]});
    return out;
}

std::vector<Vec3f> axes() {
    return {Vec3f::UnitY(),  Vec3f::UnitZ(), -Vec3f::UnitY(),
            -Vec3f::UnitZ(), Vec3f::UnitX(), -Vec3f::UnitX()};
}

/// A floor with a person on it: flat, beyond the feet on all sides, and people are tall above it.
std::optional<geometry::Plane> floor_along(std::span<const Vec3f> points, const Vec3f& axis) {
    const auto floor = geometry::find_floor(points, axis, kFloorTilt);
    if (!floor) return std::nullopt;
    const Vec3f across = floor->normal.unitOrthogonal(), other = floor->normal.cross(across);
    std::size_t on = 0;
    Vec2f low = Vec2f::Constant(1e9f), high = -low;
    float top = 0.0f;
    for (const Vec3f& p : points) {
        const float height = floor->normal.dot(p) - floor->offset;
        top = std::max(top, height);
        if (std::abs(height) > kOnFloor) continue;
        ++on;
        const Vec2f at(across.dot(p), other.dot(p));
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    }
    if (on * 25 < points.size() || (high - low).minCoeff() < kFloorExtent || top < kStanding)
        return std::nullopt;
    return floor;
}

/// Floor and pieces with one unit assumed; true when a person of human size is left.
bool try_unit(const geometry::TriangleMesh& mesh, PreparedScan& out) {
    const auto& points = mesh.positions;
    geometry::TriangleMesh person = mesh;
    const Vec3f longest = main_axis(points);
    const float extent =
        std::max({largest_extent(points, longest), largest_extent(points, Vec3f::UnitY()),
                  largest_extent(points, Vec3f::UnitZ()), largest_extent(points, Vec3f::UnitX())});
    if (extent < kSmallest || extent > kLargestScene) return false;
    for (const Vec3f& axis : axes()) {
        const auto floor = floor_along(points, axis);
        if (!floor) continue;
        const FoundPerson found = find_person(points, floor->normal, floor);
        if (!found.trouble.empty() || found.height_m < kStanding || found.height_m > kLargest)
            continue;
        out.floor = found.floor;
        out.ups = {floor->normal};
        person = part(mesh, found.mask);
        break;
    }
    if (!out.floor && extent > kLargest) {
        // Clutter without a floor: whatever is upright by the file's own axes.
        const FoundPerson found = find_person(points, Vec3f::UnitY(), std::nullopt);
        if (!found.trouble.empty() || found.height_m < kStanding) return false;
        person = part(mesh, found.mask);
    }
    if (person.positions.size() < kFewPoints && person.triangles.size() < kFewPoints) {
        out.floor.reset();
        return false;
    }
    if (!out.floor) {
        out.ups = axes();
        for (const Vec3f& way : {longest, Vec3f(-longest)})
            if (std::none_of(out.ups.begin(), out.ups.end(),
                             [&](const Vec3f& u) { return u.dot(way) > 0.97f; }))
                out.ups.push_back(way);
    }
    out.removed_share =
        1.0 - static_cast<double>(person.positions.size()) / static_cast<double>(points.size());
    out.person = std::move(person);
    return true;
}

} // namespace

PreparedScan prepare_scan(const geometry::TriangleMesh& scan, std::size_t count) {
    PreparedScan out;
    const geometry::TriangleMesh clean = without_bad_points(scan);
    if (clean.positions.size() < kFewPoints && clean.triangles.size() < kFewPoints) {
        out.trouble = "the scan has " + std::to_string(clean.positions.size()) +
                      " usable points; a person takes at least " + std::to_string(kFewPoints);
        return out;
    }
    geometry::TriangleMesh looked = clean;
    if (clean.positions.size() > kPieceSamples && clean.triangles.empty()) {
        // A cloud this dense is thinned before it is looked at.
        looked = {};
        const std::size_t step = clean.positions.size() / kPieceSamples;
        for (std::size_t i = 0; i < clean.positions.size(); i += step) {
            looked.positions.push_back(clean.positions[i]);
            if (!clean.normals.empty()) looked.normals.push_back(clean.normals[i]);
        }
    }
    bool found = false;
    for (const Unit& unit : kUnits) {
        found = try_unit(scaled(looked, unit.metres), out);
        if (!found) continue;
        out.unit = unit.name;
        out.metres_per_unit = unit.metres;
        break;
    }
    if (!found) {
        out.trouble = "nothing in the scan is as large as a person, whether its unit is the "
                      "metre, mm, cm, dm, inch or foot";
        return out;
    }
    if (!out.person.triangles.empty()) {
        if (geometry::volume(out.person) < 0.0) {
            out.turned_inside_out = true;
            for (Triangle& t : out.person.triangles)
                std::swap(t[1], t[2]);
        }
        out.observation = sampled(out.person, count);
    } else {
        out.observation = thinned(out.person.positions, out.person.normals, count);
    }
    return out;
}

} // namespace toile::scape_fit
