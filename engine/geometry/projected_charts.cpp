#include "geometry/projected_charts.h"

#include "core/error.h"
#include "geometry/flat_cover.h"
#include "geometry/packing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace toile::geometry {
namespace {

constexpr int kNone = -1;
constexpr std::size_t kAxes = 6;
constexpr double kCrumb = 0.02;    // share of the root of the area: a smaller piece joins another
constexpr double kSmoothed = 0.01; // share of the root of the area that normals are smoothed over
constexpr double kLeastFacing = 0.25; // cosine, that a triangle keeps so much of its area

/// Along `axis`, to the right and up, as one looks at the surface.
struct Axis {
    Vec3d axis, right, up;
};

const std::array<Axis, kAxes>& axes() {
    static const std::array<Axis, kAxes> all{{{Vec3d::UnitZ(), Vec3d::UnitX(), Vec3d::UnitY()},
                                              {-Vec3d::UnitZ(), -Vec3d::UnitX(), Vec3d::UnitY()},
                                              {Vec3d::UnitX(), -Vec3d::UnitZ(), Vec3d::UnitY()},
                                              {-Vec3d::UnitX(), Vec3d::UnitZ(), Vec3d::UnitY()},
                                              {Vec3d::UnitY(), Vec3d::UnitX(), -Vec3d::UnitZ()},
                                              {-Vec3d::UnitY(), Vec3d::UnitX(), Vec3d::UnitZ()}}};
    return all;
}

struct Faces {
    std::vector<Vec3d> normals;                 ///< (nf) unit, zero without area
    std::vector<double> areas;                  ///< (nf)
    std::vector<std::array<int, 3>> neighbours; ///< (nf) over side k, k + 1; kNone: a border
    double area = 0.0, edge = 0.0;              ///< of all; mean
};

Faces faces_of(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    Faces out;
    out.neighbours.resize(triangles.size(), {kNone, kNone, kNone});
    std::vector<std::array<std::uint32_t, 4>> sides; // low, high, triangle, side
    for (std::uint32_t f = 0; f < triangles.size(); ++f) {
        const Triangle& t = triangles[f];
        const Vec3d a = positions[t[0]].cast<double>();
        const Vec3d cross =
            (positions[t[1]].cast<double>() - a).cross(positions[t[2]].cast<double>() - a);
        out.areas.push_back(0.5 * cross.norm());
        out.normals.emplace_back(cross.normalized());
        if (out.areas.back() <= 0.0) out.normals.back().setZero();
        out.area += out.areas.back();
        out.edge += (positions[t[1]] - positions[t[0]]).cast<double>().norm() /
                    static_cast<double>(triangles.size());
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t p = t[k], q = t[(k + 1) % 3];
            sides.push_back({std::min(p, q), std::max(p, q), f, k});
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        for (end = i;
             end < sides.size() && sides[end][0] == sides[i][0] && sides[end][1] == sides[i][1];)
            ++end;
        if (end - i != 2) continue;
        out.neighbours[sides[i][2]][sides[i][3]] = static_cast<int>(sides[i + 1][2]);
        out.neighbours[sides[i + 1][2]][sides[i + 1][3]] = static_cast<int>(sides[i][2]);
    }
    return out;
}

double facing(const Faces& faces, std::size_t f, std::size_t axis) {
    return faces.normals[f].dot(axes()[axis].axis);
}

std::size_t best_axis(const Vec3d& normal) {
    std::size_t best = 0;
    for (std::size_t a = 1; a < kAxes; ++a)
        if (normal.dot(axes()[a].axis) > normal.dot(axes()[best].axis)) best = a;
    return best;
}

/// The axis that each triangle's surroundings face.
std::vector<std::size_t> faced(const Faces& faces) {
    std::vector<Vec3d> smooth(faces.normals.size());
    for (std::size_t f = 0; f < smooth.size(); ++f)
        smooth[f] = faces.areas[f] * faces.normals[f];
    const double width = kSmoothed * std::sqrt(faces.area);
    const int rounds = std::clamp(static_cast<int>(std::pow(width / faces.edge, 2)), 1, 30);
    std::vector<Vec3d> next(smooth.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t f = 0; f < smooth.size(); ++f) {
            next[f] = smooth[f];
            for (const int n : faces.neighbours[f])
                if (n != kNone) next[f] += smooth[static_cast<std::size_t>(n)];
        }
        smooth.swap(next);
    }
    std::vector<std::size_t> out(smooth.size());
    for (std::size_t f = 0; f < out.size(); ++f) {
        out[f] = best_axis(smooth[f]);
        if (facing(faces, f, out[f]) < kLeastFacing && faces.areas[f] > 0.0)
            out[f] = best_axis(faces.normals[f]);
    }
    return out;
}

/// Calls visit(triangles) for each connected piece of one axis, in the order of its first triangle.
template <class Visit>
void for_each_piece(const Faces& faces, const std::vector<std::size_t>& axis, const Visit& visit) {
    std::vector<bool> seen(axis.size(), false);
    for (std::size_t first = 0; first < axis.size(); ++first) {
        if (seen[first]) continue;
        std::vector<std::size_t> piece{first};
        seen[first] = true;
        for (std::size_t i = 0; i < piece.size(); ++i)
            for (const int n : faces.neighbours[piece[i]]) {
                const auto other = static_cast<std::size_t>(n);
                if (n == kNone || seen[other] || axis[other] != axis[first]) continue;
                seen[other] = true;
                piece.push_back(other);
            }
        visit(piece);
    }
}

