#include "body_tracker/person_track.h"

#include "body/rotations.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::Joint;
using body::kJointCount;

constexpr float kUsualStep = 1.0f / 30.0f; // seconds
constexpr float kKeepsMoving = 0.8f;       // share of the last motion that goes on
constexpr int kSearchAfter = 2;            // failures in a row
constexpr float kNobody = 0.45f;           // not explained: what was found is no person
constexpr float kSurelyNobody = 0.6f;
// A shelf leaves 0.23 to 0.39 and has a support of 0.09 to 0.18; people 0.15 at most, or more of
// both.
constexpr float kFurniture = 0.2f, kFurnitureSupport = 0.25f;
constexpr float kAstraySeconds = 1.0f; // nobody is followed where nobody is
constexpr float kLearnBelow = 0.3f;    // not explained: a wrong shape alone may do that
constexpr int kFirstSteps = 2;
constexpr int kMarkSteps = 2;
constexpr int kTryTurnedEvery = 30; // frames
constexpr int kTurnedSteps = 6;
constexpr int kTryArmEvery = 24, kTryUneasyArmEvery = 6, kTryLostArmEvery = 2; // frames
constexpr float kUneasy = 0.06f;                                               // not explained
constexpr float kArmLost = 0.025f; // more than usual for that person
constexpr float kUpright = 0.9f;   // cosine
constexpr float kUsualSeconds = 1.5f, kBetterSeconds = 0.2f;
constexpr float kTurnedBetter = 0.01f, kTurnedBackwards = -0.03f, kTurnedAhead = 0.03f; // badness
constexpr float kWalks = 0.35f;                                                         // m/s
constexpr float kDriftSeconds = 0.3f;                    // over which that is told
constexpr float kFootStands = 0.15f, kFootSwings = 0.5f; // m/s
constexpr int kBackwardsFrames = 8;
constexpr std::size_t kFewCells = 40;
constexpr float kUsualHeight = 1.70f, kShortest = 1.45f, kTallest = 2.05f; // metres
constexpr float kFullView = 0.30f; // share of a part's skin seen that gives all confidence

/// Radians that a joint may turn within a thirtieth of a second.
double turn_of(Joint joint) noexcept {
    switch (joint) {
    case Joint::left_upper_arm:
    case Joint::right_upper_arm:
    case Joint::left_lower_arm:
    case Joint::right_lower_arm:
        return 0.35;
    case Joint::left_upper_leg:
    case Joint::right_upper_leg:
    case Joint::left_lower_leg:
    case Joint::right_lower_leg:
        return 0.25;
    case Joint::hips:
    case Joint::head:
        return 0.15;
    default:
        return 0.08;
    }
}

/// By the picture's upper border or a side.
bool cut_off(const SeenPerson& seen) noexcept {
    return seen.mask.low[1] <= 1 || seen.mask.low[0] <= 0 ||
           seen.mask.high[0] >= seen.grid.camera.width - 1;
}

/// Of the person's cells; camera frame.
Vec3f middle_of(const SeenPerson& seen) noexcept {
    const GridCamera& camera = seen.grid.camera;
    Vec3f sum = Vec3f::Zero();
    for (int y = seen.mask.low[1]; y <= seen.mask.high[1]; ++y)
        for (int x = seen.mask.low[0]; x <= seen.mask.high[0]; ++x) {
            const auto i = static_cast<std::size_t>(y * camera.width + x);
            if (seen.mask.cells[i] != 0)
                sum +=
                    camera.point(static_cast<float>(x), static_cast<float>(y), seen.grid.depth[i]);
        }
    return sum / static_cast<float>(std::max<std::size_t>(1, seen.mask.count));
}

} // namespace

PersonTrack::PersonTrack(const body::FitModel& model, const GridCamera& camera,
                         const TrackOptions& options)
    : options_(options), body_(model), parts_(options.forest.get(), body_, camera),
      registration_(body_, camera), search_(body_, parts_, camera), marks_(body_, options.marks),
      smoother_(options.smoothing), mask_(camera) {
    const body::FitLevel& level = body_.level();
    for (std::size_t n = 0; n < level.triangles.size(); ++n) {
        const Triangle& t = level.triangles[n];
        part_area_[static_cast<std::size_t>(body_.leader(static_cast<std::int32_t>(n)))] +=
            0.5f *
            (level.mean[t[1]] - level.mean[t[0]]).cross(level.mean[t[2]] - level.mean[t[0]]).norm();
    }
}

