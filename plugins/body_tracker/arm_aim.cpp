#include "body_tracker/arm_aim.h"

#include "body/arm_solver.h"
#include "body/rotations.h"

#include <algorithm>
#include <cmath>

namespace toile::body_tracker {
namespace {

using body::Joint;

constexpr std::size_t kFewCells = 10; // unexplained: fewer are an outline's
constexpr float kPalm = 0.08f;        // metres beyond the wrist
constexpr float kThickness = 0.035f;  // from the seen surface to the bone
constexpr float kReach = 1.1f;        // of the arm's length, where its surface may be
constexpr float kBehind = 0.12f;      // metres: a surface so far behind a bone is not its own
constexpr float kOverPast = 0.15f;    // what a place that is seen past costs, metres
constexpr int kSwivels = 8;           // places of the elbow about the line from shoulder to hand
constexpr std::size_t kBends = 2;     // of those that are kept
constexpr std::size_t kTips = 3;
constexpr int kSamples = 4; // along a bone

} // namespace

ArmAim::ArmAim(const GridCamera& camera) : camera_(camera) {
    tips_.reserve(kTips);
    poses_.reserve(kTips * kBends);
}

/// Ends of what is not explained: farthest from the shoulder, nearest to the camera, and lowest or
/// highest in the picture, whichever is farther from both.
void ArmAim::find_tips(const SeenPerson& seen, const Registration& registration,
                       const Arm& arm) noexcept {
    tips_.clear();
    const float reach = kReach * (arm.upper + arm.lower);
    Vec3f farthest = Vec3f::Zero(), nearest = Vec3f::Zero();
    float far = 0.0f, near = -1e9f;
    std::size_t count = 0;
    const auto each = [&](const auto& use) {
        for (int y = seen.mask.low[1]; y <= seen.mask.high[1]; ++y)
            for (int x = seen.mask.low[0]; x <= seen.mask.high[0]; ++x) {
                if (!registration.lacks_body(seen, x, y)) continue;
                const auto i = static_cast<std::size_t>(y * camera_.width + x);
                const Vec3f p = camera_.point(static_cast<float>(x), static_cast<float>(y),
                                              seen.grid.depth[i] + kThickness);
                const float distance = (p - arm.shoulder).norm();
                if (distance < reach) use(p, distance);
            }
    };
    each([&](const Vec3f& p, float distance) {
        ++count;
        if (distance > far) far = distance, farthest = p;
        if (p.z() > near) near = p.z(), nearest = p;
    });
    if (count < kFewCells) return;
    tips_.push_back(farthest);
    if ((nearest - farthest).norm() > 0.15f) tips_.push_back(nearest);
    float apart = 0.2f;
    Vec3f other = Vec3f::Zero();
    each([&](const Vec3f& p, float) {
        const float d = std::min((p - farthest).norm(), (p - nearest).norm());
        if (d > apart) apart = d, other = p;
    });
    if (apart > 0.2f) tips_.push_back(other);
}

/// How far a bone is from where it could be: nothing behind what is seen, much where the camera
/// sees past it.
float ArmAim::misfit(const SeenPerson& seen, const Vec3f& from, const Vec3f& to) const noexcept {
    float sum = 0.0f;
    for (int s = 1; s <= kSamples; ++s) {
        const Vec3f p = from + (static_cast<float>(s) / kSamples) * (to - from);
        if (p.z() >= -0.2f) return 1e3f;
        const Vec2f cell = camera_.cell(p);
        const auto x = static_cast<int>(std::lround(cell.x()));
        const auto y = static_cast<int>(std::lround(cell.y()));
        if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) continue;
        const auto i = static_cast<std::size_t>(y * camera_.width + x);
        const float real = seen.grid.depth[i];
        if (seen.mask.cells[i] == 0)
            sum += real != 0.0f && real < -p.z() ? 0.0f : kOverPast; // a thing before it hides it
        else if (real > -p.z() + kBehind)
            sum += std::min(kOverPast, real + p.z());
        else
            sum += 0.3f * std::max(0.0f, -p.z() - kThickness - real);
    }
    return sum;
}

void ArmAim::bend_towards(const SeenPerson& seen, const TrackedBody& body,
                          const body::JointTransforms& joints, const body::Pose& pose,
                          const Arm& arm, const Vec3f& tip, bool left) noexcept {
    const Vec3f line = body::unit_or(tip - arm.shoulder, Vec3f::UnitX());
    const float d =
        std::clamp((tip - arm.shoulder).norm(), 0.12f, 0.999f * (arm.upper + arm.lower));
    const float along = (arm.upper * arm.upper - arm.lower * arm.lower + d * d) / (2.0f * d);
    const float away = std::sqrt(std::max(0.0f, arm.upper * arm.upper - along * along));
    const Vec3f side = line.unitOrthogonal(), other = line.cross(side);
    const Vec3f hand = arm.shoulder + d * line;
    std::array<std::pair<float, Vec3f>, kSwivels> elbows;
    for (int k = 0; k < kSwivels; ++k) {
        const float angle = 2.0f * body::kPi * static_cast<float>(k) / kSwivels;
        const Vec3f elbow =
            arm.shoulder + along * line + away * (std::cos(angle) * side + std::sin(angle) * other);
        elbows[static_cast<std::size_t>(k)] = {
            misfit(seen, arm.shoulder, elbow) + misfit(seen, elbow, hand), elbow};
    }
    std::partial_sort(elbows.begin(), elbows.begin() + kBends, elbows.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto first =
        static_cast<std::size_t>(left ? Joint::left_upper_arm : Joint::right_upper_arm);
    const auto chest = static_cast<std::size_t>(Joint::upper_chest);
    for (std::size_t k = 0; k < kBends; ++k) {
        const Vec3f& elbow = elbows[k].second;
        body::ArmDirections directions;
        directions.upper = body::unit_or(elbow - arm.shoulder, line);
        directions.lower = directions.hand = body::unit_or(hand - elbow, line);
        directions.thumb = Vec3f::Zero();
        body::JointTransforms moved = joints;
        body::ArmSolver solver(body.skeleton(), left ? 0 : 1);
        solver.solve(joints[chest].rotation, directions, 0.0f, moved);
        body::Pose& out = poses_.emplace_back(pose);
        for (std::size_t j = first; j < first + 3; ++j)
            out.rotations[j] = (moved[j - 1].rotation.conjugate() * moved[j].rotation).normalized();
    }
}

std::span<const body::Pose> ArmAim::reach(const SeenPerson& seen, const TrackedBody& body,
                                          const Registration& registration, const body::Pose& pose,
                                          bool left) noexcept {
    poses_.clear();
    const body::JointTransforms joints = body::forward_kinematics(body.skeleton(), pose);
    const auto first =
        static_cast<std::size_t>(left ? Joint::left_upper_arm : Joint::right_upper_arm);
    const Arm arm{joints[first].translation,
                  (joints[first + 1].translation - joints[first].translation).norm(),
                  (joints[first + 2].translation - joints[first + 1].translation).norm() + kPalm};
    find_tips(seen, registration, arm);
    for (const Vec3f& tip : tips_)
        bend_towards(seen, body, joints, pose, arm, tip, left);
    return poses_;
}

} // namespace toile::body_tracker
