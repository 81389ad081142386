#include "body/measurement_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body::rules {
namespace {

using enum Landmark;
using geometry::GirthCutter;

/// From the floor straight up to the level of a point.
Reading upright(Survey& s, const Vec3f& point) {
    Reading out;
    out.value_m = s.height(point);
    out.tapes.push_back({{point - static_cast<float>(out.value_m) * s.figure().up, point}, false});
    out.confidence = s.trust();
    return out;
}

/// Straight from point to point.
Reading straight(Survey& s, std::vector<Vec3f> points) {
    Reading out;
    out.tapes.push_back({std::move(points), false});
    out.value_m = out.tapes.back().length();
    out.confidence = s.trust();
    return out;
}

/// Over the surface, pulled tight.
Reading over(Survey& s, const Vec3f& from, const Vec3f& to, const Vec3f& side) {
    Reading out;
    out.tapes.push_back(
        geometry::taut_path(s.figure().positions, s.figure().triangles, from, to, side));
    out.value_m = out.tapes.back().length();
    out.confidence = s.trust();
    return out;
}

/// One tape goes on where the other ends.
Reading then(Survey& s, Reading first, Reading second) {
    first.value_m += second.value_m;
    std::move(second.tapes.begin(), second.tapes.end(), std::back_inserter(first.tapes));
    first.confidence = s.trust();
    return first;
}

/// Between the two outermost points of a level of the trunk along a horizontal direction, drawn
/// through the level's middle.
Reading extent(Survey& s, const GirthCutter& cutter, float offset, const Vec3f& direction) {
    const Vec3f& up = cutter.normal();
    const Vec3f along = (direction - direction.dot(up) * up).normalized();
    const Vec3f beside = up.cross(along);
    const float high = cutter.extent(offset, along), low = -cutter.extent(offset, -along);
    const float middle = 0.5f * (cutter.extent(offset, beside) - cutter.extent(offset, -beside));
    const Vec3f base = offset * up + middle * beside;
    return straight(s, {base + low * along, base + high * along});
}

/// Level of the middle of two points.
float level(Survey& s, const GirthCutter& cutter, Landmark left, Landmark right) {
    return cutter.offset(s.middle_of(left, right));
}

/// The highest point of the head, or the farthest in any other direction of another region.
Vec3f farthest(Survey& s, Region region, const Vec3f& direction) {
    Vec3f best = Vec3f::Zero();
    float most = -std::numeric_limits<float>::infinity();
    for (const std::uint32_t v : s.region(region).vertices()) {
        const float reach = direction.dot(s.figure().positions[v]);
        if (reach <= most) continue;
        most = reach;
        best = s.figure().positions[v];
    }
    return best;
}

/// The middle of the back at the level of `point` on the chest's cuts.
Vec3f back_at(Survey& s, const Vec3f& point) {
    return s.level_point(s.chest(), s.chest().offset(point), s.middle_of(left_armpit, right_armpit),
                         -s.figure().chest.forward);
}

/// Where a tape that hangs from the bust point meets the waist.
Vec3f waist_below_bust(Survey& s) {
    const Vec3f left = s.figure().waist.left;
    Vec3f inside = s.middle_of(left_iliac_crest, right_iliac_crest);
    inside += left.dot(s.at(right_bust_point) - inside) * left;
    return s.level_point(s.waist(), s.waist_level(), inside, s.figure().waist.forward);
}

} // namespace

Reading stature(Survey& s) {
    return upright(s, farthest(s, Region::head, s.figure().up));
}
Reading cervical_height(Survey& s) {
    return upright(s, s.at(neck_back));
}
Reading shoulder_height(Survey& s) {
    return upright(s, s.at(right_shoulder));
}
Reading armpit_height(Survey& s) {
    return upright(s, s.at(right_armpit));
}
Reading bust_height(Survey& s) {
    return upright(s, s.at(right_bust_point));
}
Reading waist_height(Survey& s) {
    return upright(s, s.waist_point(-s.figure().waist.left));
}
Reading navel_height(Survey& s) {
    return upright(s, s.at(navel));
}
Reading trochanter_height(Survey& s) {
    return upright(s, s.at(right_trochanter));
}
Reading hip_height(Survey& s) {
    return upright(s, s.hip_point(-s.figure().hips.left));
}
Reading crotch_height(Survey& s) {
    return upright(s, s.at(crotch));
}
Reading knee_height(Survey& s) {
    return upright(s, s.at(right_knee));
}
Reading ankle_height(Survey& s) {
    return upright(s, s.at(right_ankle));
}

