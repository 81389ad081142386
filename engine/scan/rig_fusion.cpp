#include "scan/rig_fusion.h"

#include "core/error.h"
#include "scan/normal_equations.h"
#include "scan/subject.h"
#include "scan/tracking.h"

#include <numbers>

namespace toile::scan {

/// Unknowns: motions of the instants (in the scan), then of the cameras (in the world).
struct RigSystem {
    Eigen::MatrixXd h;
    Eigen::VectorXd g;
    Eigen::Index times = 0; ///< how many belong to the instants

    [[nodiscard]] Eigen::Index camera(std::size_t c) const {
        return times + static_cast<Eigen::Index>(6 * c);
    }
};

namespace {

double angle_of(const Pose& motion) {
    return Eigen::AngleAxisd(motion.linear()).angle();
}

/// Of all readings, in the world.
Vec3d middle_of(std::span<const CameraView> instant, std::span<const Pose> cameras) {
    Vec3d sum = Vec3d::Zero();
    double count = 0.0;
    for (const CameraView& seen : instant)
        for (int y = 0; y < seen.view.camera.height; ++y)
            for (int x = 0; x < seen.view.camera.width; ++x)
                if (seen.view.depth[seen.view.camera.at(x, y)] > 0.0f) {
                    sum += cameras[seen.camera] * seen.view.point(x, y).cast<double>();
                    count += 1.0;
                }
    if (count == 0.0) throw Error("the pictures of the subject hold no readings");
    return sum / count;
}

/// What a motion of the world is for one that happens before `pose`: motion(out) then pose is pose
/// then motion(in).
Matrix6 carried(const Pose& pose) {
    Matrix6 out = Matrix6::Zero();
    const Eigen::Matrix3d turn = pose.linear();
    const Vec3d t = pose.translation();
    Eigen::Matrix3d cross;
    cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    out.topLeftCorner<3, 3>() = turn;
    out.bottomRightCorner<3, 3>() = turn;
    out.bottomLeftCorner<3, 3>() = cross * turn;
    return out;
}

} // namespace

RigFusion::RigFusion(const FusionOptions& options, std::vector<Pose> world_from_camera,
                     RowLoop rows)
    : options_(options), rows_(std::move(rows)), cameras_(std::move(world_from_camera)),
      told_(cameras_) {}
RigFusion::~RigFusion() = default;

bool RigFusion::add(std::vector<CameraView> instant) {
    if (instant.empty()) return false;
    if (!model_) {
        model_ = std::make_unique<Volume>(Vec3f::Zero(), kTrackingVolume);
        Pose first = Pose::Identity();
        first.translation() = -middle_of(instant, cameras_);
        keep(std::move(instant), first);
        return true;
    }
    std::vector<RigView> views;
    for (const CameraView& seen : instant)
        views.push_back({&seen.view, cameras_[seen.camera]});
    const Registered found = tracked(views);
    if (!fits(found)) {
        ++report_.lost_instants;
        ++missed_;
        return false;
    }
    gap_ = missed_ + 1;
    missed_ = 0;
    last_rms_m_ = found.rms_m;
    keep(std::move(instant), found.pose);
    return true;
}

void RigFusion::keep(std::vector<CameraView> instant, const Pose& scan_from_world) {
    if (!instants_.empty())
        report_.turn_rad += angle_of(scan_from_world * instants_.back().inverse());
    const auto number = static_cast<std::uint32_t>(instants_.size());
    instants_.push_back(scan_from_world);
    for (CameraView& seen : instant) {
        model_->integrate(seen.view, scan_from_world * cameras_[seen.camera], rows_);
        camera_of_.push_back(seen.camera);
        instant_of_.push_back(number);
        views_.push_back(std::move(seen.view));
    }
    report_.instants = instants_.size();
}

/// Where an arm moves aside much is new, and what is not new must fit as well as it did before.
bool RigFusion::fits(const Registered& found) const {
    constexpr double kLeastKnown = 0.3, kAsBefore = 2.0;
    if (found.overlap >= kLeastOverlap) return found.rms_m <= kMostRms_m;
    return found.overlap >= kLeastKnown && found.rms_m <= kAsBefore * last_rms_m_;
}

/// Against the model, from where the motion would go on, or else from where the last instant was.
Registered RigFusion::tracked(std::span<const RigView> views) const {
    constexpr int kStride = 2;
    const Pose& last = instants_.back();
    // While instants are lost (an arm before the rest) the subject turns on as it did.
    const Pose step =
        instants_.size() < 2
            ? Pose::Identity()
            : times_over(last * instants_[instants_.size() - 2].inverse(),
                         static_cast<double>(missed_ + 1) / static_cast<double>(gap_));
    return track_on(last, step, [&](const Pose& start, float reach) {
        RegistrationOptions options;
        options.reach_m = reach;
        std::vector<SurfaceMap> maps;
        for (const RigView& seen : views)
            maps.push_back(
                raycast(*model_, *seen.view, kStride, reach, start * seen.rig_from_camera, rows_));
        return register_rig(views, maps, start, options, rows_);
    });
}

/// Where the subject turned, any two cameras see the same places, one after the other; before a
/// rig that stands around it only neighbours do, from 90 degrees apart.
std::vector<ViewPair> RigFusion::pairs(std::span<const Pose> poses) const {
    constexpr double kNeighbours = 1.75, kTurned = 1.5; // radians
    const double angle = report_.turn_rad > kTurned ? options_.pair_angle
                                                    : std::max(kNeighbours, options_.pair_angle);
    constexpr std::size_t kEnough = 1500, kFewest = 4, kMost = 12; // for time's sake
    return overlapping_pairs(
        poses, angle,
        std::clamp(kEnough / std::max<std::size_t>(1, views_.size()), kFewest, kMost));
}

/// One Gauss-Newton step of all instants and cameras. Returns the rms between views.
double RigFusion::step(std::span<const ViewPair> pairs, const JointOptions& options,
                       const CameraFreedom& freedom, double& longest) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < views_.size(); ++i)
        poses.push_back(pose_of(i));
    std::vector<Sums> sums(pairs.size());
    rows_(static_cast<std::uint32_t>(pairs.size()), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k)
            sums[k] = mutual_sums(views_[pairs[k].a], views_[pairs[k].b], poses[pairs[k].a],
                                  poses[pairs[k].b], options);
    });
    double square = 0.0, weight = 0.0;
    for (const Sums& pair : sums)
        square += pair.square, weight += pair.weight;
    if (weight == 0.0) return 0.0;
    const bool free = freedom.turn_rad > 0.0 && freedom.shift_m > 0.0;
    RigSystem system = gathered(pairs, sums, free);
    hold(freedom, system);
    const Eigen::VectorXd solution = -system.h.ldlt().solve(system.g);
    if (!solution.allFinite()) return std::sqrt(square / weight);
    for (std::size_t t = 1; t < instants_.size(); ++t)
        instants_[t] =
            moved(motion(solution.segment<6>(static_cast<Eigen::Index>(6 * t))), instants_[t]);
    for (std::size_t c = 1; free && c < cameras_.size(); ++c)
        cameras_[c] = moved(motion(solution.segment<6>(system.camera(c))), cameras_[c]);
    longest = solution.lpNorm<Eigen::Infinity>();
    return std::sqrt(square / weight);
}

