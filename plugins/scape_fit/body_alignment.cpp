#include "scape_fit/body_alignment.h"

#include "body/rotations.h"
#include "scape_fit/association_types.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace toile::scape_fit {
namespace {

constexpr int kJointRounds = 8;
constexpr double kJointScale = 0.1; // metres, of the robust weight of joints
constexpr int kSides = 24;          // from which a body may be seen
constexpr std::size_t kFewer = 4;   // every n-th point for the quick look
constexpr int kQuickRounds = 6;
constexpr int kGoodRounds = 16;
constexpr std::size_t kGoodLook = 5; // of the quickly looked at
constexpr double kAlike = 0.35;      // radians
constexpr float kFar = 0.10f;        // metres
constexpr float kSpacing = 0.03f;    // metres between neighbours of a body's points
constexpr float kBehind = 0.08f;     // metres from what is seen to the body's middle
constexpr std::array<float, 2> kScale{0.15f, 0.03f};

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// How a point meets the surface: along the nearest normal, or not at all.
struct Meeting {
    Vec3f normal = Vec3f::Zero();
    float along = 0.0f;    ///< the normal, from the surface to the point
    float distance = kFar; ///< at most kFar
    bool met = false;
};

Meeting meet(const StandingBody& body, const Vec3f& point, const Vec3f& eye) {
    Meeting out;
    const auto near = body.tree.nearest(point);
    const Vec3f& at = body.tree.points()[near.index];
    out.normal = body.normals[near.index];
    if (out.normal.dot(eye - at) <= 0.0f) return out;
    const float length = std::sqrt(near.squared);
    out.along = out.normal.dot(point - at);
    out.distance = std::min(kFar, length < kSpacing ? std::abs(out.along) : length);
    out.met = true;
    return out;
}

/// One Gauss-Newton step of the points along the normals that they meet.
void step(std::span<const StandingBody> bodies, std::span<const SeenPoints> seen, float scale,
          Freedom freedom, Eigen::Isometry3d& place) {
    Matrix6d normal = 1e-9 * Matrix6d::Identity();
    Vector6d gradient = Vector6d::Zero();
    const Eigen::Isometry3f now = place.cast<float>();
    const Vec3f middle = bodies[0].middle;
    for (const SeenPoints& one : seen) {
        const Vec3f eye = now * one.eye;
        for (const Vec3f& p : one.points) {
            const Vec3f x = now * p;
            const Meeting meeting = meet(bodies[one.instant], x, eye);
            if (!meeting.met) continue;
            const Vec3f n = meeting.normal;
            Vector6d row;
            row << (x - middle).cross(n).cast<double>(), n.cast<double>();
            const auto weight = static_cast<double>(geman_mcclure(meeting.distance, scale));
            normal += weight * row * row.transpose();
            gradient += weight * static_cast<double>(meeting.along) * row;
        }
    }
    if (freedom == Freedom::level)
        for (const int locked : {0, 2, 4})
            normal(locked, locked) += 1e12;
    const Vector6d move = -normal.ldlt().solve(gradient);
    const double angle = std::min(0.3, move.head<3>().norm());
    const Vec3d axis = angle > 1e-12 ? Vec3d(move.head<3>().normalized()) : Vec3d::UnitY();
    const Vec3d about = middle.cast<double>();
    place = Eigen::Translation3d(about + move.tail<3>()) * Eigen::AngleAxisd(angle, axis) *
            Eigen::Translation3d(-about) * place;
}

void approach(std::span<const StandingBody> bodies, std::span<const SeenPoints> seen, int rounds,
              Freedom freedom, Alignment& out) {
    for (int round = 0; round < rounds; ++round) {
        const float at = static_cast<float>(round) / static_cast<float>(rounds - 1);
        step(bodies, seen, kScale[0] * std::pow(kScale[1] / kScale[0], at), freedom, out.place);
    }
    out.distance_m = distance(bodies, seen, out.place);
}

/// Seen from one side, the points before the body's middle.
Eigen::Isometry3d seen_from(std::span<const StandingBody> bodies, std::span<const SeenPoints> seen,
                            float yaw, Freedom freedom) {
    const Mat3f turn = body::about(Vec3f::UnitY(), yaw).toRotationMatrix();
    Vec3f shift = Vec3f::Zero();
    for (const SeenPoints& one : seen) {
        Vec3f low = one.points[0], high = low;
        for (const Vec3f& p : one.points)
            low = low.cwiseMin(p), high = high.cwiseMax(p);
        Vec3f middle = 0.5f * (low + high), away = middle - one.eye;
        away.y() = 0.0f;
        middle += kBehind * away.normalized();
        shift += (bodies[one.instant].middle - turn * middle) / static_cast<float>(seen.size());
    }
    if (freedom == Freedom::level) shift.y() = 0.0f;
    Eigen::Isometry3f out = Eigen::Isometry3f::Identity();
    out.linear() = turn;
    out.translation() = shift;
    return out.cast<double>();
}

/// The first of those that are turned alike.
std::vector<Alignment> unlike(std::span<const Alignment> all, std::size_t most) {
    std::vector<Alignment> out;
    for (const Alignment& one : all) {
        const bool known = std::any_of(out.begin(), out.end(), [&](const Alignment& other) {
            return Eigen::AngleAxisd(other.place.linear().transpose() * one.place.linear())
                       .angle() < kAlike;
        });
        if (!known && out.size() < most) out.push_back(one);
    }
    return out;
}

Eigen::Matrix3d best_turn(const Eigen::Matrix3d& covariance, Freedom freedom) {
    if (freedom == Freedom::level)
        return Eigen::AngleAxisd(std::atan2(covariance(0, 2) - covariance(2, 0),
                                            covariance(0, 0) + covariance(2, 2)),
                                 Vec3d::UnitY())
            .toRotationMatrix();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3d signs = Vec3d::Ones();
    signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

} // namespace

Eigen::Isometry3d aligned(std::span<const Vec3f> from, std::span<const Vec3f> to,
                          std::span<const double> weights, Freedom freedom) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    std::vector<double> robust(weights.begin(), weights.end());
    for (int round = 0; round < kJointRounds; ++round) {
        Vec3d a = Vec3d::Zero(), b = Vec3d::Zero();
        double sum = 0.0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            a += robust[i] * from[i].cast<double>();
            b += robust[i] * to[i].cast<double>();
            sum += robust[i];
        }
        a /= sum, b /= sum;
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(); // of to with from
        for (std::size_t i = 0; i < from.size(); ++i)
            covariance +=
                robust[i] * (to[i].cast<double>() - b) * (from[i].cast<double>() - a).transpose();
        out.linear() = best_turn(covariance, freedom);
        out.translation() = b - out.linear() * a;
        if (freedom == Freedom::level) out.translation().y() = 0.0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            const double off = (out * from[i].cast<double>() - to[i].cast<double>()).norm();
            const double root = 1.0 / (1.0 + off * off / (kJointScale * kJointScale));
            robust[i] = weights[i] * root * root;
        }
    }
    return out;
}

