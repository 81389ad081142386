#include "garment/body_wrap.h"

#include "body/measurer.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {

using body::Joint;
constexpr double kRow = TubeRings::kStep;
constexpr int kSamples = TubeRings::kSamples;

double measured(const std::map<std::string, double>& values, const std::string& name,
                const body::BodyModel& body) {
    const auto at = values.find(name);
    if (at == values.end() || !(at->second > 0.0)) {
        throw Error("body '" + body.id + "': " + name +
                    " cannot be measured; a pattern is laid by it");
    }
    return at->second;
}

// Closed hull around a leg's section, widened by `ease`, as kSamples + 1 points by angle.
std::vector<Vec2d> section(const BodyProbe& body, const double height, Vec2d& middle) {
    const Vec3d knee = body.joint(Joint::left_lower_leg);
    const Vec3d hip = body.joint(Joint::left_upper_leg);
    const Vec3d foot = body.joint(Joint::left_foot);
    const Vec3d& from = height > knee.y() ? hip : knee;
    const Vec3d& to = height > knee.y() ? knee : foot;
    const double t = std::clamp((from.y() - height) / (from.y() - to.y()), 0.0, 1.0);
    const Vec3d bone = from + t * (to - from);
    double nearest = 1e9;
    std::vector<Vec2d> points;
    for (const auto& loop : body.slice(Vec3d::UnitY(), height)) {
        Vec2d sum = Vec2d::Zero();
        std::vector<Vec2d> flat;
        for (const Vec3d& p : loop) {
            flat.emplace_back(p.x(), p.z());
            sum += flat.back();
        }
        const Vec2d centre = sum / static_cast<double>(flat.size());
        const double distance = (centre - Vec2d(bone.x(), bone.z())).norm();
        if (distance < nearest && centre.x() > 0.01) {
            nearest = distance;
            points = std::move(flat);
            middle = centre;
        }
    }
    return points;
}

} // namespace

std::map<std::string, double> body_levels(const BodyProbe& body) {
    const body::Measurer measurer(body.body());
    const auto values =
        body::as_map(measurer.measure(body.body().rest.positions, body.body().skeleton));
    const auto& model = body.body();
    std::map<std::string, double> levels;
    levels["underarm"] = body.armpit_height() - 0.02;
    levels["bust"] = measured(values, "bust_height", model);
    levels["waist"] = measured(values, "waist_height", model);
    levels["hip"] = measured(values, "hip_height", model);
    levels["high_hip"] = 0.5 * (levels["waist"] + levels["hip"]);
    levels["crotch"] = measured(values, "crotch_height", model);
    levels["knee"] = measured(values, "knee_height", model);
    levels["ankle"] = measured(values, "ankle_height", model);
    return levels;
}

LegLoft::LegLoft(const BodyProbe& body, const double low_m, const double high_m,
                 const std::function<double(double)>& girth_m, const double ease_m) {
    rings_.low_m = low_m;
    const int rows = std::max(1, static_cast<int>(std::ceil((high_m - low_m) / kRow))) + 1;
    for (int r = 0; r < rows; ++r) {
        const double height = std::min(low_m + r * kRow, high_m);
        Vec2d middle = Vec2d::Zero();
        const std::vector<Vec2d> hull = convex_hull(section(body, height, middle));
        if (hull.size() < 3) {
            throw Error("body '" + body.body().id + "' has no left leg at height " +
                        std::to_string(height) + " m, where a pattern puts cloth");
        }
        double girth = 0.0;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            girth += (hull[(i + 1) % hull.size()] - hull[i]).norm();
        }
        const double ease = std::max(ease_m, (girth_m(height) - girth) / (2.0 * std::numbers::pi));
        auto& row = rings_.rows.emplace_back();
        for (int k = 0; k <= kSamples; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kSamples;
            const Vec2d ray(-std::cos(angle), std::sin(angle)); // inner side, front, outside
            double reach = 0.0;
            for (const Vec2d& p : hull) {
                reach = std::max(reach, (p - middle).dot(ray));
            }
            const Vec2d p = middle + (reach + ease) * ray;
            row[static_cast<std::size_t>(k)] = Vec3d(std::max(p.x(), 0.002), height, p.y());
        }
    }
}

Vec3d LegLoft::at(const double fraction, const double height_m) const {
    return rings_.at(fraction, height_m);
}

ArmTube::ArmTube(const BodyProbe& body, const double ease_m) {
    const Vec3d shoulder = body.joint(Joint::left_upper_arm);
    const Vec3d elbow = body.joint(Joint::left_lower_arm);
    const Vec3d wrist = body.joint(Joint::left_hand);
    const Vec3d tip = body.ridge(shoulder.x() + 0.012);
    Vec3d middle;
    const double girth = body.arm_girth(0.45, middle);
    const std::array<Vec3d, 3> joints = {shoulder, elbow, wrist};
    for (std::size_t b = 0; b < 2; ++b) {
        Bone& bone = bones_[b];
        bone.axis = (joints[b + 1] - joints[b]).normalized();
        bone.up = (Vec3d::UnitY() - bone.axis * bone.axis.y()).normalized();
        const Vec3d z = Vec3d::UnitZ();
        bone.front = (z - bone.axis * bone.axis.dot(z) - bone.up * bone.up.dot(z)).normalized();
        bone.least_radius = (b == 0 ? 1.0 : 0.9) * girth / (2.0 * std::numbers::pi) + ease_m;
    }
    // Distances along the arm count from the level of the shoulder's tip.
    Bone& upper = bones_[0];
    const double first = upper.axis.dot(tip - shoulder);
    upper.from = -first;
    upper.start = middle - upper.axis * upper.axis.dot(middle - shoulder);
    Bone& lower = bones_[1];
    lower.from = upper.from + (elbow - shoulder).norm();
    lower.start = 0.5 * (elbow + upper.start + upper.axis * (elbow - shoulder).norm());
    length_ = lower.from + (wrist - elbow).norm();
}

Vec3d ArmTube::at(const double along_m, const double angle, const double girth_m) const {
    const auto on = [&](const Bone& bone) {
        const double radius = std::max(bone.least_radius, girth_m / (2.0 * std::numbers::pi));
        return Vec3d(bone.start + bone.axis * (along_m - bone.from) +
                     radius * (std::cos(angle) * bone.up + std::sin(angle) * bone.front));
    };
    const double blend = std::clamp((along_m - bones_[1].from + 0.04) / 0.08, 0.0, 1.0);
    return (1.0 - blend) * on(bones_[0]) + blend * on(bones_[1]);
}

} // namespace toile::garment::block
