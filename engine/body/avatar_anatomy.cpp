#include "body/avatar_anatomy.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

namespace toile::body {
namespace {

constexpr std::array<Part, 2> kTrunk = {Part::torso, Part::pelvis};

/// Heights of landmarks as shares of the stature, where no feature of the surface tells them
/// (medians of standing adults; the suprasternal notch, C7 and the navel).
constexpr float kNotchHeight = 0.818f;
constexpr float kCervicalHeight = 0.858f;
constexpr float kNavelHeight = 0.600f;

/// The perimeter of the convex hull of points in a plane: what a tape measures.
double hull_perimeter(std::vector<Eigen::Vector2d> points) {
    if (points.size() < 3) return 0.0;
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    });
    std::vector<Eigen::Vector2d> hull;
    const auto turn = [](const auto& o, const auto& a, const auto& b) {
        return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
    };
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t base = hull.size();
        for (const auto& p : points) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < hull.size(); ++i)
        sum += (hull[(i + 1) % hull.size()] - hull[i]).norm();
    return sum;
}

/// Cuts one body: girths in planes, of chosen parts only.
class Tape {
  public:
    Tape(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
         std::span<const Part> parts)
        : positions_(positions), triangles_(triangles), parts_(parts) {}

    /// Of the triangles whose corners all belong to `wanted`, through `point` across `axis`.
    [[nodiscard]] double girth(std::span<const Part> wanted, const Vec3f& point,
                               const Vec3f& axis) const {
        const Vec3f u = axis.unitOrthogonal(), w = axis.normalized().cross(u);
        std::vector<Eigen::Vector2d> cut;
        for (const auto& t : triangles_) {
            const auto of = [&](std::uint32_t v) {
                return std::find(wanted.begin(), wanted.end(), parts_[v]) != wanted.end();
            };
            if (!of(t[0]) || !of(t[1]) || !of(t[2])) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3f p = positions_[t[k]] - point, q = positions_[t[(k + 1) % 3]] - point;
                const float a = p.dot(axis), b = q.dot(axis);
                if ((a < 0.0f) == (b < 0.0f)) continue;
                const Vec3f c = p + (a / (a - b)) * (q - p);
                cut.emplace_back(c.dot(u), c.dot(w));
            }
        }
        return hull_perimeter(std::move(cut));
    }
    [[nodiscard]] double level(std::span<const Part> wanted, float y) const {
        return girth(wanted, Vec3f(0.0f, y, 0.0f), Vec3f::UnitY());
    }

  private:
    std::span<const Vec3f> positions_;
    std::span<const Triangle> triangles_;
    std::span<const Part> parts_;
};

/// Height in [low, high] with the least or the greatest value, by 5 mm steps.
float best_height(float low, float high, bool greatest, const std::function<double(float)>& f) {
    float best = low;
    double value = greatest ? -1.0 : std::numeric_limits<double>::max();
    for (float y = low; y <= high; y += 0.005f) {
        const double v = f(y);
        if (greatest ? v > value : v < value) {
            value = v;
            best = y;
        }
    }
    return best;
}

float top(std::span<const Vec3f> positions) {
    float y = 0.0f;
    for (const auto& p : positions)
        y = std::max(y, p.y());
    return y;
}

} // namespace

std::map<std::string, std::uint32_t> find_landmarks(const AvatarTemplate& avatar,
                                                    std::span<const Vec3f> positions,
                                                    const Skeleton& skeleton,
                                                    std::span<const Part> parts) {
    const float stature = top(positions);
    /// The vertex of the left half (or of its midline) with the least cost.
    const auto best = [&](bool midline, const std::function<float(std::uint32_t)>& cost) {
        std::uint32_t found = 0;
        float least = std::numeric_limits<float>::max();
        for (std::uint32_t v = 0; v < avatar.half; ++v) {
            if (midline && avatar.mirror_of[v] != v) continue;
            const float c = cost(v);
            if (c < least) {
                least = c;
                found = v;
            }
        }
        return found;
    };
    constexpr float kNever = 1e6f;
    const auto at = [&](std::uint32_t v) { return positions[v]; };
    const float spine_z = skeleton.rest(Joint::neck).z();
    const auto midline_at = [&](float height, bool front) {
        return best(true, [&, height, front](std::uint32_t v) {
            return (at(v).z() > spine_z) == front ? std::abs(at(v).y() - height) : kNever;
        });
    };
    std::map<std::string, std::uint32_t> out;
    out["crown"] = best(true, [&](std::uint32_t v) { return -at(v).y(); });
    out["neck_back"] = midline_at(kCervicalHeight * stature, false);
    out["neck_front"] = midline_at(kNotchHeight * stature, true);
    out["navel"] = midline_at(kNavelHeight * stature, true);
    out["crotch"] = best(
        true, [&](std::uint32_t v) { return at(v).y() > 0.3f * stature ? at(v).y() : kNever; });

    const Tape tape(positions, avatar.mesh.triangles, parts);
    const float waist = best_height(0.585f * stature, 0.66f * stature, false,
                                    [&](float y) { return tape.level(kTrunk, y); });
    out["waist_back"] = midline_at(waist, false);

    const auto nearest = [&](const Vec3f& p) {
        return best(false, [&, p](std::uint32_t v) { return (at(v) - p).squaredNorm(); });
    };
    const Vec3f arm = skeleton.rest(Joint::left_upper_arm);
    std::map<std::string, std::uint32_t> left;
    left["shoulder"] = best(false, [&](std::uint32_t v) {
        const Vec3f d = at(v) - arm - Vec3f(0.01f, 0.0f, 0.0f);
        return std::hypot(d.x(), d.z()) < 0.02f && d.y() > 0.0f ? -d.y() : kNever;
    });
    left["bust_point"] = best(false, [&](std::uint32_t v) {
        const float h = at(v).y() / stature;
        const bool chest = parts[v] == Part::torso && at(v).x() > 0.05f && at(v).x() < 0.14f;
        return chest && h > 0.69f && h < 0.76f ? -at(v).z() : kNever;
    });
    const Vec3f elbow = skeleton.rest(Joint::left_lower_arm);
    left["elbow"] = nearest(elbow + Vec3f(0.02f, -0.02f, -0.05f));
    left["wrist"] = nearest(skeleton.rest(Joint::left_hand) + Vec3f(0.03f, 0.02f, -0.01f));
    left["knee"] = nearest(skeleton.rest(Joint::left_lower_leg) + Vec3f(0.0f, 0.0f, 0.08f));
    left["ankle"] = nearest(skeleton.rest(Joint::left_foot) + Vec3f(0.06f, 0.0f, 0.0f));
    left["heel"] =
        best(false, [&](std::uint32_t v) { return at(v).y() < 0.06f ? at(v).z() : kNever; });
    left["toe_tip"] =
        best(false, [&](std::uint32_t v) { return at(v).y() < 0.06f ? -at(v).z() : kNever; });
    const Vec3f hand = skeleton.rest(Joint::left_hand);
    const Vec3f along = (hand - elbow).normalized();
    left["fingertip"] = best(false, [&](std::uint32_t v) { return -(at(v) - hand).dot(along); });
    for (const auto& [name, v] : left) {
        out["left_" + name] = v;
        out["right_" + name] = avatar.mirror_of[v];
    }
    return out;
}

