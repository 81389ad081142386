#include "scape_fit/person_finder.h"

#include "geometry/floor_plane.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

namespace toile::scape_fit {
namespace {

constexpr std::size_t kTestPoints = 4000;
constexpr float kFloorCut = 0.035f; // what counts as floor when the person is cut out
constexpr float kCell = 0.05f;      // metres, of the grid that joins points into pieces
constexpr float kWallShare = 0.10f; // of all points: a plane with so many may be a wall
constexpr float kWallExtent = 1.3f; // metres that it must be wide and high
constexpr float kWallFoot = 0.9f;   // metres that it must be wide in each third of its height
constexpr float kOnWall = 0.05f;
constexpr float kTallest = 2.4f, kShortest = 0.7f, kWidest = 2.5f;
constexpr float kCompanion = 0.5f; // metres from the person's middle line, for small pieces
constexpr std::uint32_t kFewPoints = 50;
constexpr float kFarthest = 5.0f;   // metres: a depth camera knows too little beyond
constexpr float kFloorTilt = 0.26f; // radians from +Y

/// As a wall is, from top to bottom: what lies in one plane with a person's side or back may be
/// wide somewhere.
bool wide_and_high(const geometry::Plane& plane, std::span<const Vec3f> points, const Vec3f& up) {
    const Vec3f across = up.cross(plane.normal).normalized();
    std::vector<Vec2f> on;
    Vec2f low = Vec2f::Constant(1e9f), high = Vec2f::Constant(-1e9f);
    for (const Vec3f& p : points)
        if (std::abs(plane.normal.dot(p) - plane.offset) < kOnWall) {
            on.emplace_back(across.dot(p), up.dot(p));
            low = low.cwiseMin(on.back());
            high = high.cwiseMax(on.back());
        }
    const Vec2f size = high - low;
    if (size.minCoeff() < kWallExtent) return false;
    std::array<Vec2f, 3> ends;
    ends.fill(Vec2f(1e9f, -1e9f));
    for (const Vec2f& p : on) {
        const auto third = static_cast<std::size_t>(2.999f * (p.y() - low.y()) / size.y());
        ends[third] = {std::min(ends[third].x(), p.x()), std::max(ends[third].y(), p.x())};
    }
    return std::all_of(ends.begin(), ends.end(),
                       [](const Vec2f& third) { return third.y() - third.x() > kWallFoot; });
}

/// Takes points of large upright planes away.
void remove_walls(std::span<const Vec3f> points, const Vec3f& up, std::vector<std::uint8_t>& keep) {
    for (int wall = 0; wall < 4; ++wall) {
        std::vector<Vec3f> left;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (keep[i] != 0) left.push_back(points[i]);
        const auto test = geometry::thinned_out(left, kTestPoints);
        const auto count_on = [&](const geometry::Plane& plane) {
            return static_cast<double>(std::count_if(test.begin(), test.end(), [&](const Vec3f& p) {
                return std::abs(plane.normal.dot(p) - plane.offset) < kOnWall;
            }));
        };
        // Nothing stands behind a wall; there is something on both sides of a person's middle.
        const auto of_wall = [&](const geometry::Plane& plane) {
            std::array<std::size_t, 2> beside{};
            for (const Vec3f& p : test) {
                const float off = plane.normal.dot(p) - plane.offset;
                if (std::abs(off) > kOnWall) ++beside[off > 0.0f ? 1 : 0];
            }
            return std::min(beside[0], beside[1]) * 50 > test.size() ? 0.0 : count_on(plane);
        };
        const auto found = geometry::best_plane(
            test, [&](const Vec3f& n) { return std::abs(n.dot(up)) < 0.2f; }, of_wall);
        if (!found || count_on(*found) < kWallShare * static_cast<double>(test.size())) return;
        const geometry::Plane plane = geometry::refined_plane(*found, test, kOnWall);
        if (!wide_and_high(plane, test, up)) return;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (std::abs(plane.normal.dot(points[i]) - plane.offset) < kOnWall) keep[i] = 0;
    }
}

struct Piece {
    std::vector<std::size_t> points;
    Vec3f low = Vec3f::Constant(1e9f), high = Vec3f::Constant(-1e9f); ///< along up in y
};

/// Points joined through a grid of cells, pieces in order of their first point.
std::vector<Piece> pieces_of(std::span<const Vec3f> points, const Mat3f& level,
                             std::span<const std::uint8_t> keep) {
    std::unordered_map<std::uint64_t, std::uint32_t> cells;
    std::vector<std::uint32_t> parent, cell_of(points.size(), 0);
    std::vector<Eigen::Vector3i> places;
    const auto key = [](const Eigen::Vector3i& c) {
        const auto part = [](int v) {
            return static_cast<std::uint64_t>(std::int64_t{v} + (1 << 20));
        };
        return part(c.x()) << 42 | part(c.y()) << 21 | part(c.z());
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keep[i] == 0) continue;
        const Eigen::Vector3i c = (points[i] / kCell).array().floor().cast<int>();
        const auto [at, added] =
            cells.try_emplace(key(c), static_cast<std::uint32_t>(places.size()));
        if (added) {
            places.push_back(c);
            parent.push_back(at->second);
        }
        cell_of[i] = at->second;
    }
    const auto root = [&](std::uint32_t c) {
        while (parent[c] != c)
            c = parent[c] = parent[parent[c]];
        return c;
    };
    for (std::uint32_t c = 0; c < places.size(); ++c)
        for (int n = 0; n < 27; ++n) {
            const Eigen::Vector3i near =
                places[c] + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            const auto at = cells.find(key(near));
            if (at == cells.end()) continue;
            const std::uint32_t a = root(c), b = root(at->second);
            parent[std::max(a, b)] = std::min(a, b);
        }
    std::map<std::uint32_t, Piece> by_root;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (keep[i] == 0) continue;
        Piece& piece = by_root[root(cell_of[i])];
        piece.points.push_back(i);
        const Vec3f p = level * points[i];
        piece.low = piece.low.cwiseMin(p);
        piece.high = piece.high.cwiseMax(p);
    }
    std::vector<Piece> out;
    out.reserve(by_root.size());
    for (auto& [number, piece] : by_root)
        out.push_back(std::move(piece));
    return out;
}

