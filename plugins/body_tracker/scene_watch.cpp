#include "body_tracker/scene_watch.h"

#include "geometry/floor_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

constexpr float kFarthest = 5.2f;      // metres: people beyond are not tracked
constexpr float kFloorCut = 0.025f;    // what is lower is floor
constexpr float kTilt = 0.6f;          // radians that a camera may lean
constexpr float kLeastStep = 0.05f;    // metres in front of the scene
constexpr float kStepShare = 0.012f;   // ... and of the squared depth, as noise grows
constexpr float kStillSeconds = 12.0f; // what stands so long is scene
constexpr float kLearn = 0.05f;
constexpr float kEmptySeconds = 0.4f; // without a reading so long: nothing is behind
constexpr float kEmpty = 100.0f;      // metres, for that
constexpr float kShortest = 0.5f, kTallest = 2.4f, kWidest = 2.6f;
constexpr float kLeastArea = 0.10f, kMostArea = 2.2f; // m^2
constexpr float kFlat = 0.02f;                        // metres: rms distance from a plane
constexpr float kFlatArea = 0.45f;
constexpr std::size_t kFewCells = 60;
constexpr std::size_t kMostPieces = 12;
constexpr int kFloorTries = 30;

} // namespace

SceneWatch::SceneWatch(const GridCamera& camera, std::optional<geometry::Plane> floor)
    : camera_(camera), floor_(floor), floor_given_(floor.has_value()),
      background_(camera.size(), 0.0f), still_s_(camera.size(), 0.0f), nearer_(camera.size(), 0.0f),
      front_(camera.size(), 0), labels_(camera.size(), 0) {
    stack_.reserve(camera.size());
    pieces_.reserve(kMostPieces + 1);
}

Vec3f SceneWatch::up() const noexcept {
    return floor_ ? floor_->normal : Vec3f::UnitY();
}

bool SceneWatch::joined(float a, float b) noexcept {
    return std::abs(a - b) < 0.06f + 0.006f * a * a;
}

void SceneWatch::find_floor(const DepthGrid& grid) {
    if (floor_given_ || floor_tries_ >= kFloorTries) return;
    ++floor_tries_;
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < grid.depth.size(); ++i) {
        const float d = grid.depth[i];
        if (d == 0.0f || d > kFarthest) continue;
        const auto n = static_cast<int>(i);
        points.push_back(camera_.point(static_cast<float>(n % camera_.width),
                                       static_cast<float>(n / camera_.width), d));
    }
    const auto found = geometry::find_floor(points, Vec3f::UnitY(), kTilt);
    // A table is no floor: a camera stands at least so much above it.
    if (found && found->offset < -0.3f) {
        floor_ = found;
        floor_tries_ = kFloorTries;
    }
}

bool SceneWatch::foreground(std::size_t cell, float depth, const Vec3f& at) const noexcept {
    if (depth == 0.0f || depth > kFarthest) return false;
    if (floor_ && floor_->normal.dot(at) - floor_->offset < kFloorCut) return false;
    const float behind = background_[cell];
    return behind == 0.0f || depth < behind - kLeastStep - kStepShare * depth * depth;
}

/// Labels what hangs together with a cell; how many cells that are.
std::size_t SceneWatch::grow_piece(const DepthGrid& grid, std::size_t seed,
                                   std::uint16_t label) noexcept {
    stack_.clear();
    stack_.push_back(static_cast<std::uint32_t>(seed));
    labels_[seed] = label;
    std::size_t count = 0;
    while (!stack_.empty()) {
        const auto i = static_cast<int>(stack_.back());
        stack_.pop_back();
        ++count;
        const int x = i % camera_.width, y = i / camera_.width;
        constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
        for (const auto& [dx, dy] : kSides) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= camera_.width || y + dy >= camera_.height)
                continue;
            const auto n = static_cast<std::size_t>(i + dy * camera_.width + dx);
            if (front_[n] == 0 || labels_[n] != 0 ||
                !joined(grid.depth[static_cast<std::size_t>(i)], grid.depth[n]))
                continue;
            labels_[n] = label;
            stack_.push_back(static_cast<std::uint32_t>(n));
        }
    }
    return count;
}