bool PersonTrack::failed() const noexcept {
    return agreement_.error_m > options_.failed_error_m ||
           agreement_.unexplained > options_.failed_share;
}

bool PersonTrack::start(std::uint32_t id, const SeenPerson& seen, const Vec3f& up) noexcept {
    search_.restart();
    search_.expect(Vec3f::Zero());
    learner_.reset();
    marks_.reset();
    const std::optional<float> height = PoseSearch::height_of(seen, up);
    height_known_ = height.has_value();
    whole_ = false;
    // Whoever bends or sits is taller than that.
    body_.set_stature(std::clamp(height.value_or(kUsualHeight), kShortest, kTallest));
    (void)search_.advance(seen, up, nullptr, registration_);
    pose_ = search_.provisional();
    for (int step = 0; step < kFirstSteps; ++step)
        (void)registration_.step(seen, options_.registration, nullptr, pose_);
    agreement_ = registration_.judge(seen, pose_);
    if (agreement_.unexplained > kSurelyNobody) return false;
    id_ = id;
    ++shape_version_;
    last_ = pose_;
    moving_ = sure_ = false;
    recovering_ = true;
    failures_ = since_turned_ = since_arm_ = 0;
    unseen_s_ = astray_s_ = 0.0f;
    usual_ = agreement_.unexplained;
    drift_.setZero();
    middle_ = middle_of(seen);
    known_s_ = 0.0f;
    smoother_.reset();
    options_.registration.stands = {1.0f, 1.0f};
    settle(seen, 0.0f);
    following_ = Following::detected;
    return true;
}

/// The other facing fits nearly as well now and then; when it fits better it is right. Nobody walks
/// backwards for long.
void PersonTrack::try_turned(const SeenPerson& seen) noexcept {
    search_.expect(Vec3f::Zero()); // the margins below say it
    const float ahead = drift_.dot(pose_.rotations[0] * Vec3f::UnitZ());
    const bool backwards = ahead < -kWalks;
    if (++since_turned_ < (backwards ? kBackwardsFrames : kTryTurnedEvery) || failed()) return;
    since_turned_ = 0;
    parts_.look(seen);
    const float as_is = search_.rate(seen, pose_, registration_);
    body::Pose pose = PoseSearch::turned_around(pose_);
    for (int step = 0; step < kTurnedSteps; ++step)
        (void)registration_.step(seen, options_.registration, nullptr, pose);
    const float turned = search_.rate(seen, pose, registration_);
    const float margin = backwards        ? kTurnedBackwards
                         : ahead > kWalks ? kTurnedAhead
                                          : kTurnedBetter;
    if (turned + margin < as_is) {
        pose_ = pose;
        moving_ = false;
    }
    agreement_ = registration_.judge(seen, pose_);
}

/// An arm may have been lost where it was hidden or fast.
void PersonTrack::try_arm(const SeenPerson& seen) noexcept {
    const bool lost = agreement_.unexplained > usual_ + kArmLost;
    const bool uneasy = agreement_.unexplained > kUneasy;
    if (++since_arm_ < (lost && uneasy ? kTryLostArmEvery
                        : uneasy       ? kTryUneasyArmEvery
                                       : kTryArmEvery))
        return;
    since_arm_ = 0;
    left_arm_ = !left_arm_;
    parts_.look(seen);
    if (search_.retry_arm(seen, left_arm_, options_.registration, pose_, registration_))
        moving_ = false;
    agreement_ = registration_.judge(seen, pose_);
}

