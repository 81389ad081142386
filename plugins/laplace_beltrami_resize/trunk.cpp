#include "laplace_beltrami_resize/trunk.h"

#include "body/spectral_parts.h"
#include "core/error.h"
#include "geometry/laplacian.h"

#include <algorithm>

namespace toile::laplace_beltrami_resize {
namespace {

constexpr float kBeside = 0.25f;
constexpr double kLeftOut = 0.02; // of the region's area at either end: its rim is not level

geometry::SurfacePart trunk_part(const geometry::TriangleMesh& mesh,
                                 std::span<const float> region) {
    std::vector<Triangle> kept;
    for (const Triangle& t : mesh.triangles)
        if (region[t[0]] > 0.0f && region[t[1]] > 0.0f && region[t[2]] > 0.0f) kept.push_back(t);
    if (kept.empty()) throw Error("the region to be resized is empty");
    return geometry::SurfacePart(std::move(kept));
}

} // namespace

std::vector<float> abdomen_region(const geometry::TriangleMesh& mesh) {
    using body::SpectralPart;
    const body::SpectralParts parts = body::spectral_parts(mesh);
    std::vector<float> out;
    out.reserve(parts.of.size());
    for (const SpectralPart part : parts.of)
        switch (part) {
        case SpectralPart::abdomen:
            out.push_back(1.0f);
            break;
        case SpectralPart::head_and_chest:
        case SpectralPart::left_thigh:
        case SpectralPart::right_thigh:
            out.push_back(kBeside);
            break;
        default:
            out.push_back(0.0f);
        }
    return out;
}

Trunk::Trunk(const geometry::TriangleMesh& mesh, std::span<const float> region)
    : part_(trunk_part(mesh, region)), cutter_(mesh.positions, part_, Vec3f::UnitY()) {
    const Eigen::VectorXd areas = geometry::lumped_mass(mesh.positions, mesh.triangles);
    std::vector<std::pair<float, double>> heights;
    double all = 0.0;
    for (std::size_t v = 0; v < region.size(); ++v) {
        if (region[v] < 0.5f) continue;
        heights.emplace_back(mesh.positions[v].y(), areas[static_cast<Eigen::Index>(v)]);
        all += heights.back().second;
    }
    if (heights.empty()) throw Error("the region to be resized is empty");
    std::sort(heights.begin(), heights.end());
    low_ = heights.front().first;
    high_ = heights.back().first;
    double below = 0.0;
    for (const auto& [height, area] : heights) {
        if (below < kLeftOut * all) low_ = height;
        below += area;
        if (below < (1.0 - kLeftOut) * all) high_ = height;
    }
    if (!(high_ - low_ > 0.02f)) throw Error("the region to be resized has no height");
}

Strip Trunk::strip(float height) const {
    Strip out;
    out.height = height;
    out.right = cutter_.extent(height, Vec3f::UnitX());
    out.left = -cutter_.extent(height, -Vec3f::UnitX());
    out.front = cutter_.extent(height, Vec3f::UnitZ());
    out.back = -cutter_.extent(height, -Vec3f::UnitZ());
    if (!(out.width() > 0.01f && out.depth() > 0.01f))
        throw Error("the region to be resized has a gap at height " + std::to_string(height) +
                    " m");
    return out;
}

std::vector<Strip> Trunk::strips(std::size_t count) const {
    std::vector<Strip> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        out.push_back(strip(low_ + (high_ - low_) * (static_cast<float>(i) + 0.5f) /
                                       static_cast<float>(count)));
    return out;
}

double Trunk::scaled_girth(float height, float width, float depth) const {
    geometry::Loop tape = cutter_.tape(height);
    for (Vec3f& p : tape.points)
        p = Vec3f(width * p.x(), p.y(), depth * p.z());
    return tape.length(); // convex still
}

double Trunk::girth(float height) const {
    return cutter_.girth(height);
}

} // namespace toile::laplace_beltrami_resize