Reading shoulder_length(Survey& s) {
    return over(s, s.at(right_neck_side), s.at(right_shoulder), s.figure().chest.up);
}
Reading shoulder_width(Survey& s) {
    return straight(s, {s.at(left_shoulder), s.at(right_shoulder)});
}
Reading back_shoulder_width(Survey& s) {
    return over(s, s.at(left_shoulder), s.at(right_shoulder), -s.figure().chest.forward);
}
Reading back_width(Survey& s) {
    return over(s, s.at(left_scye_back), s.at(right_scye_back), -s.figure().chest.forward);
}
Reading chest_width(Survey& s) {
    return over(s, s.at(left_scye_front), s.at(right_scye_front), s.figure().chest.forward);
}
Reading bust_point_width(Survey& s) {
    return straight(s, {s.at(left_bust_point), s.at(right_bust_point)});
}
Reading neck_side_to_bust_point(Survey& s) {
    return over(s, s.at(right_neck_side), s.at(right_bust_point), s.figure().chest.forward);
}
Reading front_waist_length(Survey& s) {
    Reading down = over(s, s.at(right_bust_point), waist_below_bust(s), s.figure().chest.forward);
    return then(s, neck_side_to_bust_point(s), std::move(down));
}
Reading back_waist_length(Survey& s) {
    return over(s, s.at(neck_back), s.waist_point(-s.figure().waist.forward),
                -s.figure().waist.forward);
}
Reading back_navel_length(Survey& s) {
    const Vec3f inside = s.middle_of(left_iliac_crest, right_iliac_crest);
    const Vec3f low =
        s.level_point(s.waist(), s.waist().offset(s.at(navel)), inside, -s.figure().waist.forward);
    return over(s, s.at(neck_back), low, -s.figure().waist.forward);
}
Reading scye_depth(Survey& s) {
    return over(s, s.at(neck_back), back_at(s, s.middle_of(left_armpit, right_armpit)),
                -s.figure().chest.forward);
}
Reading waist_to_hip(Survey& s) {
    const Vec3f right = -s.figure().hips.left;
    return over(s, s.waist_point(right), s.hip_point(right), right);
}
Reading trunk_length(Survey& s) {
    const Vec3f top = s.at(neck_back);
    const float drop = s.figure().chest.up.dot(top - s.at(crotch));
    return straight(s, {top, top - drop * s.figure().chest.up});
}
Reading total_crotch_length(Survey& s) {
    const Vec3f ahead = s.figure().waist.forward;
    return over(s, s.waist_point(ahead), s.waist_point(-ahead), -s.figure().hips.up);
}
Reading navel_crotch_length(Survey& s) {
    const Vec3f ahead = s.figure().waist.forward;
    const Vec3f inside = s.middle_of(left_iliac_crest, right_iliac_crest);
    const float at_navel = s.waist().offset(s.at(navel));
    return over(s, s.level_point(s.waist(), at_navel, inside, ahead),
                s.level_point(s.waist(), at_navel, inside, -ahead), -s.figure().hips.up);
}
Reading upper_body_length(Survey& s) {
    return over(s, s.at(neck_back), s.hip_point(-s.figure().hips.forward),
                -s.figure().hips.forward);
}
Reading neck_to_hip_distance(Survey& s) {
    const Vec3f top = s.at(neck_back);
    const float drop = s.hips().offset(top) - s.hip_level();
    return straight(s, {top, top - drop * s.figure().hips.up});
}

