#include "garment/pose_match.h"

#include "body/skinning.h"
#include "body/usual_poses.h"
#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace toile::garment {
namespace {

constexpr std::size_t kMostSamples = 1500;
constexpr float kFar = 0.08f;      // metres: cloth farther from the skin tells nothing of the pose
constexpr float kInside = 3.0f;    // how much more a metre inside counts than one outside
constexpr float kLeastTurn = 3.0f; // degrees: less is not worth bending cloth for
constexpr double kGain = 0.85;     // of the mean distance that is left, or nothing is moved
constexpr int kSmoothing = 25;     // rounds of evening out weights along the cloth

using Weights = std::array<float, body::kJointCount>;

/// Lift, forward, elbow, legs in degrees; up and ahead in centimetres.
constexpr std::size_t kUnknowns = 6;
using Unknowns = std::array<float, kUnknowns>;
constexpr Unknowns kLow{-50.0f, -30.0f, -10.0f, -15.0f, -4.0f, -4.0f};
constexpr Unknowns kHigh{60.0f, 40.0f, 45.0f, 20.0f, 4.0f, 4.0f};
constexpr double kShiftCost = 0.2; // per metre: along straight parts nothing else holds it

/// Which unknowns the garment tells of: arms only with sleeves, legs only with trouser legs.
std::array<bool, kUnknowns> told(const body::Skeleton& skeleton, std::span<const Vec3f> garment) {
    using body::Joint;
    constexpr float kBeside = 1.15f;     // of a shoulder's distance from the middle
    constexpr float kMiddle = 0.02f;     // metres from the middle: a skirt has cloth there
    constexpr double kLeast = 0.04;      // share of all vertices
    constexpr double kMostMiddle = 0.01; // share of those on the legs
    const float shoulder = kBeside * skeleton.rest(Joint::left_upper_arm).x();
    const float waist = skeleton.rest(Joint::spine).y();
    const float thigh = 0.5f * (skeleton.rest(Joint::left_upper_leg).y() +
                                skeleton.rest(Joint::left_lower_leg).y());
    std::size_t arms = 0;
    std::size_t legs = 0;
    std::size_t middle = 0;
    for (const Vec3f& p : garment) {
        arms += p.y() > waist && std::abs(p.x()) > shoulder ? 1 : 0;
        legs += p.y() < thigh ? 1 : 0;
        middle += p.y() < thigh && std::abs(p.x()) < kMiddle ? 1 : 0;
    }
    const auto enough = kLeast * static_cast<double>(garment.size());
    const bool sleeves = static_cast<double>(arms) > enough;
    const bool trousers = static_cast<double>(legs) > enough &&
                          static_cast<double>(middle) < kMostMiddle * static_cast<double>(legs);
    const bool any = sleeves || trousers;
    return {sleeves, sleeves, sleeves, trousers, any, any};
}

/// The body in any of the poses that are tried, and how a garment sits on it.
class Fitter {
  public:
    Fitter(const body::BodyModel& body, std::span<const Vec3f> garment)
        : body_(body), skin_(body.rest.positions, {}, body.skin.joints, body.skin.weights),
          posed_(body.rest.positions), nearest_(posed_, body.rest.triangles) {
        const std::size_t step = std::max<std::size_t>(1, garment.size() / kMostSamples);
        for (std::size_t v = 0; v < garment.size(); v += step)
            samples_.push_back(garment[v]);
        hits_.resize(samples_.size());
        moved_.resize(samples_.size());
    }

    /// Skinning transforms of the pose; the garment's shift is not among them.
    [[nodiscard]] body::JointTransforms transforms(const Unknowns& u) const {
        body::Pose pose = body::usual_pose(body_.skeleton, {0.0f, u[0], u[1], u[2], 0.0f}, u[3]);
        pose.hips_position = body_.skeleton.rest(body::Joint::hips);
        return body::skinning_transforms(body_.skeleton,
                                         body::forward_kinematics(body_.skeleton, pose));
    }
    [[nodiscard]] static Vec3f shift(const Unknowns& u) {
        return {0.0f, 0.01f * u[4], 0.01f * u[5]};
    }

    /// Mean distance from the skin, inside counting more; m.
    double cost(const Unknowns& u) {
        pose(u);
        for (std::size_t i = 0; i < samples_.size(); ++i)
            moved_[i] = samples_[i] + shift(u);
        nearest_.nearest(moved_, hits_, 2.0f * kFar);
        double sum = 0.0;
        for (const geometry::SurfacePoint& hit : hits_) {
            const float d = hit.triangle == geometry::kNoTriangle ? kFar : hit.signed_distance;
            sum += static_cast<double>(std::min(kFar, d < 0.0f ? -kInside * d : d));
        }
        return sum / static_cast<double>(samples_.size()) +
               kShiftCost * static_cast<double>(shift(u).norm());
    }

    /// Weights of the skin next to a point of the garment, with the body as posed last.
    [[nodiscard]] Weights weights_at(const Vec3f& point) const {
        Weights out{};
        const geometry::SurfacePoint hit = nearest_.nearest(point);
        const Triangle& t = body_.rest.triangles[hit.triangle];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 4; ++j)
                out[body_.skin.joints[t[k]][j]] +=
                    hit.barycentric[static_cast<Eigen::Index>(k)] * body_.skin.weights[t[k]][j];
        return out;
    }

