#include "scape_fit/contour.h"

#include "body/rotations.h"
#include "geometry/point_tree.h"

#include <algorithm>

namespace toile::scape_fit {
namespace {

constexpr float kBehind = 0.10f; // metres that the background lies behind the person

} // namespace

std::vector<Vec3f> outline(const DepthView& view, std::span<const std::uint8_t> mask) {
    constexpr std::array<std::array<int, 2>, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    const int width = view.depth.width, height = view.depth.height;
    const Eigen::Matrix3f turn = view.world_from_camera.linear().cast<float>();
    std::vector<Vec3f> out;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int at = y * width + x;
            if (mask[static_cast<std::size_t>(at)] == 0) continue;
            const float own = view.depth.metres[static_cast<std::size_t>(at)];
            for (const auto& [dx, dy] : kBeside) {
                if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) continue;
                const auto beside = static_cast<std::size_t>(std::ptrdiff_t{at} + dy * width + dx);
                if (mask[beside] != 0 || !(view.depth.metres[beside] > own + kBehind)) continue;
                const auto ray = imaging::unproject(
                    view.camera, Eigen::Vector2d(x + 0.5 * dx, y + 0.5 * dy), 1.0);
                if (ray) out.push_back((turn * ray->cast<float>()).normalized());
            }
        }
    return out;
}

ContourPairing::ContourPairing(const FitLevel& level) : level_(level) {
    for (const Triangle& t : level.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto a = t[i], b = t[(i + 1) % 3];
            if (a < b) edges_.push_back({a, b});
        }
}

void ContourPairing::pair(const PosedLevel& posed, const Vec3f& eye, std::span<const Vec3f> edges,
                          float reach_m, float scale_m, float weight, const ClothGaps* cloth,
                          std::vector<VertexPair>& out) {
    // Points of the model where its normals turn away from the eye.
    std::vector<Vec3f> directions, points, normals;
    std::vector<std::uint32_t> vertices;
    for (const auto& [a, b] : edges_) {
        const Vec3f &p = posed.positions[a], &q = posed.positions[b];
        const float at_a = posed.normals[a].dot(p - eye), at_b = posed.normals[b].dot(q - eye);
        if ((at_a < 0.0f) == (at_b < 0.0f)) continue;
        const float share = at_a / (at_a - at_b);
        points.push_back(p + share * (q - p));
        normals.push_back(posed.normals[a] + share * (posed.normals[b] - posed.normals[a]));
        directions.push_back((points.back() - eye).normalized());
        vertices.push_back(share < 0.5f ? a : b);
    }
    if (points.empty()) return;
    const geometry::PointTree tree(directions);
    sums_.assign(level_.vertices.size(), {});
    for (const Vec3f& edge : edges) {
        const auto near = tree.nearest(edge);
        const Vec3f& x = points[near.index];
        const float range = (x - eye).norm();
        if (std::sqrt(near.squared) * range > reach_m) continue;
        const Vec3f normal = body::across(normals[near.index], edge).normalized();
        const Vec3f place = eye + edge.dot(x - eye) * edge;
        const float distance = normal.dot(x - place);
        const std::uint32_t v = vertices[near.index];
        const float w = weight * level_.trust[v] * geman_mcclure(distance, scale_m);
        VertexPair& sum = sums_[v];
        sum.weight += w;
        sum.distance += w * distance;
        sum.place += w * place;
        sum.normal += w * normal;
    }
    for (std::uint32_t v = 0; v < sums_.size(); ++v) {
        VertexPair& sum = sums_[v];
        if (sum.weight <= 0.0f || sum.normal.norm() < 1e-12f) continue;
        sum.vertex = v;
        sum.distance /= sum.weight;
        sum.place /= sum.weight;
        sum.normal.normalize();
        sum.kind = PairKind::outline;
        if (cloth != nullptr) sum.weight *= cloth->weight(v, sum.distance);
        out.push_back(sum);
    }
}

} // namespace toile::scape_fit
