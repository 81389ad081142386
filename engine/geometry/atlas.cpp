#include "geometry/atlas.h"

#include "core/error.h"
#include "geometry/packing.h"
#include "geometry/parameterization.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

namespace toile::geometry {
namespace {

constexpr int kTurns = 45; // tried over a quarter circle when a chart is laid upright

struct Chart {
    std::vector<std::uint32_t> vertices; ///< of the mesh
    std::vector<Triangle> triangles;     ///< into `vertices`
    std::vector<std::size_t> faces;      ///< of the mesh
    std::vector<Vec2f> flat;             ///< metres, lowest corner of its box at the origin
    Vec2f size = Vec2f::Zero();
};

std::map<int, Chart> cut(std::span<const Triangle> triangles, std::span<const int> labels) {
    std::map<int, Chart> out;
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> index;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        Chart& chart = out[labels[f]];
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [found, added] = index.try_emplace(
                {labels[f], triangles[f][k]}, static_cast<std::uint32_t>(chart.vertices.size()));
            if (added) chart.vertices.push_back(triangles[f][k]);
            t[k] = found->second;
        }
        chart.triangles.push_back(t);
        chart.faces.push_back(f);
    }
    return out;
}

/// Turns the chart so that its box is smallest and stands upright.
void lay_upright(Chart& chart) {
    std::vector<Vec2f> best;
    float least = std::numeric_limits<float>::max();
    for (int turn = 0; turn < kTurns; ++turn) {
        const Eigen::Rotation2Df rotation(static_cast<float>(turn) *
                                          static_cast<float>(std::numbers::pi) / 2.0f /
                                          static_cast<float>(kTurns));
        Eigen::AlignedBox2f box;
        std::vector<Vec2f> turned;
        for (const auto& p : chart.flat) {
            turned.emplace_back(rotation * p);
            box.extend(turned.back());
        }
        if (box.volume() >= least) continue;
        least = box.volume();
        chart.size = box.sizes();
        for (auto& p : turned)
            p -= box.min();
        best = std::move(turned);
    }
    if (chart.size.x() > chart.size.y()) { // a quarter turn keeps triangles counter-clockwise
        for (auto& p : best)
            p = Vec2f(chart.size.y() - p.y(), p.x());
        chart.size = Vec2f(chart.size.y(), chart.size.x());
    }
    chart.flat = std::move(best);
}

} // namespace

SeamedLayout make_atlas(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                        std::span<const int> charts, const AtlasOptions& options) {
    auto pieces = cut(triangles, charts);
    std::vector<Vec2f> sizes;
    for (auto& [label, chart] : pieces) {
        std::vector<Vec3f> points;
        for (const auto v : chart.vertices)
            points.push_back(positions[v]);
        try {
            chart.flat = flatten_disc(points, chart.triangles);
        } catch (const Error& e) {
            throw Error("chart " + std::to_string(label) + ": " + e.what());
        }
        lay_upright(chart);
        sizes.push_back(chart.size);
    }
    const Packing packing =
        pack_boxes(sizes, static_cast<float>(options.gap) / static_cast<float>(options.texels));

    SeamedLayout out;
    out.triangles.resize(triangles.size());
    std::size_t number = 0;
    for (const auto& [label, chart] : pieces) {
        const Vec2f& place = packing.places[number++];
        const auto first = static_cast<std::uint32_t>(out.welded.size());
        for (std::size_t i = 0; i < chart.vertices.size(); ++i) {
            const Vec2f p = (place + chart.flat[i]) / packing.side;
            out.welded.push_back(chart.vertices[i]);
            out.texcoords.emplace_back(p.x(), 1.0f - p.y()); // origin at the top left
        }
        for (std::size_t f = 0; f < chart.faces.size(); ++f) {
            const auto& t = chart.triangles[f];
            out.triangles[chart.faces[f]] = {first + t[0], first + t[1], first + t[2]};
        }
    }
    return out;
}

} // namespace toile::geometry
