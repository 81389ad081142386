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

/// Height above the floor of a podium's top, if the piece stands on one: more readings at one
/// height than legs can have, spread over both directions.
std::optional<float> podium_top(const geometry::Plane& floor, const std::vector<Vec3f>& points,
                                const std::vector<std::int32_t>& of, std::int32_t piece) {
    constexpr float kBin_m = 0.01f, kHighest_m = 0.35f, kLegs_m = 0.6f;
    constexpr std::size_t kWindow = 3, kTops = 35, kBins = 60;
    constexpr double kTimesLegs = 5.0, kLeastShare = 0.08, kLeastSpread_m = 0.1,
                     kLeastAbove = 0.25; // share of the piece that must stand on it
    std::array<std::size_t, kBins> counts{};
    std::size_t all = 0;
    const auto height = [&](std::size_t i) { return floor.normal.dot(points[i]) - floor.offset; };
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (of[i] != piece) continue;
        ++all;
        const float h = height(i);
        if (h >= 0.0f && h < kLegs_m) ++counts[static_cast<std::size_t>(h / kBin_m)];
    }
    const auto window = [&](std::size_t first) {
        return counts[first] + counts[first + 1] + counts[first + 2];
    };
    std::size_t best = 0;
    for (std::size_t b = 1; b + kWindow <= kTops; ++b)
        if (window(b) > window(best)) best = b;
    double legs = 0.0;
    for (std::size_t b = kTops; b < kBins; ++b)
        legs += static_cast<double>(kWindow * counts[b]) / static_cast<double>(kBins - kTops);
    const auto most = static_cast<double>(window(best));
    if (most < kTimesLegs * legs || most < kLeastShare * static_cast<double>(all)) return {};
    Pieces::Piece top;
    std::size_t above = 0;
    const float low = kBin_m * static_cast<float>(best);
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (of[i] != piece || height(i) < low) continue;
        if (height(i) >= low + kWindow * kBin_m) {
            ++above;
            continue;
        }
        top.add(points[i]);
        sum += static_cast<double>(height(i));
    }
    if (top.count == 0 || static_cast<double>(above) < kLeastAbove * static_cast<double>(all))
        return {};
    const Vec3d middle = top.sum / static_cast<double>(top.count);
    const Eigen::Matrix3d spread =
        top.square / static_cast<double>(top.count) - middle * middle.transpose();
    // The least of the three is across the top.
    if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues()[1] <
        kLeastSpread_m * kLeastSpread_m)
        return {};
    const auto out = static_cast<float>(sum / static_cast<double>(top.count));
    return out < kHighest_m ? std::optional(out) : std::nullopt;
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
    const auto top = out.floor && main >= 0 ? podium_top(*out.floor, points, pieces.of, main)
                                            : std::optional<float>();
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