bool of_human_size(const Piece& piece) {
    const Vec3f size = piece.high - piece.low;
    return size.y() > kShortest && size.y() < kTallest && std::max(size.x(), size.z()) < kWidest;
}

/// Null: nobody.
const Piece* largest_person(const std::vector<Piece>& pieces) {
    const Piece* out = nullptr;
    for (const Piece& piece : pieces)
        if (of_human_size(piece) && (out == nullptr || piece.points.size() > out->points.size()))
            out = &piece;
    return out;
}

} // namespace

FoundPerson find_person(std::span<const Vec3f> points, const Vec3f& up,
                        const std::optional<geometry::Plane>& floor) {
    FoundPerson out;
    out.mask.assign(points.size(), 0);
    out.floor = floor;
    std::vector<std::uint8_t> keep(points.size(), 1);
    const auto cut_floor = [&] {
        for (std::size_t i = 0; i < points.size(); ++i)
            if (out.floor->normal.dot(points[i]) - out.floor->offset < kFloorCut) keep[i] = 0;
    };
    if (out.floor) cut_floor();
    remove_walls(points, up, keep);
    const Mat3f level = Quatf::FromTwoVectors(up, Vec3f::UnitY()).toRotationMatrix();
    auto pieces = pieces_of(points, level, keep);
    const Piece* person = largest_person(pieces);
    if (out.floor && person != nullptr) {
        std::vector<Vec3f> seen;
        for (const std::size_t i : person->points)
            seen.push_back(points[i]);
        if (const auto top = geometry::podium_top(*out.floor, seen)) {
            out.floor->offset += *top;
            cut_floor();
            pieces = pieces_of(points, level, keep);
            person = largest_person(pieces);
        }
    }
    if (person == nullptr || person->points.size() < kFewPoints) {
        out.trouble = pieces.empty() ? "nothing stands above the floor"
                                     : "nothing there is between 0.7 and 2.4 m tall and at most "
                                       "2.5 m wide";
        return out;
    }
    const Vec3f middle = 0.5f * (person->low + person->high);
    for (const Piece& piece : pieces) {
        const Vec3f center = 0.5f * (piece.low + piece.high);
        const Vec3f off(center.x() - middle.x(), 0.0f, center.z() - middle.z());
        const bool close = off.norm() < kCompanion && piece.high.y() < person->high.y() + 0.15f &&
                           (piece.high - piece.low).maxCoeff() < kTallest;
        if (&piece != person && !close) continue;
        for (const std::size_t i : piece.points)
            out.mask[i] = 1;
        out.count += piece.points.size();
    }
    out.height_m = person->high.y() - person->low.y();
    return out;
}

ObservedPerson observe_person(std::span<const std::shared_ptr<DepthView>> views,
                              std::size_t instant) {
    ObservedPerson out;
    std::vector<Vec3f> points;
    std::vector<std::array<std::size_t, 2>> from; // view, pixel
    for (std::size_t i = 0; i < views.size(); ++i) {
        const DepthView& view = *views[i];
        const imaging::DepthUnprojector unprojector(view.camera);
        std::vector<Vec3f> local(view.depth.metres.size());
        unprojector.points(view.depth.metres, local);
        const Eigen::Isometry3f place = view.world_from_camera.cast<float>();
        for (std::size_t p = 0; p < local.size(); ++p)
            if (local[p].allFinite() && -local[p].z() < kFarthest) {
                points.push_back(place * local[p]);
                from.push_back({i, p});
            }
    }
    if (points.empty()) {
        out.trouble = "the depth pictures have no reading within 5 m";
        return out;
    }
    out.floor = geometry::find_floor(points, Vec3f::UnitY(), kFloorTilt);
    const FoundPerson found = find_person(points, Vec3f::UnitY(), out.floor);
    out.floor = found.floor;
    out.trouble = found.trouble;
    out.height_m = found.height_m;
    if (!out.trouble.empty()) return out;
    std::vector<std::vector<std::uint8_t>> masks;
    for (const auto& view : views)
        masks.emplace_back(view->depth.metres.size(), std::uint8_t{0});
    for (std::size_t i = 0; i < points.size(); ++i)
        masks[from[i][0]][from[i][1]] = found.mask[i];
    for (std::size_t i = 0; i < views.size(); ++i) {
        Observation one = seen(views[i], masks[i]);
        if (one.points.size() < kFewPoints) continue;
        one.instant = instant;
        one.camera = i;
        out.observations.push_back(std::move(one));
    }
    return out;
}

} // namespace toile::scape_fit