    void pose(const Unknowns& u) {
        skin_.pose(transforms(u), body::SkinningMethod::linear_blend,
                   body::VectorRows(std::span(posed_)), {});
        nearest_.refit(posed_);
    }

  private:
    const body::BodyModel& body_;
    body::SkinnedSurface skin_;
    std::vector<Vec3f> posed_, samples_, moved_;
    geometry::NearestSurface nearest_;
    std::vector<geometry::SurfacePoint> hits_;
};

/// One unknown after the other, in ever smaller steps.
Unknowns best_pose(Fitter& fitter, const std::array<bool, kUnknowns>& told, double& best) {
    Unknowns u{};
    best = fitter.cost(u);
    const auto attempt = [&](std::size_t i, float value) {
        if (!told[i]) return false;
        Unknowns other = u;
        other[i] = std::clamp(value, kLow[i], kHigh[i]);
        if (other[i] == u[i]) return false;
        const double cost = fitter.cost(other);
        if (cost >= best) return false;
        best = cost;
        u = other;
        return true;
    };
    for (float lift = kLow[0]; lift <= kHigh[0]; lift += 10.0f)
        attempt(0, lift);
    for (const float share : {1.0f, 0.5f, 0.25f, 0.1f})
        for (int round = 0; round < 3; ++round) {
            bool better = false;
            for (std::size_t i = 0; i < kUnknowns; ++i) {
                const float step = share * (i < 4 ? 8.0f : 2.0f);
                better = attempt(i, u[i] + step) || attempt(i, u[i] - step) || better;
            }
            if (!better) break;
        }
    return u;
}

/// One number for equal places.
std::vector<std::uint32_t> welded(std::span<const Vec3f> positions, std::size_t& count) {
    std::map<std::array<float, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> out;
    out.reserve(positions.size());
    for (const Vec3f& p : positions)
        out.push_back(
            known.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(known.size()))
                .first->second);
    count = known.size();
    return out;
}

void even_out(const geometry::VertexAdjacency& rows, std::vector<Weights>& weights) {
    std::vector<Weights> next = weights;
    for (int round = 0; round < kSmoothing; ++round) {
        for (std::size_t v = 0; v < weights.size(); ++v) {
            const std::uint32_t from = rows.first[v];
            const std::uint32_t to = rows.first[v + 1];
            for (std::size_t j = 0; j < body::kJointCount; ++j) {
                float sum = weights[v][j];
                for (std::uint32_t k = from; k < to; ++k)
                    sum += weights[rows.neighbours[k]][j];
                next[v][j] = sum / static_cast<float>(1 + to - from);
            }
        }
        weights.swap(next);
    }
}

/// Takes the garment from the pose back to rest.
void take_back(const Unknowns& u, Fitter& fitter, std::span<const Triangle> triangles,
               std::span<Vec3f> positions, std::vector<Mat3f>& turns) {
    std::size_t count = 0;
    const std::vector<std::uint32_t> vertex = welded(positions, count);
    std::vector<Triangle> shared(triangles.begin(), triangles.end());
    for (Triangle& t : shared)
        for (std::uint32_t& v : t)
            v = vertex[v];
    std::vector<Vec3f> places(count);
    for (std::size_t v = 0; v < positions.size(); ++v)
        places[vertex[v]] = positions[v] + Fitter::shift(u);
    fitter.pose(u);
    std::vector<Weights> weights;
    weights.reserve(count);
    for (const Vec3f& place : places)
        weights.push_back(fitter.weights_at(place));
    even_out(geometry::vertex_adjacency(count, shared), weights);

    const body::JointTransforms joints = fitter.transforms(u);
    turns.resize(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        Mat3f linear = Mat3f::Zero();
        Vec3f moved = Vec3f::Zero();
        for (std::size_t j = 0; j < body::kJointCount; ++j) {
            const float w = weights[vertex[v]][j];
            if (w == 0.0f) continue;
            linear += w * joints[j].rotation.toRotationMatrix();
            moved += w * joints[j].translation;
        }
        positions[v] = linear.inverse() * (places[vertex[v]] - moved);
        turns[v] = linear.transpose();
    }
}

} // namespace

std::string PoseMatch::text() const {
    std::array<char, 256> out{};
    std::snprintf(out.data(), out.size(),
                  "it was modelled in another pose (arms %+.0f degrees up, %+.0f forward, elbows "
                  "%+.0f, legs %+.0f apart): laid into this one, %.0f mm from the skin instead of "
                  "%.0f (inside counting three times)",
                  static_cast<double>(lift), static_cast<double>(forward),
                  static_cast<double>(elbow), static_cast<double>(legs), 1e3 * after_m,
                  1e3 * before_m);
    return out.data();
}

PoseMatch match_pose(const body::BodyModel& body, std::span<const Triangle> triangles,
                     std::span<Vec3f> positions) {
    PoseMatch out;
    Fitter fitter(body, positions);
    out.before_m = fitter.cost({});
    const Unknowns u = best_pose(fitter, told(body.skeleton, positions), out.after_m);
    const float turn = std::max({std::abs(u[0]), std::abs(u[1]), std::abs(u[2]), std::abs(u[3])});
    if (turn < kLeastTurn || out.after_m > kGain * out.before_m) return out;
    out.lift = u[0];
    out.forward = u[1];
    out.elbow = u[2];
    out.legs = u[3];
    out.shift = Fitter::shift(u);
    take_back(u, fitter, triangles, positions, out.turns);
    return out;
}

} // namespace toile::garment
