#include "garment/pattern_tape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment {
namespace {

using geometry::Loop;
using geometry::Plane;

constexpr float kBeside_m = 0.006f; // between the levels that are tried
constexpr int kLevelsBeside = 2;    // on each side
constexpr float kWidestGap = 0.25f; // of an open curve's length

/// How often a curve runs around a point, either way, seen along the plane's normal.
int turns(const Loop& loop, const Vec3f& point, const Vec3f& normal) {
    double angle = 0.0;
    const std::size_t count = loop.points.size();
    const auto from_point = [&](std::size_t i) {
        const Vec3f way = loop.points[i % count] - point;
        return Vec3f(way - way.dot(normal) * normal);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f a = from_point(i), b = from_point(i + 1);
        angle +=
            std::atan2(static_cast<double>(a.cross(b).dot(normal)), static_cast<double>(a.dot(b)));
    }
    return std::abs(static_cast<int>(std::lround(angle / (2.0 * std::numbers::pi))));
}

/// Middles of the parts of the body that a plane cuts beside the tape `own`.
std::vector<Vec3f> other_parts(const Loop& own, const ClothSurface& body, const Plane& plane) {
    std::vector<Vec3f> out;
    for (const Loop& loop : geometry::slice(body.positions, body.triangles, plane))
        if (loop.closed && turns(own, loop.centroid(), plane.normal) == 0)
            out.push_back(loop.centroid());
    return out;
}

/// The curve around `middle` and nothing else; of several, as in a fold, the shortest, closed ones
/// first.
const Loop* curve_around(const std::vector<Loop>& loops, const Vec3f& middle,
                         std::span<const Vec3f> others, const Vec3f& normal) {
    const Loop* best = nullptr;
    for (const Loop& loop : loops) {
        if (turns(loop, middle, normal) != 1) continue;
        if (std::any_of(others.begin(), others.end(),
                        [&](const Vec3f& p) { return turns(loop, p, normal) != 0; }))
            continue;
        const double length = loop.length();
        if (!loop.closed && static_cast<double>((loop.points.front() - loop.points.back()).norm()) >
                                static_cast<double>(kWidestGap) * length)
            continue;
        const bool better = best == nullptr || (loop.closed && !best->closed) ||
                            (loop.closed == best->closed && length < best->length());
        if (better) best = &loop;
    }
    return best;
}

/// Where the plane crosses a triangle's outline, falling and rising.
PatternTape::Step step_through(std::uint32_t triangle, const ClothSurface& cloth,
                               const Plane& plane) {
    PatternTape::Step out;
    out.triangle = triangle;
    const Triangle& t = cloth.triangles[triangle];
    std::array<double, 3> height{};
    for (std::size_t k = 0; k < 3; ++k)
        height[k] = plane.normal.cast<double>().dot(cloth.positions[t[k]].cast<double>()) -
                    static_cast<double>(plane.offset);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if ((height[k] >= 0.0) == (height[next] >= 0.0)) continue;
        const auto share = static_cast<float>(height[k] / (height[k] - height[next]));
        Vec3f place = Vec3f::Zero();
        place[static_cast<Eigen::Index>(k)] = 1.0f - share;
        place[static_cast<Eigen::Index>(next)] = share;
        (height[k] >= 0.0 ? out.from : out.to) = place;
    }
    return out;
}

/// Lays tapes around one part of a body at several levels.
class TapeLayer {
  public:
    TapeLayer(const body::Reading& girth, const ClothSurface& body, const ClothSurface& cloth,
              bool open)
        : body_(body), cloth_(cloth), own_(girth.tapes.front()), plane_(*girth.cut),
          middle_(own_.centroid()), open_(open) {}

    /// `level`: steps along the normal from the body's tape.
    [[nodiscard]] std::optional<PatternTape> at(int level) const {
        Plane plane = plane_;
        const float moved = kBeside_m * static_cast<float>(level);
        plane.offset += moved;
        const std::vector<Loop> loops = geometry::slice(cloth_.positions, cloth_.triangles, plane);
        const std::vector<Vec3f> others = other_parts(own_, body_, plane);
        const Loop* curve = curve_around(loops, middle_, others, plane.normal);
        if (curve == nullptr || (!curve->closed && !open_)) return std::nullopt;
        PatternTape tape;
        tape.open = !curve->closed;
        tape.moved_m = static_cast<double>(moved);
        for (const std::uint32_t triangle : curve->triangles)
            tape.steps.push_back(step_through(triangle, cloth_, plane));
        return tape;
    }

  private:
    const ClothSurface& body_;
    const ClothSurface& cloth_;
    const Loop& own_;
    Plane plane_;
    Vec3f middle_;
    bool open_;
};

} // namespace

double PatternTape::flat_length(std::span<const Vec2f> material_coords) const {
    double sum = 0.0;
    for (const Step& step : steps) {
        Eigen::Vector2d way = Eigen::Vector2d::Zero();
        for (Eigen::Index k = 0; k < 3; ++k)
            way += static_cast<double>(step.to[k] - step.from[k]) *
                   material_coords[3 * std::size_t{step.triangle} + static_cast<std::size_t>(k)]
                       .cast<double>();
        sum += way.norm();
    }
    return sum;
}

std::optional<PatternTape> lay_around(const body::Reading& girth, const ClothSurface& body,
                                      const ClothSurface& cloth,
                                      std::span<const Vec2f> material_coords,
                                      const TapeOptions& options) {
    if (!girth.cut || girth.tapes.empty() || girth.tapes.front().points.size() < 3)
        return std::nullopt;
    const TapeLayer layer(girth, body, cloth, options.open);
    const int most = static_cast<int>(options.reach_m / kBeside_m);
    for (int away = 0; away <= most; ++away)
        for (const int middle : {-away, away}) {
            if (!layer.at(middle)) continue;
            std::vector<std::pair<double, PatternTape>> found;
            for (int level = middle - kLevelsBeside; level <= middle + kLevelsBeside; ++level)
                if (auto tape = layer.at(level)) {
                    const double length = tape->flat_length(material_coords);
                    found.emplace_back(length, std::move(*tape));
                }
            std::stable_sort(found.begin(), found.end(),
                             [](const auto& a, const auto& b) { return a.first < b.first; });
            return std::move(found[found.size() / 2].second);
        }
    return std::nullopt;
}

} // namespace toile::garment
