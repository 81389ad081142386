#include "scan/turn_rig.h"

#include "core/error.h"
#include "geometry/point_tree.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace toile::scan {
namespace {

constexpr double kCell_m = 0.015;

/// One point and normal a cell, in the order in which cells are first met.
class Thin {
  public:
    void add(const Vec3f& p, const Vec3f& n) {
        std::array<int, 3> key{};
        for (int i = 0; i < 3; ++i)
            key[static_cast<std::size_t>(i)] =
                static_cast<int>(std::floor(static_cast<double>(p[i]) / kCell_m));
        const auto [it, fresh] = cells_.try_emplace(key, points_.size());
        if (fresh) points_.push_back({Vec3f::Zero(), Vec3f::Zero(), 0.0f});
        Sum& sum = points_[it->second];
        sum.point += p, sum.normal += n, sum.count += 1.0f;
    }
    void give(TurnTrack& out) const {
        constexpr float kFewest = 2.0f; // readings
        for (const Sum& sum : points_) {
            if (sum.count < kFewest || sum.normal.norm() < 0.5f * sum.count) continue;
            out.points.push_back(sum.point / sum.count);
            out.normals.push_back(sum.normal.normalized());
        }
    }

  private:
    struct Sum {
        Vec3f point, normal;
        float count;
    };
    std::map<std::array<int, 3>, std::size_t> cells_;
    std::vector<Sum> points_;
};

/// The axis of motions that all turn about one line (camera coordinates): from the camera to
/// coordinates with y along it, the origin on it where it is nearest to `middle`.
Pose axis_of(std::span<const Pose> motions, const Vec3d& middle) {
    Vec3d along = Vec3d::Zero();
    for (std::size_t t = 1; t < motions.size(); ++t) {
        const Eigen::AngleAxisd turn((motions[t] * motions[t - 1].inverse()).linear());
        along += turn.angle() * turn.axis();
    }
    along.normalize();
    Eigen::Matrix3d h = along * along.transpose(); // along the axis any point will do
    Vec3d g = Vec3d::Zero();
    for (const Pose& motion : motions) {
        const Eigen::Matrix3d off = Eigen::Matrix3d::Identity() - motion.linear();
        h += off.transpose() * off;
        g += off.transpose() * (motion.translation() - off * middle);
    }
    const Vec3d place = middle + h.ldlt().solve(g);
    Pose out = Pose::Identity();
    const Vec3d origin = place + along * along.dot(middle - place);
    out.linear() = Eigen::Quaterniond::FromTwoVectors(along, Vec3d::UnitY()).toRotationMatrix();
    out.translation() = -(out.linear() * origin);
    return out;
}

/// A turn about y, then a shift along it.
struct Along {
    double turn_rad = 0.0, shift_m = 0.0, score = 0.0;

    [[nodiscard]] Pose pose() const {
        Pose out = Pose::Identity();
        out.rotate(Eigen::AngleAxisd(turn_rad, Vec3d::UnitY()));
        out.pretranslate(Vec3d(0.0, shift_m, 0.0));
        return out;
    }
};

/// One camera's surface, to hold others against it.
class Target {
  public:
    explicit Target(const TurnTrack& track) : track_(track), tree_(track.points) {
        std::vector<float> heights;
        for (const Vec3f& p : track.points)
            heights.push_back(p.y());
        std::sort(heights.begin(), heights.end());
        low_ = heights[heights.size() / 50];
        high_ = heights[heights.size() - 1 - heights.size() / 50];
    }
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }

    /// For each `every`th point at a height that the target has: 1 to 0 where a surface is within
    /// reach and faces alike, and less than nothing where there is none.
    [[nodiscard]] double score(const TurnTrack& other, const Along& move, double reach,
                               std::size_t every) const {
        constexpr double kMissed = 0.6;
        constexpr float kLeastCosine = 0.7f;
        const Eigen::Isometry3f pose = move.pose().cast<float>();
        double sum = 0.0;
        for (std::size_t i = 0; i < other.points.size(); i += every) {
            const Vec3f p = pose * other.points[i];
            if (p.y() < low_ || p.y() > high_) continue;
            const auto near = tree_.nearest(p);
            const double share = near.squared / (reach * reach);
            const bool alike = share < 1.0 && track_.normals[near.index].dot(
                                                  pose.linear() * other.normals[i]) > kLeastCosine;
            sum += alike ? 1.0 - share : -kMissed;
        }
        return sum * static_cast<double>(every) / static_cast<double>(other.points.size());
    }

  private:
    const TurnTrack& track_;
    geometry::PointTree tree_;
    double low_ = 0.0, high_ = 0.0;
};

