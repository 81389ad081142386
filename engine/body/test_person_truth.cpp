// Where a test person's girths are taken. Independent of `toile measure`: planes are searched on
// this person's own surface, with marks and joints of the source to say where or between what.
#include "body/test_person_maker.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace toile::body {
namespace {

constexpr float kStep = 0.004f;      // metres between the planes that are tried
constexpr float kOnMidline = 0.012f; // metres from x = 0 that still count as the midline
/// Vertices of the source mesh. Where a trunk stands out most is on many men the belly.
constexpr std::array<std::uint32_t, 2> kNipples{8454, 1782};
constexpr std::uint32_t kLowestRib = 10668, kIliacCrest = 10773, kGlutealFold = 10893;
constexpr float kBelowCrotch = 0.03f; // where the thigh is measured

class Finder {
  public:
    explicit Finder(TestPerson& person) : person_(person) {}

    void find() {
        find_heights();
        trunk();
        for (const bool left : {true, false})
            limbs(left);
        lengths();
    }

  private:
    [[nodiscard]] const Vec3f& joint(Joint j) const { return person_.skeleton.rest(j); }

    /// Curve of a plane whose middle is nearest to a point.
    [[nodiscard]] std::optional<GirthPlane> measure(const Vec3f& near, const Vec3f& normal) const {
        GirthPlane plane;
        plane.point = near;
        plane.normal = normal.normalized();
        const auto cut = geometry::Plane::through(near, normal);
        float best = std::numeric_limits<float>::infinity();
        for (const auto& loop :
             geometry::slice(person_.rest.positions, person_.rest.triangles, cut)) {
            const Vec3f middle = loop.centroid();
            const float d = (middle - near).norm();
            if (!loop.closed || loop.length() < 0.08 || !(d < best)) continue;
            best = d;
            plane.point = middle;
            plane.girth = geometry::hull_girth(loop.points, cut);
        }
        if (plane.girth == 0.0) return std::nullopt;
        return plane;
    }

    void keep(const std::string& name, Joint moves_with, std::optional<GirthPlane> plane) {
        if (!plane) throw Error("test person '" + person_.id + "': no place found for its " + name);
        plane->name = name;
        plane->joint = moves_with;
        person_.girths.push_back(*plane);
    }

    /// Of the planes through the points from `from` to `to` that are perpendicular to `normal`, the
    /// one with the largest (or least) girth.
    [[nodiscard]] std::optional<GirthPlane> extreme(const Vec3f& from, const Vec3f& to,
                                                    const Vec3f& normal, bool largest) const {
        const int steps = std::max(1, static_cast<int>((to - from).norm() / kStep));
        std::optional<GirthPlane> best;
        for (int i = 0; i <= steps; ++i) {
            const auto tried = measure(
                from + static_cast<float>(i) / static_cast<float>(steps) * (to - from), normal);
            if (tried && (!best || (tried->girth > best->girth) == largest)) best = tried;
        }
        return best;
    }

    /// ISO 8559-1 and ANSUR II: where the buttocks stand out most, above their folds.
    [[nodiscard]] float fullest_buttocks() const {
        const auto& positions = person_.rest.positions;
        const float low = positions[kGlutealFold].y(), high = positions[kIliacCrest].y();
        const float wide = std::abs(positions[kIliacCrest].x());
        const Vec3f* best = nullptr;
        for (const Vec3f& p : positions)
            if (p.y() > low && p.y() < high && std::abs(p.x()) < wide &&
                (best == nullptr || p.z() < best->z()))
                best = &p;
        return best != nullptr ? best->y() : 0.5f * (low + high);
    }

    void find_heights() {
        const auto& positions = person_.rest.positions;
        std::uint32_t top = 0;
        std::uint32_t crotch = UINT32_MAX;
        const float knee = joint(Joint::left_lower_leg).y();
        for (std::uint32_t v = 0; v < positions.size(); ++v) {
            if (positions[v].y() > positions[top].y()) top = v;
            const bool middle = std::abs(positions[v].x()) < kOnMidline && positions[v].y() > knee;
            if (middle && (crotch == UINT32_MAX || positions[v].y() < positions[crotch].y()))
                crotch = v;
        }
        if (crotch == UINT32_MAX)
            throw Error("test person '" + person_.id + "': its legs have no crotch between them");
        person_.landmarks["top_of_head"] = top;
        person_.landmarks["crotch"] = crotch;
        crotch_ = positions[crotch].y();
        person_.landmarks["bust_point"] = kNipples[0];
        bust_ = 0.5f * (positions[kNipples[0]].y() + positions[kNipples[1]].y());
    }

