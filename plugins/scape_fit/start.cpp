#include "scape_fit/start.h"

#include "body/usual_poses.h"

#include "body/rotations.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace toile::scape_fit {
namespace {

using body::Joint;
using body::kDegree;

constexpr float kFar = 0.15f; // metres
constexpr int kYaws = 16;
constexpr int kShifts = 4;
constexpr std::size_t kFewer = 5;      // every n-th point for the quick look
constexpr std::size_t kGoodLook = 300; // candidates looked at with all points

constexpr std::array<float, 2> kLegs{0.0f, 12.0f}; // degrees apart, more than at rest

/// Middle of a sex's people, moved along their largest variation.
ShapeVector library_shape(const body::BodySpace& space, body::Sex sex, double deviations) {
    const body::CoefficientPrior& prior = space.prior(sex);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(prior.covariance);
    const int last = static_cast<int>(prior.mean.size()) - 1;
    return prior.mean +
           deviations * std::sqrt(axes.eigenvalues()[last]) * axes.eigenvectors().col(last);
}

Mat3f upright(const Vec3f& up, float yaw) {
    return (body::swing(Vec3f::UnitY(), up) * body::about(Vec3f::UnitY(), yaw)).toRotationMatrix();
}

struct Candidate {
    std::size_t entry = 0;
    Mat3f turn;  ///< world from body
    Vec3f shift; ///< of the body in the world
    double score = 0.0;
};

bool alike(const Start& a, const Start& b) {
    const float angle = a.pose.rotations[0].angularDistance(b.pose.rotations[0]);
    const auto arm = static_cast<std::size_t>(Joint::left_upper_arm);
    const auto elbow = static_cast<std::size_t>(Joint::left_lower_arm);
    return angle < 20.0f * kDegree &&
           a.pose.rotations[arm].angularDistance(b.pose.rotations[arm]) < 5.0f * kDegree &&
           a.pose.rotations[elbow].angularDistance(b.pose.rotations[elbow]) < 5.0f * kDegree;
}

} // namespace

StartLibrary::StartLibrary(const FitModel& model) {
    const body::Skeleton& usual = model.space().model().skeleton;
    for (const auto arms : {body::usual_arms(), body::single_arms()})
        for (const body::ArmPose& arm : arms)
            arms_.push_back(body::usual_pose(usual, arm, 0.0f));
    const FitLevel& level = model.level(model.level_count() - 1);
    PosedLevel posed;
    for (const body::Sex sex : body::kSexes)
        for (const double deviations : {-1.0, 1.0}) {
            const ShapeVector shape = library_shape(model.space(), sex, deviations);
            const body::Skeleton skeleton = model.skeleton(shape);
            for (const body::ArmPose& arm : body::usual_arms())
                for (const float legs : kLegs) {
                    const body::Pose pose = body::usual_pose(skeleton, arm, legs);
                    pose_level(model, level, {shape, {}}, pose, posed);
                    Entry entry{shape,
                                pose,
                                geometry::PointTree(posed.positions),
                                posed.positions[0],
                                posed.positions[0],
                                Vec3f::Zero()};
                    for (const Vec3f& p : posed.positions) {
                        entry.low = entry.low.cwiseMin(p);
                        entry.high = entry.high.cwiseMax(p);
                        entry.middle += p / static_cast<float>(posed.positions.size());
                    }
                    entries_.push_back(std::move(entry));
                }
        }
}

std::size_t StartLibrary::arm_count() noexcept {
    return body::usual_arms().size() + body::single_arms().size();
}

body::Pose StartLibrary::with_arm(const body::Pose& pose, bool left, std::size_t way) const {
    return body::with_arm(pose, left, arms_[way]);
}

std::vector<Start> StartLibrary::find(std::span<const Vec3f> points, std::span<const Vec3f> ups,
                                      std::size_t count, const RowLoop& rows) const {
    Vec3f middle = Vec3f::Zero();
    for (const Vec3f& p : points)
        middle += p / static_cast<float>(points.size());
    // A quick look with few points at everything, then a good one at the best.
    std::vector<Vec3f> few;
    for (std::size_t i = 0; i < points.size(); i += kFewer)
        few.push_back(points[i]);
    const auto judge = [&](Candidate& out, std::span<const Vec3f> seen, int shifts) {
        const Entry& entry = entries_[out.entry];
        for (int round = 0; round <= shifts; ++round) {
            Vec3f off = Vec3f::Zero();
            out.score = 0.0;
            for (const Vec3f& p : seen) {
                const Vec3f local = out.turn.transpose() * (p - out.shift);
                const auto near = entry.tree.nearest(local);
                const float distance = std::sqrt(near.squared);
                const Vec3f way = local - entry.tree.points()[near.index];
                off += way * std::min(1.0f, kFar / std::max(distance, 1e-6f));
                out.score += std::min(distance, kFar);
            }
            out.score /= static_cast<double>(seen.size());
            if (round < shifts) out.shift += out.turn * off / static_cast<float>(seen.size());
        }
    };
    std::vector<Candidate> candidates(entries_.size() * ups.size() * kYaws);
    for (std::size_t index = 0; index < candidates.size(); ++index) {
        Candidate& out = candidates[index];
        out.entry = index / (ups.size() * kYaws);
        const Entry& entry = entries_[out.entry];
        const Vec3f up = ups[index / kYaws % ups.size()];
        out.turn = upright(up, 2.0f * body::kPi * static_cast<float>(index % kYaws) / kYaws);
        // The head's top stands where the points' does; feet may be out of sight.
        float top = -1e9f;
        for (const Vec3f& p : points)
            top = std::max(top, up.dot(p));
        out.shift = middle - out.turn * entry.middle;
        out.shift += up * (top - entry.high.y() - up.dot(out.shift));
    }
    const auto judge_all = [&](std::span<const Vec3f> seen, int shifts) {
        rows(static_cast<std::uint32_t>(candidates.size()), 8,
             [&](std::uint32_t begin, std::uint32_t end) {
                 for (std::uint32_t i = begin; i < end; ++i)
                     judge(candidates[i], seen, shifts);
             });
        std::stable_sort(candidates.begin(), candidates.end(),
                         [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
    };
    judge_all(few, 1);
    candidates.resize(std::min(candidates.size(), kGoodLook));
    judge_all(points, kShifts);
    std::vector<Start> out;
    for (const Candidate& candidate : candidates) {
        if (out.size() >= count) break;
        const Entry& entry = entries_[candidate.entry];
        Start start{entry.shape, entry.pose, candidate.score};
        start.pose.rotations[0] = Quatf(candidate.turn).normalized();
        start.pose.hips_position = candidate.shift;
        if (std::none_of(out.begin(), out.end(), [&](const Start& s) { return alike(s, start); }))
            out.push_back(std::move(start));
    }
    return out;
}

} // namespace toile::scape_fit