std::map<std::string, double>
measure_avatar(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
               const Skeleton& skeleton, std::span<const Part> parts,
               const std::map<std::string, std::uint32_t>& landmarks) {
    const Tape tape(positions, triangles, parts);
    const auto at = [&](const char* name) { return positions[landmarks.at(name)]; };
    const float stature = top(positions);
    const auto joint = [&](Joint j) { return skeleton.rest(j); };
    const float waist = at("waist_back").y(), crotch = at("crotch").y();

    const std::array<Part, 4> seat = {Part::torso, Part::pelvis, Part::left_upper_leg,
                                      Part::right_upper_leg};
    const float hip = best_height(crotch + 0.01f, waist - 0.08f, true,
                                  [&](float y) { return tape.level(seat, y); });
    std::map<std::string, double> out;
    out["stature"] = stature;
    out["bust_girth"] = tape.level(kTrunk, at("left_bust_point").y());
    out["waist_girth"] = tape.level(kTrunk, waist);
    out["hip_girth"] = tape.level(seat, hip);
    out["waist_height"] = waist;
    out["hip_height"] = hip;
    out["inside_leg_length"] = crotch;
    out["cervical_height"] = at("neck_back").y();

    const std::array<Part, 3> neck = {Part::neck, Part::head, Part::torso};
    const Vec3f neck_axis = joint(Joint::head) - joint(Joint::neck);
    double neck_girth = std::numeric_limits<double>::max();
    for (float t = 0.2f; t < 0.9f; t += 0.1f)
        neck_girth =
            std::min(neck_girth, tape.girth(neck, joint(Joint::neck) + t * neck_axis, neck_axis));
    out["neck_girth"] = neck_girth;

    /// Largest or smallest girth across a bone between two shares of its length.
    const auto limb = [&](std::span<const Part> of, Joint from, Joint to, float low, float high,
                          bool greatest) {
        const Vec3f axis = joint(to) - joint(from);
        const float t = best_height(low, high, greatest, [&](float s) {
            return tape.girth(of, joint(from) + s * axis, axis);
        });
        return tape.girth(of, joint(from) + t * axis, axis);
    };
    const std::array<Part, 3> arm = {Part::left_upper_arm, Part::left_lower_arm, Part::torso};
    const std::array<Part, 2> leg = {Part::left_upper_leg, Part::left_lower_leg};
    out["upper_arm_girth"] =
        limb(arm, Joint::left_upper_arm, Joint::left_lower_arm, 0.45f, 0.7f, true);
    out["wrist_girth"] = limb(arm, Joint::left_lower_arm, Joint::left_hand, 0.85f, 1.0f, false);
    out["thigh_girth"] = tape.level(leg, crotch - 0.03f);
    out["knee_girth"] = tape.level(leg, joint(Joint::left_lower_leg).y());
    out["calf_girth"] = limb(leg, Joint::left_lower_leg, Joint::left_foot, 0.15f, 0.55f, true);
    out["ankle_girth"] = limb(leg, Joint::left_lower_leg, Joint::left_foot, 0.75f, 1.0f, false);
    const Vec3f shoulder = at("left_shoulder"), neck_back = at("neck_back");
    out["shoulder_width"] = 2.0 * (shoulder - neck_back).norm();
    out["arm_length"] = (joint(Joint::left_lower_arm) - joint(Joint::left_upper_arm)).norm() +
                        (joint(Joint::left_hand) - joint(Joint::left_lower_arm)).norm();
    out["back_waist_length"] = (neck_back - at("waist_back")).norm();
    return out;
}

} // namespace toile::body
