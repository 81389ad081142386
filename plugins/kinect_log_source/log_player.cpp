#include "kinect_log_source/log_player.h"

#include "body/skeleton_tables.h"

namespace toile::kinect_log_source {

namespace {

using body::Joint;
using body::kJointCount;
using body::ObservedSkeleton;

constexpr float kInferredConfidence = 0.4f;
constexpr float kMostTilt = 12.0f * body::kDegree;

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

float confidence_of(std::uint8_t state) {
    return state == 2 ? 1.0f : state == 1 ? kInferredConfidence : 0.0f;
}

/// Our joints in the camera's frame.
ObservedSkeleton observe_frame(const LoggedFrame& frame, const body::SkeletonTable& table) {
    ObservedSkeleton seen;
    for (std::size_t i = 0; i < kJointCount; ++i) {
        const body::JointBlend& blend = table.sources[i];
        const LoggedJoint& a = frame.joints[blend.first];
        const LoggedJoint& b = frame.joints[blend.second];
        seen.positions[i] = a.position + blend.fraction * (b.position - a.position);
        seen.confidence[i] = std::min(confidence_of(a.state), confidence_of(b.state));
    }
    const bool v2 = table.joints.size() == 25;
    constexpr std::array<std::array<std::size_t, 2>, 2> v2_tips = {{{21, 23}, {22, 24}}};
    for (std::size_t side = 0; side < 2; ++side) {
        const LoggedJoint& tip = frame.joints[v2 ? v2_tips[0][side] : 7 + 4 * side];
        seen.fingertip[side] = tip.position;
        seen.fingertip_confidence[side] = confidence_of(tip.state);
        const LoggedJoint& thumb = frame.joints[v2 ? v2_tips[1][side] : 7 + 4 * side];
        seen.thumb[side] = thumb.position;
        seen.thumb_confidence[side] = v2 ? confidence_of(thumb.state) : 0.0f;
    }
    return seen;
}

float median(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Vec3f median(const std::vector<Vec3f>& points) {
    Vec3f out;
    std::vector<float> values(points.size());
    for (Eigen::Index k = 0; k < 3; ++k) {
        std::transform(points.begin(), points.end(), values.begin(),
                       [k](const Vec3f& p) { return p[k]; });
        out[k] = median(values);
    }
    return out;
}

/// Up in the camera's frame, from how the person stands on average.
Vec3f find_up(const std::vector<ObservedSkeleton>& frames) {
    std::vector<Vec3f> standing;
    std::vector<Vec3f> trunk;
    for (const ObservedSkeleton& frame : frames) {
        const auto& p = frame.positions;
        const auto tracked = [&](Joint joint) { return frame.confidence[index(joint)] > 0.9f; };
        if (!tracked(Joint::neck) || !tracked(Joint::hips)) continue;
        trunk.push_back((p[index(Joint::neck)] - p[index(Joint::hips)]).normalized());
        const bool feet = tracked(Joint::left_foot) && tracked(Joint::right_foot) &&
                          tracked(Joint::left_toes) && tracked(Joint::right_toes);
        if (!feet) continue;
        const Vec3f sole = 0.25f * (p[index(Joint::left_foot)] + p[index(Joint::right_foot)] +
                                    p[index(Joint::left_toes)] + p[index(Joint::right_toes)]);
        standing.push_back(
            (0.5f * (p[index(Joint::neck)] + p[index(Joint::hips)]) - sole).normalized());
    }
    const bool by_feet = 3 * standing.size() > frames.size();
    const auto& evidence = by_feet ? standing : trunk;
    if (evidence.size() < 3) return Vec3f::UnitY();
    const Vec3f up = body::unit_or(median(evidence), Vec3f::UnitY());
    return body::limit_angle(body::swing(Vec3f::UnitY(), up), kMostTilt) * Vec3f::UnitY();
}

/// Where the person begins: hips over the first half second.
Vec3f find_start(const std::vector<ObservedSkeleton>& frames) {
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < std::min<std::size_t>(frames.size(), 15); ++i)
        points.push_back(frames[i].positions[0]);
    return median(points);
}

} // namespace

std::vector<ObservedSkeleton> observe(const KinectLog& log) {
    const auto& table = log.joint_count == 20 ? body::kinect_v1_table() : body::kinect_v2_table();
    std::vector<ObservedSkeleton> frames;
    frames.reserve(log.frames.size());
    for (const LoggedFrame& frame : log.frames)
        frames.push_back(observe_frame(frame, table));
    // Upright, then half a turn about Y: the person who looked along the camera's -z faces +Z.
    const Quatf turn =
        body::about(Vec3f::UnitY(), body::kPi) * body::swing(find_up(frames), Vec3f::UnitY());
    const Vec3f start = turn * find_start(frames);
    const Vec3f origin(start.x(), 0.0f, start.z());
    for (ObservedSkeleton& frame : frames) {
        for (Vec3f& p : frame.positions)
            p = turn * p - origin;
        for (std::size_t side = 0; side < 2; ++side) {
            frame.fingertip[side] = turn * frame.fingertip[side] - origin;
            frame.thumb[side] = turn * frame.thumb[side] - origin;
        }
    }
    return frames;
}

LogPlayer::LogPlayer(const KinectLog& log, const body::Skeleton& skeleton,
                     std::optional<body::BodyVolumes> volumes)
    : observed_(observe(log)), person_(body::measure_person(skeleton, observed_)),
      retargeter_(skeleton, person_, std::move(volumes)) {
    times_ns_.reserve(log.frames.size());
    for (const LoggedFrame& frame : log.frames)
        times_ns_.push_back((frame.time_100ns - log.frames.front().time_100ns) * 100);
}

void LogPlayer::forget() noexcept {
    fresh_ = true;
    retargeter_.reset();
}

bool LogPlayer::advance() noexcept {
    if (next_ >= observed_.size()) return false;
    const ObservedSkeleton& seen = observed_[next_];
    const float dt =
        fresh_ ? 0.0f : static_cast<float>(times_ns_[next_] - times_ns_[next_ - 1]) * 1e-9f;
    const body::JointTransforms before = frame_.joints;
    const body::RetargetedFrame& posed = retargeter_.update(seen, dt);
    frame_.sequence = static_cast<std::uint32_t>(next_);
    frame_.timestamp_ns = times_ns_[next_];
    frame_.joints = posed.joints;
    frame_.confidence = posed.confidence;
    arm_depth_ = posed.arm_depth;
    for (std::size_t i = 0; i < kJointCount; ++i) {
        if (dt <= 0.0f) {
            frame_.linear_velocity[i].setZero();
            frame_.angular_velocity[i].setZero();
            continue;
        }
        const RigidTransform& now = frame_.joints[i];
        frame_.linear_velocity[i] = (now.translation - before[i].translation) / dt;
        frame_.angular_velocity[i] =
            body::rotation_vector(now.rotation * before[i].rotation.conjugate()) / dt;
    }
    float trunk = 0.0f;
    float any = 0.0f;
    for (const Joint joint : {Joint::hips, Joint::chest, Joint::neck})
        trunk += seen.confidence[index(joint)] / 3.0f;
    for (const float c : seen.confidence)
        any = std::max(any, c);
    using Tracking = PlayedFrame::Tracking;
    frame_.tracking = any <= 0.0f    ? Tracking::lost
                      : trunk < 0.5f ? Tracking::uncertain
                                     : Tracking::tracked;
    fresh_ = false;
    ++next_;
    return true;
}

} // namespace toile::kinect_log_source