bool SceneWatch::like_a_person(const DepthGrid& grid, std::uint16_t label,
                               Piece& out) const noexcept {
    const Vec3f up = this->up();
    const Vec3f side = up.cross(Vec3f::UnitZ()).normalized(), ahead = side.cross(up);
    Vec3f low = Vec3f::Constant(1e9f), high = Vec3f::Constant(-1e9f), sum = Vec3f::Zero();
    Mat3f squares = Mat3f::Zero();
    out = {};
    out.label = label;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
        if (labels_[i] != label) continue;
        const auto n = static_cast<int>(i);
        const float d = grid.depth[i];
        const Vec3f p = camera_.point(static_cast<float>(n % camera_.width),
                                      static_cast<float>(n / camera_.width), d);
        const Vec3f q(side.dot(p), up.dot(p), ahead.dot(p));
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
        sum += p;
        squares += p * p.transpose();
        out.area_m2 += camera_.footprint(d) * camera_.footprint(d);
        ++out.cells;
    }
    const float count = static_cast<float>(out.cells);
    out.middle = sum / count;
    const Vec3f size = high - low;
    out.height_m = size.y();
    if (size.y() < kShortest || size.y() > kTallest || std::max(size.x(), size.z()) > kWidest ||
        out.area_m2 < kLeastArea || out.area_m2 > kMostArea)
        return false;
    Eigen::SelfAdjointEigenSolver<Mat3f> axes;
    axes.computeDirect(squares / count - out.middle * out.middle.transpose(),
                       Eigen::EigenvaluesOnly);
    const float thin = std::sqrt(std::max(0.0f, axes.eigenvalues()[0]));
    return thin > kFlat || out.area_m2 < kFlatArea;
}

void SceneWatch::look(const DepthGrid& grid) noexcept {
    if (!floor_) find_floor(grid);
    for (std::size_t i = 0; i < front_.size(); ++i) {
        const auto n = static_cast<int>(i);
        const float d = grid.depth[i];
        front_[i] = foreground(i, d,
                               camera_.point(static_cast<float>(n % camera_.width),
                                             static_cast<float>(n / camera_.width), d))
                        ? 1
                        : 0;
        labels_[i] = 0;
    }
    pieces_.clear();
    std::uint16_t label = 0;
    for (std::size_t i = 0; i < front_.size(); ++i) {
        if (front_[i] == 0 || labels_[i] != 0 || label == 65535) continue;
        // Specks of noise are many, and each look at a piece goes over all cells.
        if (grow_piece(grid, i, ++label) < kFewCells) continue;
        Piece piece;
        if (!like_a_person(grid, label, piece)) continue;
        const auto at =
            std::upper_bound(pieces_.begin(), pieces_.end(), piece,
                             [](const Piece& a, const Piece& b) { return a.cells > b.cells; });
        pieces_.insert(at, piece);
        if (pieces_.size() > kMostPieces) pieces_.pop_back();
    }
}

void SceneWatch::dismiss(const DepthGrid& grid, std::uint16_t label) noexcept {
    for (std::size_t i = 0; i < labels_.size(); ++i)
        if (labels_[i] == label) background_[i] = grid.depth[i];
}

void SceneWatch::learn(const DepthGrid& grid, std::span<const std::uint8_t> people,
                       float dt_s) noexcept {
    for (std::size_t i = 0; i < background_.size(); ++i) {
        const float d = grid.depth[i];
        float& behind = background_[i];
        if (d == 0.0f) {
            if (behind != 0.0f) continue;
            still_s_[i] += dt_s;
            if (still_s_[i] > kEmptySeconds) behind = kEmpty, still_s_[i] = 0.0f;
            continue;
        }
        if (people[i] != 0) {
            still_s_[i] = 0.0f;
            continue;
        }
        const float step = kLeastStep + kStepShare * d * d;
        if (behind == 0.0f) {
            // What may be a person waits until it was looked at.
            const bool waits = std::any_of(pieces_.begin(), pieces_.end(),
                                           [&](const Piece& p) { return p.label == labels_[i]; });
            if (!waits) behind = d;
        } else if (d > behind + step) {
            behind = 0.0f; // what was behind may be a person
        } else if (d > behind - step) {
            behind += kLearn * (d - behind);
        } else {
            const bool same = std::abs(d - nearer_[i]) < step;
            still_s_[i] = same ? still_s_[i] + dt_s : 0.0f;
            nearer_[i] = d;
            if (still_s_[i] > kStillSeconds) behind = d, still_s_[i] = 0.0f;
            continue;
        }
        still_s_[i] = 0.0f;
    }
}

} // namespace toile::body_tracker