/// All turns and shifts by coarse steps, then finer ones about the best few.
Along laid_on(const Target& target, const TurnTrack& other) {
    constexpr double kTurnStep = 6.0 * std::numbers::pi / 180.0, kShiftStep = 0.03;
    constexpr double kCoarse_m = 0.04, kFine_m = 0.02;
    constexpr std::size_t kKept = 6, kSome = 400, kMore = 2500;
    const Target own(other);
    const auto every = [&](std::size_t count) {
        return std::max<std::size_t>(1, other.points.size() / count);
    };
    std::vector<Along> all;
    for (double shift = target.low() - own.high(); shift < target.high() - own.low();
         shift += kShiftStep)
        for (double turn = 0.0; turn < 2.0 * std::numbers::pi; turn += kTurnStep) {
            Along at{turn, shift, 0.0};
            at.score = target.score(other, at, kCoarse_m, every(kSome));
            all.push_back(at);
        }
    std::stable_sort(all.begin(), all.end(),
                     [](const Along& a, const Along& b) { return a.score > b.score; });
    Along best;
    best.score = -1.0;
    for (std::size_t k = 0; k < std::min(kKept, all.size()); ++k) {
        Along at = all[k];
        at.score = target.score(other, at, kFine_m, every(kMore));
        double turn = 0.5 * kTurnStep, shift = 0.5 * kShiftStep;
        for (int round = 0; round < 40 && shift > 5e-4; ++round) {
            const double before = at.score;
            for (const auto& [u, v] : {std::pair{1.0, 0.0}, std::pair{-1.0, 0.0},
                                       std::pair{0.0, 1.0}, std::pair{0.0, -1.0}}) {
                Along next{at.turn_rad + u * turn, at.shift_m + v * shift, 0.0};
                next.score = target.score(other, next, kFine_m, every(kMore));
                if (next.score > at.score) at = next;
            }
            if (at.score <= before) turn *= 0.5, shift *= 0.5;
        }
        if (at.score > best.score) best = at;
    }
    return best;
}

} // namespace

TurnTrack follow_turn(std::span<const DepthView> pictures, const RowLoop& rows) {
    RigFusion fusion({}, {Pose::Identity()}, rows);
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        std::vector<CameraView> one;
        one.push_back({0, pictures[i]});
        if (fusion.add(std::move(one))) used.push_back(i);
    }
    fusion.place({});
    TurnTrack out;
    out.turn_rad = fusion.report().turn_rad;
    out.pictures = used.size();
    std::vector<Pose> motions; // of the subject, from how it stood first
    const Pose first = fusion.scan_from_world().front();
    for (const Pose& pose : fusion.scan_from_world())
        motions.push_back(pose.inverse() * first);
    out.axis_from_camera = axis_of(motions, first.inverse() * Vec3d::Zero());
    Thin thin;
    constexpr int kStride = 2;
    for (std::size_t k = 0; k < used.size(); ++k) {
        const DepthView& view = pictures[used[k]];
        const Eigen::Isometry3f move = (out.axis_from_camera * motions[k].inverse()).cast<float>();
        for (int y = 0; y < view.camera.height; y += kStride)
            for (int x = 0; x < view.camera.width; x += kStride) {
                const std::size_t i = view.camera.at(x, y);
                if (view.depth[i] == 0.0f || view.weight[i] <= 0.0f) continue;
                thin.add(move * view.point(x, y), move.linear() * view.normals[i]);
            }
    }
    thin.give(out);
    return out;
}

std::vector<Pose> places_from_turns(std::span<const TurnTrack> tracks,
                                    std::span<const std::string> names) {
    constexpr double kLeastScore = 0.1;
    constexpr std::size_t kFewest = 200; // points of a surface
    for (std::size_t c = 0; c < tracks.size(); ++c)
        if (tracks[c].turn_rad < kLeastTurn_rad || tracks[c].points.size() < kFewest)
            throw Error(
                "camera '" + names[c] + "' saw it turn by " +
                std::to_string(static_cast<int>(tracks[c].turn_rad * 180.0 / std::numbers::pi)) +
                " degrees only: let the person turn once, slowly, without swaying");
    std::vector<Pose> axes(tracks.size(), Pose::Identity()); // first axis from each
    std::vector<bool> placed(tracks.size(), false);
    placed[0] = true;
    std::map<std::pair<std::size_t, std::size_t>, Along> tried;
    for (std::size_t count = 1; count < tracks.size(); ++count) {
        Along best;
        std::size_t from = 0, to = 0;
        for (std::size_t a = 0; a < tracks.size(); ++a)
            for (std::size_t b = 0; b < tracks.size(); ++b) {
                if (!placed[a] || placed[b]) continue;
                if (!tried.contains({a, b})) tried[{a, b}] = laid_on(Target(tracks[a]), tracks[b]);
                const Along& found = tried[{a, b}];
                if (found.score > best.score) best = found, from = a, to = b;
            }
        if (best.score < kLeastScore) {
            const auto lost = static_cast<std::size_t>(
                std::find(placed.begin(), placed.end(), false) - placed.begin());
            throw Error("what camera '" + names[lost] +
                        "' saw of the turn lies on nothing that another one saw: some height must "
                        "be seen by two");
        }
        axes[to] = axes[from] * best.pose();
        placed[to] = true;
    }
    std::vector<Pose> out;
    for (std::size_t c = 0; c < tracks.size(); ++c)
        out.push_back(tracks[0].axis_from_camera.inverse() * axes[c] * tracks[c].axis_from_camera);
    return out;
}

} // namespace toile::scan