/// Each pair's six unknowns as motions of two instants and, where they are free, two cameras.
RigSystem RigFusion::gathered(std::span<const ViewPair> pairs, std::span<const Sums> sums,
                              bool free) const {
    RigSystem out;
    out.times = static_cast<Eigen::Index>(6 * instants_.size());
    const Eigen::Index n = out.times + static_cast<Eigen::Index>(6 * cameras_.size());
    out.h = Eigen::MatrixXd::Zero(n, n);
    out.g = Eigen::VectorXd::Zero(n);
    struct Block {
        Eigen::Index at;
        Matrix6 by;
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        std::vector<Block> blocks;
        for (const auto& [view, sign] : {std::pair{pairs[k].a, 1.0}, std::pair{pairs[k].b, -1.0}}) {
            const std::uint32_t t = instant_of_[view];
            blocks.push_back({Eigen::Index{6} * t, sign * Matrix6::Identity()});
            if (free)
                blocks.push_back({out.camera(camera_of_[view]), sign * carried(instants_[t])});
        }
        for (const Block& a : blocks) {
            out.g.segment<6>(a.at) += a.by.transpose() * sums[k].g;
            for (const Block& b : blocks)
                out.h.block<6, 6>(a.at, b.at) += a.by.transpose() * sums[k].h * b.by;
        }
    }
    return out;
}