/// Gives small pieces the axis of the neighbours along most of their rim, if all of them face it.
void join_crumbs(const Faces& faces, std::vector<std::size_t>& axis) {
    constexpr int kRounds = 4;
    const double least = kCrumb * kCrumb * faces.area;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::size_t> next = axis;
        for_each_piece(faces, axis, [&](const std::vector<std::size_t>& piece) {
            double area = 0.0;
            for (const std::size_t f : piece)
                area += faces.areas[f];
            if (area >= least) return;
            std::array<int, kAxes> rim{};
            for (const std::size_t f : piece)
                for (const int n : faces.neighbours[f])
                    if (n != kNone && axis[static_cast<std::size_t>(n)] != axis[f])
                        ++rim[axis[static_cast<std::size_t>(n)]];
            std::size_t best = kAxes;
            for (std::size_t a = 0; a < kAxes; ++a) {
                const bool all = std::all_of(piece.begin(), piece.end(), [&](std::size_t f) {
                    return faces.areas[f] <= 0.0 || facing(faces, f, a) >= kLeastFacing;
                });
                if (rim[a] > 0 && all && (best == kAxes || rim[a] > rim[best])) best = a;
            }
            if (best == kAxes) return;
            for (const std::size_t f : piece)
                next[f] = best;
        });
        axis.swap(next);
    }
}

Eigen::Vector2d flat(const Vec3f& p, std::size_t axis) {
    const Axis& seen = axes()[axis];
    return {p.cast<double>().dot(seen.right), p.cast<double>().dot(seen.up)};
}

/// Pieces grown from triangle to triangle where none lies on another.
int grow(std::span<const Vec3f> positions, std::span<const Triangle> triangles, const Faces& faces,
         const std::vector<std::size_t>& axis, std::vector<int>& charts) {
    charts.assign(triangles.size(), kNone);
    std::vector<int> refused(triangles.size(), kNone); // by which chart
    int count = 0;
    for (std::size_t first = 0; first < triangles.size(); ++first) {
        if (charts[first] != kNone) continue;
        FlatCover cover(2.0 * faces.edge);
        std::vector<std::size_t> piece;
        const auto take = [&](std::size_t f) {
            if (charts[f] != kNone || refused[f] == count || axis[f] != axis[first]) return;
            FlatCover::Corners corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = flat(positions[triangles[f][k]], axis[f]);
            if (cover.add(corners)) {
                charts[f] = count;
                piece.push_back(f);
            } else {
                refused[f] = count;
            }
        };
        take(first);
        for (std::size_t i = 0; i < piece.size(); ++i)
            for (const int n : faces.neighbours[piece[i]])
                if (n != kNone) take(static_cast<std::size_t>(n));
        ++count;
    }
    return count;
}

/// Vertices chart by chart, in metres, each chart's lowest corner at the origin.
struct Unpacked {
    SeamedLayout layout;             ///< texture coordinates in metres, upwards
    std::vector<std::size_t> charts; ///< (nr)
    std::vector<Vec2f> sizes;        ///< (charts)
};

Unpacked unpacked(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                  const std::vector<std::size_t>& axis, const std::vector<int>& charts, int count) {
    Unpacked out;
    std::vector<Eigen::AlignedBox2d> boxes(static_cast<std::size_t>(count));
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> index;
    std::vector<Eigen::Vector2d> places;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const auto chart = static_cast<std::size_t>(charts[f]);
        Triangle& t = out.layout.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = triangles[f][k];
            const auto [found, added] = index.try_emplace(
                {charts[f], v}, static_cast<std::uint32_t>(out.layout.welded.size()));
            t[k] = found->second;
            if (!added) continue;
            out.layout.welded.push_back(v);
            out.charts.push_back(chart);
            places.push_back(flat(positions[v], axis[f]));
            boxes[chart].extend(places.back());
        }
    }
    for (const auto& box : boxes)
        out.sizes.emplace_back(box.sizes().cast<float>());
    for (std::size_t v = 0; v < places.size(); ++v)
        out.layout.texcoords.emplace_back((places[v] - boxes[out.charts[v]].min()).cast<float>());
    return out;
}

} // namespace

ProjectedAtlas make_projected_atlas(std::span<const Vec3f> positions,
                                    std::span<const Triangle> triangles,
                                    const AtlasOptions& options) {
    const Faces faces = faces_of(positions, triangles);
    if (!(faces.area > 0.0)) throw Error("a surface without area has no room for a texture");
    std::vector<std::size_t> axis = faced(faces);
    join_crumbs(faces, axis);
    ProjectedAtlas out;
    out.chart_count = grow(positions, triangles, faces, axis, out.charts);
    Unpacked laid = unpacked(positions, triangles, axis, out.charts, out.chart_count);
    const Packing packing = pack_boxes(laid.sizes, static_cast<float>(options.gap) /
                                                       static_cast<float>(options.texels));
    for (std::size_t v = 0; v < laid.charts.size(); ++v) {
        const Vec2f p = (packing.places[laid.charts[v]] + laid.layout.texcoords[v]) / packing.side;
        laid.layout.texcoords[v] = Vec2f(p.x(), 1.0f - p.y()); // origin at the top left
    }
    out.layout = std::move(laid.layout);
    out.side = packing.side;
    return out;
}

} // namespace toile::geometry