    void trunk() {
        const auto at = [&](float y) { // the spine's middle line, a little in front of the bones
            return Vec3f(0.0f, y, joint(Joint::spine).z() + 0.05f);
        };
        const Vec3f up = Vec3f::UnitY();
        keep("bust_girth", Joint::chest, measure(at(bust_), up));
        const auto& positions = person_.rest.positions;
        keep("waist_girth", Joint::spine,
             extreme(at(positions[kIliacCrest].y()), at(positions[kLowestRib].y()), up, false));
        keep("hip_girth", Joint::hips, measure(at(fullest_buttocks()), up));
        const Vec3f neck = joint(Joint::neck);
        const Vec3f head = joint(Joint::head);
        keep(
            "neck_girth", Joint::neck,
            extreme(neck + 0.35f * (head - neck), neck + 0.8f * (head - neck), head - neck, false));
    }

    void limbs(bool left) {
        const std::string side = left ? "left_" : "right_";
        const auto pick = [left](Joint l, Joint r) { return left ? l : r; };
        const Joint hip = pick(Joint::left_upper_leg, Joint::right_upper_leg);
        const Joint knee = pick(Joint::left_lower_leg, Joint::right_lower_leg);
        const Joint ankle = pick(Joint::left_foot, Joint::right_foot);
        const Joint shoulder = pick(Joint::left_upper_arm, Joint::right_upper_arm);
        const Joint elbow = pick(Joint::left_lower_arm, Joint::right_lower_arm);
        const Joint wrist = pick(Joint::left_hand, Joint::right_hand);
        const Vec3f up = Vec3f::UnitY();
        const auto between = [this](Joint a, Joint b, float share) {
            return Vec3f(joint(a) + share * (joint(b) - joint(a)));
        };
        const float thigh =
            (joint(hip).y() - (crotch_ - kBelowCrotch)) / (joint(hip).y() - joint(knee).y());
        keep(side + "thigh_girth", hip, measure(between(hip, knee, thigh), up));
        keep(side + "knee_girth", knee, measure(joint(knee), up));
        keep(side + "calf_girth", knee,
             extreme(between(knee, ankle, 0.15f), between(knee, ankle, 0.6f), up, true));
        keep(side + "ankle_girth", knee,
             extreme(between(knee, ankle, 0.7f), between(knee, ankle, 0.95f), up, false));
        const Vec3f arm = joint(elbow) - joint(shoulder);
        keep(side + "upper_arm_girth", shoulder, measure(between(shoulder, elbow, 0.5f), arm));
        const Vec3f fore = joint(wrist) - joint(elbow);
        keep(side + "wrist_girth", elbow,
             extreme(between(elbow, wrist, 0.85f), between(elbow, wrist, 1.0f), fore, false));
    }

    [[nodiscard]] std::uint32_t best_vertex(const std::function<float(const Vec3f&)>& score) const {
        const auto& positions = person_.rest.positions;
        const auto best =
            std::max_element(positions.begin(), positions.end(),
                             [&](const Vec3f& a, const Vec3f& b) { return score(a) < score(b); });
        return static_cast<std::uint32_t>(best - positions.begin());
    }

    void lengths() {
        const auto far = [](const Vec3f& p, const Vec3f& q) {
            return static_cast<double>((p - q).norm());
        };
        person_.lengths["stature"] =
            static_cast<double>(person_.rest.positions[person_.landmarks["top_of_head"]].y());
        person_.lengths["crotch_height"] = static_cast<double>(crotch_);
        const Vec3f neck = joint(Joint::neck);
        person_.landmarks["cervicale"] = best_vertex([&](const Vec3f& p) {
            return std::abs(p.x()) < kOnMidline && std::abs(p.y() - neck.y()) < 0.01f ? -p.z()
                                                                                      : -1e3f;
        });
        for (const bool left : {true, false}) {
            const std::string side = left ? "left_" : "right_";
            const Vec3f& shoulder = joint(left ? Joint::left_upper_arm : Joint::right_upper_arm);
            const Vec3f& elbow = joint(left ? Joint::left_lower_arm : Joint::right_lower_arm);
            const Vec3f& wrist = joint(left ? Joint::left_hand : Joint::right_hand);
            person_.landmarks[side + "acromion"] = best_vertex([&](const Vec3f& p) {
                const bool above = std::hypot(p.x() - shoulder.x(), p.z() - shoulder.z()) < 0.025f;
                return above ? p.y() : -1e3f;
            });
            const Vec3f& acromion = person_.rest.positions[person_.landmarks[side + "acromion"]];
            person_.lengths[side + "arm_length"] = far(acromion, elbow) + far(elbow, wrist);
        }
        person_.volume_m3 = geometry::volume(person_.rest);
        const double stature = person_.lengths["stature"];
        person_.bmi = kBodyDensity * person_.volume_m3 / (stature * stature);
    }

    TestPerson& person_;
    float crotch_ = 0.0f;
    float bust_ = 0.0f;
};

} // namespace

void find_test_person_truth(TestPerson& person) {
    Finder(person).find();
}

} // namespace toile::body