/// The first instant and the first camera stay; other cameras are held as far as they are not free.
void RigFusion::hold(const CameraFreedom& freedom, RigSystem& system) const {
    constexpr double kReading_m = 0.004, kAlike = 400.0; // so many readings err together
    constexpr double kFixed = 1e9;
    const bool free = freedom.turn_rad > 0.0 && freedom.shift_m > 0.0;
    system.h.topLeftCorner<6, 6>().diagonal().array() += kFixed;
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
        const Eigen::Index at = system.camera(c);
        if (c == 0 || !free) {
            system.h.block<6, 6>(at, at).diagonal().array() += kFixed;
            continue;
        }
        const Eigen::AngleAxisd turn((cameras_[c] * told_[c].inverse()).linear());
        // What a motion of the world is at the camera's own place.
        const Matrix6 local = carried(Pose(Eigen::Translation3d(-cameras_[c].translation())));
        Vector6 away, weight;
        away << turn.angle() * turn.axis(), cameras_[c].translation() - told_[c].translation();
        const double readings = kAlike * kReading_m * kReading_m;
        weight << Vec3d::Constant(readings / (freedom.turn_rad * freedom.turn_rad)),
            Vec3d::Constant(readings / (freedom.shift_m * freedom.shift_m));
        system.h.block<6, 6>(at, at) += local.transpose() * weight.asDiagonal() * local;
        system.g.segment<6>(at) += local.transpose() * weight.asDiagonal() * away;
    }
    system.h.diagonal().array() += 1e-6;
}

void RigFusion::place(const CameraFreedom& freedom) {
    if (views_.empty()) throw Error("no picture shows anything to scan");
    constexpr int kRounds = 20;
    for (const float reach : {0.03f, 0.02f}) {
        JointOptions joint;
        joint.reach_m = reach;
        std::vector<Pose> poses;
        for (std::size_t i = 0; i < views_.size(); ++i)
            poses.push_back(pose_of(i));
        const std::vector<ViewPair> near = pairs(poses);
        for (int round = 0; round < kRounds; ++round) {
            double longest = 0.0;
            report_.views_rms_m = step(near, joint, freedom, longest);
            if (longest < 2e-5) break;
        }
    }
    for (std::size_t c = 0; c < cameras_.size(); ++c)
        report_.cameras_moved_m = std::max(
            report_.cameras_moved_m, (cameras_[c].translation() - told_[c].translation()).norm());
}

FusedSurface RigFusion::finish(const std::optional<geometry::Plane>& floor,
                               const std::function<void(double)>& progress) {
    if (views_.empty()) throw Error("no picture shows anything to scan");
    model_.reset();
    FusionOptions options = options_;
    options.close_loop = options.refine_jointly = false; // all are placed already
    const Pose first_from_scan = pose_of(0).inverse(), world = cameras_[camera_of_[0]];
    RigidFusion fusion(options, rows_);
    for (std::size_t i = 0; i < views_.size(); ++i)
        fusion.add_at(std::move(views_[i]), first_from_scan * pose_of(i));
    views_.clear();
    std::optional<geometry::Plane> ground;
    if (floor) ground = moved(world.inverse(), *floor);
    FusedSurface out = fusion.finish(ground, progress);
    move(world, out.mesh);
    return out;
}

} // namespace toile::scan