StandingBody::StandingBody(const PosedLevel& posed)
    : tree(posed.positions), normals(posed.normals) {
    Vec3f low = posed.positions[0], high = low;
    for (const Vec3f& p : posed.positions)
        low = low.cwiseMin(p), high = high.cwiseMax(p);
    middle = 0.5f * (low + high);
    for (std::size_t j = 0; j < joints.size(); ++j)
        joints[j] = posed.world[j].translation;
}

SeenPoints some_of(const Observation& from, std::size_t count) {
    SeenPoints out;
    out.instant = from.instant;
    if (from.eye) out.eye = *from.eye;
    const std::size_t step = (from.points.size() + count - 1) / count;
    for (std::size_t i = 0; i < from.points.size(); i += step)
        out.points.push_back(from.points[i]);
    return out;
}

double distance(std::span<const StandingBody> bodies, std::span<const SeenPoints> seen,
                const Eigen::Isometry3d& place) {
    const Eigen::Isometry3f now = place.cast<float>();
    double sum = 0.0;
    std::size_t count = 0;
    for (const SeenPoints& one : seen) {
        const Vec3f eye = now * one.eye;
        for (const Vec3f& p : one.points)
            sum += static_cast<double>(meet(bodies[one.instant], now * p, eye).distance);
        count += one.points.size();
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, count));
}

std::vector<Alignment> find_places(std::span<const StandingBody> bodies,
                                   std::span<const SeenPoints> seen,
                                   std::span<const Eigen::Isometry3d> starts, Freedom freedom,
                                   const RowLoop& rows) {
    std::vector<SeenPoints> few(seen.begin(), seen.end());
    for (SeenPoints& one : few) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < one.points.size(); i += kFewer)
            one.points[kept++] = one.points[i];
        one.points.resize(kept);
    }
    std::vector<Alignment> tried;
    for (const Eigen::Isometry3d& start : starts)
        tried.push_back({start});
    for (int side = 0; side < kSides; ++side) {
        const float yaw = 2.0f * body::kPi * static_cast<float>(side) / kSides;
        tried.push_back({seen_from(bodies, seen, yaw, freedom)});
    }
    const auto approach_all = [&](std::span<const SeenPoints> points, int rounds) {
        rows(static_cast<std::uint32_t>(tried.size()), 1,
             [&](std::uint32_t begin, std::uint32_t end) {
                 for (std::uint32_t i = begin; i < end; ++i)
                     approach(bodies, points, rounds, freedom, tried[i]);
             });
        std::stable_sort(tried.begin(), tried.end(), [](const Alignment& a, const Alignment& b) {
            return a.distance_m < b.distance_m;
        });
    };
    approach_all(few, kQuickRounds);
    tried = unlike(tried, kGoodLook);
    approach_all(seen, kGoodRounds);
    return unlike(tried, kGoodLook);
}

} // namespace toile::scape_fit
