#include "scan/subject.h"

#include "geometry/floor_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace toile::scan {
namespace {

constexpr float kOffFloor_m = 0.03f;
constexpr float kLargest_m = 2.5f, kLeast_m = 0.2f;
constexpr std::size_t kFewest = 400; // pixels

/// Pixels in pieces, cut where depth jumps.
struct Pieces {
    std::vector<std::int32_t> of; ///< (pixels) number, -1: none
    struct Piece {
        std::size_t count = 0;
        Eigen::AlignedBox3f box;
        Vec3d sum = Vec3d::Zero();
        Eigen::Matrix3d square = Eigen::Matrix3d::Zero();

        void add(const Vec3f& p) {
            ++count;
            box.extend(p);
            sum += p.cast<double>();
            square += p.cast<double>() * p.cast<double>().transpose();
        }
        /// A wall, or a piece of one: hardly thicker than the readings' noise.
        [[nodiscard]] bool flat() const {
            const Vec3d middle = sum / static_cast<double>(count);
            const Eigen::Matrix3d spread =
                square / static_cast<double>(count) - middle * middle.transpose();
            const double thickness = std::sqrt(std::max(
                0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[0]));
            return thickness < 0.008 + 1.5 * depth_sigma(-static_cast<float>(middle.z()));
        }
        [[nodiscard]] float size() const { return box.isEmpty() ? 0.0f : box.sizes().maxCoeff(); }
    };
    std::vector<Piece> all;
};

Pieces pieces_of(const Picture& picture, const std::vector<Vec3f>& points,
                 const std::vector<std::uint8_t>& usable) {
    const int w = picture.camera.width, h = picture.camera.height;
    Pieces out;
    out.of.assign(points.size(), -1);
    std::vector<std::uint32_t> open;
    for (std::uint32_t seed = 0; seed < points.size(); ++seed) {
        if (usable[seed] == 0 || out.of[seed] >= 0) continue;
        const auto number = static_cast<std::int32_t>(out.all.size());
        Pieces::Piece& piece = out.all.emplace_back();
        open.assign(1, seed);
        out.of[seed] = number;
        while (!open.empty()) {
            const std::uint32_t at = open.back();
            open.pop_back();
            piece.add(points[at]);
            const int x = static_cast<int>(at) % w, y = static_cast<int>(at) / w;
            const auto reach = [&](int u, int v) {
                if (u < 0 || v < 0 || u >= w || v >= h) return;
                const auto to = static_cast<std::uint32_t>(v * w + u);
                if (usable[to] == 0 || out.of[to] >= 0) return;
                if (std::abs(points[to].z() - points[at].z()) > depth_jump(-points[at].z())) return;
                out.of[to] = number;
                open.push_back(to);
            };
            reach(x - 1, y), reach(x + 1, y), reach(x, y - 1), reach(x, y + 1);
            reach(x - 2, y), reach(x + 2, y), reach(x, y - 2), reach(x, y + 2);
        }
    }
    return out;
}

/// The largest piece of the right size.
std::int32_t main_piece(const Pieces& pieces) {
    std::int32_t best = -1;
    for (std::size_t i = 0; i < pieces.all.size(); ++i) {
        const auto& piece = pieces.all[i];
        if (piece.count < kFewest || piece.size() > kLargest_m || piece.size() < kLeast_m ||
            piece.flat())
            continue;
        if (best < 0 || piece.count > pieces.all[static_cast<std::size_t>(best)].count)
            best = static_cast<std::int32_t>(i);
    }
    return best;
}

/// A plane through soles is no floor.
bool holds_enough(const geometry::Plane& plane, const std::vector<Vec3f>& points) {
    constexpr double kLeastShare = 0.08;
    const auto on = std::count_if(points.begin(), points.end(), [&](const Vec3f& p) {
        return std::abs(plane.normal.dot(p) - plane.offset) < kOffFloor_m;
    });
    return static_cast<double>(on) > kLeastShare * static_cast<double>(points.size());
}

/// Readings on the floor, below it or hardly above it are of no use.
void take_off(const geometry::Plane& floor, const std::vector<Vec3f>& points,
              std::vector<std::uint8_t>& usable) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (usable[i] != 0 && floor.normal.dot(points[i]) - floor.offset <
                                  std::max(kOffFloor_m, 3.0f * depth_sigma(-points[i].z())))
            usable[i] = 0;
}

} // namespace

Subject find_subject(const Picture& picture, const Vec3f& up) {
    constexpr float kMostTilt = 0.5f;
    Subject out;
    const imaging::DepthUnprojector unprojector(picture.camera);
    std::vector<Vec3f> points(picture.depth.size());
    unprojector.points(picture.depth, points);
    std::vector<std::uint8_t> usable(points.size(), 0);
    std::vector<Vec3f> seen;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].allFinite() && picture.depth[i] > 0.0f) {
            usable[i] = 1;
            seen.push_back(points[i]);
        }
    out.mask.assign(points.size(), 0);
    if (seen.size() < kFewest) {
        out.trouble = "the picture holds no readings";
        return out;
    }
    const auto thinned = geometry::thinned_out(seen, 4000);
    out.floor = geometry::find_floor(thinned, up, kMostTilt);
    if (out.floor && !holds_enough(*out.floor, thinned)) out.floor.reset();
    if (out.floor) take_off(*out.floor, points, usable);
    Pieces pieces = pieces_of(picture, points, usable);
    std::int32_t main = main_piece(pieces);
    std::optional<float> top;
    if (out.floor && main >= 0) {
        std::vector<Vec3f> piece;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (pieces.of[i] == main) piece.push_back(points[i]);
        top = geometry::podium_top(*out.floor, piece);
    }
    if (top) {
        out.floor->offset += *top;
        take_off(*out.floor, points, usable);
        pieces = pieces_of(picture, points, usable);
        main = main_piece(pieces);
    }
    if (main < 0) {
        out.trouble = "nothing between 0.2 and 2.5 m large stands free of floor and walls";
        return out;
    }
    const Eigen::AlignedBox3f box = pieces.all[static_cast<std::size_t>(main)].box;
    const Eigen::AlignedBox3f near(box.min() - Vec3f::Constant(0.05f),
                                   box.max() + Vec3f::Constant(0.05f));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::int32_t piece = pieces.of[i];
        if (piece < 0) continue;
        const auto& other = pieces.all[static_cast<std::size_t>(piece)];
        if (piece != main && (other.count < 30 || !near.contains(other.box))) continue;
        out.mask[i] = 1;
        ++out.count;
    }
    return out;
}

} // namespace toile::scan
