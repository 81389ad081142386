#include "body/measurement_rules.h"

#include <algorithm>
#include <cmath>

namespace toile::body::rules {
namespace {

using enum Landmark;
using geometry::GirthCutter;

constexpr int kSteps = 16; // over the zone in which a largest or smallest girth is looked for

/// The girth at one level of a part.
Reading girth_at(Survey& s, const GirthCutter& cutter, float offset) {
    Reading out;
    geometry::Loop tape = cutter.tape(offset);
    out.value_m = tape.length();
    out.confidence = s.trust();
    out.cut = geometry::Plane{cutter.normal(), offset};
    out.tapes.push_back(std::move(tape));
    return out;
}

/// Across `axis` through a point.
Reading girth_through(Survey& s, Region region, const Vec3f& point, const Vec3f& axis) {
    const GirthCutter cutter(s.figure().positions, s.region(region), axis.normalized());
    return girth_at(s, cutter, cutter.offset(point));
}

enum class Wanted { largest, smallest };

/// The largest or smallest girth between two levels.
Reading extreme_girth(Survey& s, const GirthCutter& cutter, float from, float to, Wanted wanted) {
    int best = 0;
    double value = 0.0;
    for (int k = 0; k <= kSteps; ++k) {
        const float offset = from + (to - from) * static_cast<float>(k) / kSteps;
        const double girth = cutter.girth(offset);
        if (k != 0 && (wanted == Wanted::largest ? girth <= value : girth >= value)) continue;
        value = girth;
        best = k;
    }
    return girth_at(s, cutter, from + (to - from) * static_cast<float>(best) / kSteps);
}

float middle_level(Survey& s, const GirthCutter& cutter, Landmark left, Landmark right) {
    return cutter.offset(s.middle_of(left, right));
}

Vec3f direction(const Vec3f& from, const Vec3f& to) {
    return (to - from).normalized();
}

/// A closed tape through points of the surface, from each to the next on its side.
struct Leg {
    Vec3f to, side;
    geometry::Way way = geometry::Way::far_side;
};
Reading laid_through(Survey& s, const Vec3f& start, const std::vector<Leg>& legs) {
    Reading out;
    Vec3f from = start;
    for (const Leg& leg : legs) {
        out.tapes.push_back(geometry::taut_path(s.figure().positions, s.figure().triangles, from,
                                                leg.to, leg.side, leg.way));
        out.value_m += out.tapes.back().length();
        from = leg.to;
    }
    out.confidence = s.trust();
    return out;
}

/// The point in the middle of a tape's length.
Vec3f half_way(const geometry::Loop& tape) {
    double left = 0.5 * tape.length();
    for (std::size_t i = 0; i + 1 < tape.points.size(); ++i) {
        const Vec3f step = tape.points[i + 1] - tape.points[i];
        const auto length = static_cast<double>(step.norm());
        if (length >= left && length > 0.0)
            return tape.points[i] + static_cast<float>(left / length) * step;
        left -= length;
    }
    return tape.points.back();
}

GirthCutter across(Survey& s, Region region, const Vec3f& axis) {
    return {s.figure().positions, s.region(region), axis.normalized()};
}

} // namespace

Reading head_girth(Survey& s) {
    const Vec3f brow = s.at(Landmark::brow), back = s.at(head_back);
    return girth_through(s, Region::head, brow, (brow - back).cross(s.figure().chest.left));
}

Reading neck_girth(Survey& s) {
    return girth_through(s, Region::head, s.at(larynx), s.figure().neck_up);
}

Reading neck_base_girth(Survey& s) {
    const Vec3f left = s.figure().chest.left, ahead = s.figure().chest.forward;
    const Vec3f back = s.at(neck_back), front = s.at(neck_front);
    return laid_through(s, back,
                        {{s.at(left_neck_side), left - ahead},
                         {front, left + ahead},
                         {s.at(right_neck_side), ahead - left},
                         {back, -left - ahead}});
}

Reading upper_chest_girth(Survey& s) {
    const GirthCutter& chest = s.chest();
    return girth_at(s, chest, middle_level(s, chest, left_armpit, right_armpit));
}

Reading chest_girth(Survey& s) {
    const GirthCutter& chest = s.chest();
    return extreme_girth(s, chest, middle_level(s, chest, left_under_bust, right_under_bust),
                         middle_level(s, chest, left_armpit, right_armpit), Wanted::largest);
}

Reading bust_girth(Survey& s) {
    const GirthCutter& chest = s.chest();
    return girth_at(s, chest, middle_level(s, chest, left_bust_point, right_bust_point));
}

Reading under_bust_girth(Survey& s) {
    const GirthCutter& chest = s.chest();
    return girth_at(s, chest, middle_level(s, chest, left_under_bust, right_under_bust));
}

Reading waist_girth(Survey& s) {
    return girth_at(s, s.waist(), s.waist_level());
}

Reading navel_girth(Survey& s) {
    return girth_at(s, s.waist(), s.waist().offset(s.at(navel)));
}

Reading high_hip_girth(Survey& s) {
    const GirthCutter& hips = s.hips();
    return girth_at(s, hips, middle_level(s, hips, left_iliac_spine, right_iliac_spine));
}

Reading hip_girth(Survey& s) {
    return girth_at(s, s.hips(), s.hip_level());
}

Reading armscye_girth(Survey& s) {
    const Vec3f ahead = s.figure().chest.forward, up = s.figure().chest.up;
    const Vec3f shoulder = s.at(right_shoulder);
    constexpr auto kShorter = geometry::Way::shorter; // each leg is a part of the hole
    return laid_through(s, shoulder,
                        {{s.at(right_scye_front), ahead, kShorter},
                         {s.at(right_armpit), ahead - up, kShorter},
                         {s.at(right_scye_back), -ahead - up, kShorter},
                         {shoulder, -ahead, kShorter}});
}

Reading upper_arm_girth(Survey& s) {
    const Limb& arm = s.figure().right_arm;
    return girth_through(s, Region::right_arm, s.middle_of(right_armpit, right_elbow),
                         arm.middle - arm.root);
}

Reading elbow_girth(Survey& s) {
    const Limb& arm = s.figure().right_arm;
    const Vec3f axis = direction(arm.root, arm.middle) + direction(arm.middle, arm.end);
    return girth_through(s, Region::right_arm, s.at(right_elbow), axis);
}

Reading forearm_girth(Survey& s) {
    const Limb& arm = s.figure().right_arm;
    const GirthCutter cutter = across(s, Region::right_arm, arm.end - arm.middle);
    const float elbow = cutter.offset(s.at(right_elbow)), wrist = cutter.offset(s.at(right_wrist));
    return extreme_girth(s, cutter, elbow + 0.2f * (wrist - elbow), wrist, Wanted::largest);
}

Reading wrist_girth(Survey& s) {
    const Limb& arm = s.figure().right_arm;
    return girth_through(s, Region::right_arm, s.at(right_wrist), arm.end - arm.middle);
}

Reading thigh_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    return girth_through(s, Region::right_leg, s.at(right_gluteal_fold), leg.middle - leg.root);
}