void PersonTrack::predict(float dt) noexcept {
    motion_.pose = pose_;
    if (moving_ && dt > 0.0f) {
        motion_.pose.hips_position += kKeepsMoving * (pose_.hips_position - last_.hips_position);
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const Vec3f turned =
                body::rotation_vector(pose_.rotations[j] * last_.rotations[j].conjugate());
            motion_.pose.rotations[j] =
                (body::from_rotation_vector(kKeepsMoving * turned) * pose_.rotations[j])
                    .normalized();
        }
    }
    const double steps = std::sqrt(std::clamp(static_cast<double>(dt / kUsualStep), 0.5, 6.0));
    motion_.place_m = 0.04 * steps;
    for (std::size_t j = 0; j < kJointCount; ++j)
        motion_.turn[j] = turn_of(static_cast<Joint>(j)) * steps;
    bones_.set(body::forward_kinematics(body_.skeleton(), motion_.pose));
}

/// Searches in frame after frame while the pose so far is followed on.
void PersonTrack::recover(const SeenPerson& seen, const Vec3f& up) noexcept {
    if (!recovering_) search_.restart();
    recovering_ = true;
    search_.expect(drift_);
    const auto found = search_.advance(seen, up, sure_ ? &pose_ : nullptr, registration_);
    if (found) {
        if (found->badness < search_.rate(seen, pose_, registration_)) {
            pose_ = found->pose;
            moving_ = false;
            if (!sure_) smoother_.reset();
        }
        recovering_ = false;
        failures_ = 0;
        since_turned_ = kTryTurnedEvery - kBackwardsFrames; // soon
    }
    agreement_ = registration_.judge(seen, pose_);
    if (!found || sure_) return;
    const bool furniture = parts_.useful() && agreement_.unexplained > kFurniture &&
                           parts_.support(registration_.drawing()) < kFurnitureSupport;
    if (furniture || agreement_.unexplained > kNobody)
        stop();
    else
        sure_ = true;
}

/// Where the person goes; at first told from what is seen, as poses leap while the search goes on.
void PersonTrack::drift(const SeenPerson& seen, const Vec3f& hips, float dt) noexcept {
    const Vec3f middle = middle_of(seen);
    const Vec3f way = sure_ ? Vec3f(pose_.hips_position - hips) : Vec3f(middle - middle_);
    middle_ = middle;
    known_s_ += dt;
    drift_ += std::max(body::approach(dt, kDriftSeconds), dt / std::max(known_s_, 1e-3f)) *
              (way / std::max(dt, 1e-3f) - drift_);
}

/// Places on the skin that were seen before turn limbs about their bones.
void PersonTrack::follow_marks(const SeenPerson& seen, body::Pose& pose) noexcept {
    marks_.find(seen, pose);
    if (marks_.pulls().empty()) return;
    SeenPerson with = seen;
    with.pulls = marks_.pulls();
    for (int step = 0; step < kMarkSteps; ++step)
        (void)registration_.step(with, options_.registration, &motion_, pose);
}

void PersonTrack::follow(const SeenPerson& seen, const Vec3f& up, float dt) noexcept {
    if (seen.mask.count < kFewCells) {
        unseen_s_ += dt;
        following_ = Following::lost;
        confidence_.fill(0.0f);
        moving_ = false;
        return;
    }
    unseen_s_ = 0.0f;
    const body::Pose before = pose_;
    body::Pose pose = motion_.pose;
    for (const Joint foot : {Joint::left_foot, Joint::right_foot})
        options_.registration.stands[foot == Joint::left_foot ? 0 : 1] =
            1.0f - body::smooth_step(kFootStands, kFootSwings,
                                     velocity_[static_cast<std::size_t>(foot)].norm());
    for (int step = 0; step < options_.steps; ++step)
        if (registration_.step(seen, options_.registration, &motion_, pose) < options_.settled_rad)
            break;
    follow_marks(seen, pose);
    pose_ = pose;
    last_ = before;
    moving_ = true;
    drift(seen, before.hips_position, dt);
    agreement_ = registration_.judge(seen, pose_);
    if (sure_ && failed() && failures_ == 0)
        for (int side = 0; side < 2; ++side) {
            since_arm_ = kTryArmEvery;
            try_arm(seen);
        }
    failures_ = failed() ? failures_ + 1 : 0;
    if (!sure_ || (options_.recover && failures_ >= kSearchAfter)) {
        recover(seen, up);
    } else {
        recovering_ = false;
        try_turned(seen);
        try_arm(seen);
    }
    astray_s_ = agreement_.unexplained > kNobody ? astray_s_ + dt : 0.0f;
    if (astray_s_ > kAstraySeconds) stop();
    if (!active()) return;
    if (!height_known_ && sure_) measure_height(seen, up);
    settle(seen, dt);
}