Reading upper_arm_length(Survey& s) {
    return straight(s, {s.at(right_shoulder), s.at(right_elbow)});
}
Reading lower_arm_length(Survey& s) {
    return straight(s, {s.at(right_elbow), s.at(right_wrist)});
}
Reading arm_length(Survey& s) {
    return straight(s, {s.at(right_shoulder), s.at(right_elbow), s.at(right_wrist)});
}
Reading cervical_to_wrist_length(Survey& s) {
    const Vec3f shoulder = s.at(right_shoulder);
    Reading neck = over(s, s.at(neck_back), shoulder, s.figure().chest.up);
    return then(s, std::move(neck), arm_length(s));
}
Reading underarm_length(Survey& s) {
    return straight(s, {s.at(right_armpit), s.at(right_inner_wrist)});
}
Reading hand_length(Survey& s) {
    return straight(s, {s.at(right_inner_wrist), s.at(right_fingertip)});
}
Reading outside_leg_length(Survey& s) {
    const Vec3f hip = s.hip_point(-s.figure().hips.left);
    return then(s, waist_to_hip(s), upright(s, hip));
}
Reading thigh_length(Survey& s) {
    return straight(s, {s.at(right_trochanter), s.at(right_knee)});
}
Reading leg_length(Survey& s) {
    const Vec3f ankle = s.at(right_ankle);
    Reading shaft = straight(s, {s.at(right_trochanter), ankle});
    return then(s, std::move(shaft), upright(s, ankle));
}
Reading foot_length(Survey& s) {
    const Limb& leg = s.figure().right_leg;
    const Vec3f up = s.figure().up;
    Vec3f ahead = leg.tip - leg.end;
    ahead = (ahead - ahead.dot(up) * up).normalized();
    const float ankle = up.dot(s.at(right_ankle));
    float heel = std::numeric_limits<float>::infinity(), toe = -heel;
    for (const std::uint32_t v : s.region(Region::right_leg).vertices()) {
        const Vec3f& p = s.figure().positions[v];
        if (up.dot(p) > ankle) continue;
        heel = std::min(heel, ahead.dot(p));
        toe = std::max(toe, ahead.dot(p));
    }
    const Vec3f sole = leg.tip - static_cast<float>(s.height(leg.tip)) * up;
    return straight(
        s, {sole + (heel - ahead.dot(sole)) * ahead, sole + (toe - ahead.dot(sole)) * ahead});
}
Reading acromion_radiale_length(Survey& s) {
    return straight(s, {s.at(right_shoulder), s.at(right_radiale)});
}
Reading radiale_stylion_length(Survey& s) {
    return straight(s, {s.at(right_radiale), s.at(right_inner_wrist)});
}
Reading sleeve_outseam(Survey& s) {
    return straight(s, {s.at(right_shoulder), s.at(right_radiale), s.at(right_inner_wrist)});
}
Reading sleeve_spine_wrist(Survey& s) {
    constexpr double kArmIsNotRaised = 0.5;
    const Vec3f spine = back_at(s, s.middle_of(left_scye_back, right_scye_back));
    Reading back = over(s, spine, s.at(right_shoulder), -s.figure().chest.forward);
    s.rest_on(kArmIsNotRaised);
    return then(s, std::move(back), arm_length(s));
}
Reading span(Survey& s) {
    constexpr double kArmsAreNotSpread = 0.6;
    const Limb& arm = s.figure().right_arm;
    const Vec3f tip = s.at(right_fingertip);
    Reading half = straight(s, {arm.root, arm.middle, arm.end, tip});
    // Half the breadth of the shoulders, then the arm as if it were straight.
    const Vec3f shoulders = s.at(left_shoulder) - s.at(right_shoulder);
    const Vec3f middle = s.middle_of(left_shoulder, right_shoulder);
    half.value_m += static_cast<double>(std::abs(shoulders.normalized().dot(middle - arm.root)));
    half.value_m *= 2.0;
    s.rest_on(kArmsAreNotSpread);
    half.confidence = s.trust();
    return half;
}

Reading bust_breadth(Survey& s) {
    return extent(s, s.chest(), level(s, s.chest(), left_bust_point, right_bust_point),
                  s.figure().chest.left);
}
Reading bust_depth(Survey& s) {
    return extent(s, s.chest(), level(s, s.chest(), left_bust_point, right_bust_point),
                  s.figure().chest.forward);
}
Reading waist_breadth(Survey& s) {
    return extent(s, s.waist(), s.waist_level(), s.figure().waist.left);
}
Reading waist_depth(Survey& s) {
    return extent(s, s.waist(), s.waist_level(), s.figure().waist.forward);
}
Reading navel_breadth(Survey& s) {
    return extent(s, s.waist(), s.waist().offset(s.at(navel)), s.figure().waist.left);
}
Reading navel_depth(Survey& s) {
    return extent(s, s.waist(), s.waist().offset(s.at(navel)), s.figure().waist.forward);
}
Reading hip_breadth(Survey& s) {
    return extent(s, s.hips(), s.hip_level(), s.figure().hips.left);
}
Reading hip_depth(Survey& s) {
    return extent(s, s.hips(), s.hip_level(), s.figure().hips.forward);
}

} // namespace toile::body::rules