Reading mid_thigh_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    return girth_through(s, Region::right_leg, s.middle_of(right_trochanter, right_knee),
                         leg.middle - leg.root);
}

Reading knee_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    const Vec3f axis = direction(leg.root, leg.middle) + direction(leg.middle, leg.end);
    return girth_through(s, Region::right_leg, s.at(right_knee), axis);
}

Reading lower_knee_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    return girth_through(s, Region::right_leg, s.at(right_lower_knee), leg.end - leg.middle);
}

Reading calf_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    const GirthCutter cutter = across(s, Region::right_leg, leg.end - leg.middle);
    return extreme_girth(s, cutter, cutter.offset(s.at(right_lower_knee)),
                         cutter.offset(0.5f * (leg.middle + leg.end)), Wanted::largest);
}

Reading minimum_leg_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    const GirthCutter cutter = across(s, Region::right_leg, leg.end - leg.middle);
    return extreme_girth(s, cutter, cutter.offset(0.5f * (leg.middle + leg.end)),
                         cutter.offset(s.at(right_ankle)), Wanted::smallest);
}

Reading ankle_girth(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    return girth_through(s, Region::right_leg, s.middle_of(right_ankle, right_inner_ankle),
                         leg.end - leg.middle);
}

Reading trunk_circumference(Survey& s) {
    const Vec3f ahead = s.figure().chest.forward, up = s.figure().chest.up;
    const Vec3f top =
        half_way(geometry::taut_path(s.figure().positions, s.figure().triangles,
                                     s.at(right_neck_side), s.at(right_shoulder), up));
    const Vec3f between = s.at(crotch);
    s.rest_on(0.9);
    return laid_through(s, top, {{s.at(right_bust_point), ahead}, {between, ahead}, {top, -ahead}});
}

Reading biceps_flexed_girth(Survey& s) {
    constexpr double kArmIsNotFlexed = 0.3;
    s.rest_on(kArmIsNotFlexed);
    const Limb& arm = s.figure().right_arm;
    const GirthCutter cutter = across(s, Region::right_arm, arm.middle - arm.root);
    const float top = cutter.offset(s.at(right_armpit)), tip = cutter.offset(s.at(right_elbow));
    return extreme_girth(s, cutter, top + (tip - top) / 3.0f, tip + (top - tip) / 3.0f,
                         Wanted::largest);
}

} // namespace toile::body::rules