/// Who came into view cut off is as tall as first seen whole, and upright.
void PersonTrack::measure_height(const SeenPerson& seen, const Vec3f& up) noexcept {
    const std::optional<float> height = PoseSearch::height_of(seen, up);
    if (!height || cut_off(seen)) return;
    // Who is taller than was thought stands; else only a pose that is right tells.
    if (*height < kUsualHeight &&
        (failed() || up.dot(pose_.rotations[0] * Vec3f::UnitY()) < kUpright))
        return;
    height_known_ = true;
    body_.set_stature(std::clamp(*height, kShortest, kTallest));
    learner_.reset();
    ++shape_version_;
    agreement_ = registration_.judge(seen, pose_);
}

/// What follows from the frame's pose.
void PersonTrack::settle(const SeenPerson& seen, float dt) noexcept {
    following_ = failed() ? Following::uncertain
                 : !sure_ ? Following::detected
                          : Following::tracked;
    if (!whole_ && sure_ && !cut_off(seen) && seen.mask.high[1] < seen.grid.camera.height - 1) {
        whole_ = true;
        learner_.reset(); // what was learned of a part of the person says little
    }
    if (options_.learn_shape && sure_ && agreement_.unexplained < kLearnBelow && learner_.wants()) {
        learner_.add(registration_, seen, options_.registration, body_.shape(), body_.wear());
        if (learner_.due()) {
            body::ShapeVector shape = body_.shape();
            Wear wear{};
            learner_.solve(shape, wear);
            body_.set_shape(shape, wear);
            ++shape_version_;
            agreement_ = registration_.judge(seen, pose_);
        }
    }
    const float more = agreement_.unexplained - usual_;
    usual_ += body::approach(dt, more > 0.0f ? kUsualSeconds : kBetterSeconds) * more;
    if (following_ == Following::tracked) marks_.learn(seen, pose_, dt);
    rate_joints(seen);
    show(dt);
}

/// Smooths the pose; `dt` 0: the first frame.
void PersonTrack::show(float dt) noexcept {
    const body::JointTransforms before = joints_;
    joints_ = body::forward_kinematics(body_.skeleton(), smoother_.update(pose_, dt));
    for (std::size_t j = 0; j < kJointCount; ++j) {
        if (dt <= 0.0f) {
            velocity_[j].setZero();
            turning_[j].setZero();
            continue;
        }
        velocity_[j] = (joints_[j].translation - before[j].translation) / dt;
        turning_[j] =
            body::rotation_vector(joints_[j].rotation * before[j].rotation.conjugate()) / dt;
    }
    bones_.set(joints_);
}

/// How much of each part is seen where the body has it.
void PersonTrack::rate_joints(const SeenPerson& seen) noexcept {
    std::array<float, kJointCount> area{};
    const Drawing& drawing = registration_.drawing();
    const PosedBody& posed = registration_.posed();
    for (std::size_t i = 0; i < drawing.cells.size(); ++i) {
        const DrawnCell& cell = drawing.cells[i];
        if (cell.depth == 0.0f || seen.mask.cells[i] == 0 ||
            std::abs(cell.depth - seen.grid.depth[i]) > options_.failed_error_m)
            continue;
        const auto t = static_cast<std::size_t>(cell.triangle);
        const Vec3f& p = posed.positions[body_.level().triangles[t][0]];
        const float facing = -posed.normals[body_.level().triangles[t][0]].dot(p) / p.norm();
        const float width = seen.grid.camera.footprint(cell.depth);
        area[static_cast<std::size_t>(body_.leader(cell.triangle))] +=
            width * width / std::max(0.3f, facing);
    }
    const float trust =
        1.0f - std::min(1.0f, agreement_.unexplained / (2.0f * options_.failed_share));
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const float full = kFullView * part_area_[j];
        const float share = full > 0.0f ? std::min(1.0f, area[j] / full) : 0.0f;
        confidence_[j] = share * (0.5f + 0.5f * trust);
    }
}

} // namespace toile::body_tracker
