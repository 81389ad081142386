#include "body/measurement.h"
#include "body/measurement_rules.h"

#include <array>

namespace toile::body {
namespace {

using enum MeasurementKind;
using namespace rules;

constexpr auto kDefinitions = std::to_array<MeasurementDefinition>({
    // Heights.
    {"stature", height, "stature", "From the floor to the highest point of the head.", stature},
    {"cervical_height", height, "cervicaleheight", "From the floor to the neck back point.",
     cervical_height},
    {"shoulder_height", height, "acromialheight", "From the floor to the shoulder point.",
     shoulder_height},
    {"armpit_height", height, "", "From the floor to the armpit.", armpit_height},
    {"bust_height", height, "chestheight", "From the floor to the bust point.", bust_height},
    {"waist_height", height, "", "From the floor to the waist level at the side (see waist_girth).",
     waist_height},
    {"trochanter_height", height, "trochanterionheight", "From the floor to the trochanter.",
     trochanter_height},
    {"hip_height", height, "buttockheight",
     "From the floor to the hip level at the side (see hip_girth).", hip_height},
    {"crotch_height", height, "crotchheight", "From the floor to the crotch.", crotch_height},
    {"knee_height", height, "kneeheightmidpatella", "From the floor to the middle of the knee cap.",
     knee_height},
    {"ankle_height", height, "lateralmalleolusheight", "From the floor to the outer ankle bone.",
     ankle_height},

    // Girths.
    {"head_girth", girth, "headcircumference",
     "Around the head through the brow and the back of the head, above the ears.", head_girth},
    {"neck_girth", girth, "neckcircumference",
     "Around the neck at the larynx, across the neck's axis.", neck_girth},
    {"neck_base_girth", girth, "neckcircumferencebase",
     "Over the neck back point, both neck side points and the neck front point.", neck_base_girth},
    {"upper_chest_girth", girth, "", "Around the trunk at the level of the armpits.",
     upper_chest_girth},
    {"chest_girth", girth, "",
     "The largest girth of the trunk between the creases under the breasts and the armpits.",
     chest_girth},
    {"bust_girth", girth, "chestcircumference", "Around the trunk at the level of the bust points.",
     bust_girth},
    {"under_bust_girth", girth, "",
     "Around the trunk at the level of the creases under the breasts.", under_bust_girth},
    {"waist_girth", girth, "",
     "Around the trunk at the natural waist: the narrowest level between the lowest rib and the "
     "top of the hip bone; where there is none, the middle between them.",
     waist_girth},
    {"high_hip_girth", girth, "",
     "Around the trunk at the level of the front ends of the hip bones.", high_hip_girth},
    {"hip_girth", girth, "buttockcircumference",
     "Around the trunk where the buttocks stand out most.", hip_girth},
    {"armscye_girth", girth, "",
     "From the shoulder point down the front fold of the arm, through the armpit and up the back "
     "fold.",
     armscye_girth},
    {"upper_arm_girth", girth, "",
     "Around the hanging upper arm half-way between armpit and tip of the elbow, across its axis.",
     upper_arm_girth},
    {"elbow_girth", girth, "",
     "Around the elbow over its tip, halving the angle between upper and lower arm.", elbow_girth},
    {"forearm_girth", girth, "",
     "The largest girth of the lower arm below the elbow's own (the first fifth of the way to the "
     "wrist), across its axis.",
     forearm_girth},
    {"wrist_girth", girth, "wristcircumference",
     "Around the wrist over the wrist bone, across the lower arm's axis.", wrist_girth},
    {"thigh_girth", girth, "thighcircumference",
     "Around the thigh at the gluteal fold, across its axis.", thigh_girth},
    {"mid_thigh_girth", girth, "",
     "Around the thigh half-way between trochanter and knee cap, across its axis.",
     mid_thigh_girth},
    {"knee_girth", girth, "", "Around the knee at the middle of the knee cap.", knee_girth},
    {"lower_knee_girth", girth, "",
     "Around the leg below the knee cap, at the top of the shin bone, across the shin's axis.",
     lower_knee_girth},
    {"calf_girth", girth, "calfcircumference",
     "The largest girth between the top of the shin bone and the shin's middle, across its axis.",
     calf_girth},
    {"minimum_leg_girth", girth, "anklecircumference",
     "The smallest girth between the shin's middle and the ankle, across the shin's axis.",
     minimum_leg_girth},
    {"ankle_girth", girth, "", "Around both ankle bones, across the shin's axis.", ankle_girth},
    {"trunk_circumference", girth, "verticaltrunkcircumferenceusa",
     "From the middle of the shoulder line over the bust point, through the crotch and up the "
     "back.",
     trunk_circumference},

    // Lengths over the surface or straight.
    {"shoulder_length", length, "shoulderlength",
     "Over the surface from the neck side point to the shoulder point.", shoulder_length},
    {"shoulder_width", length, "biacromialbreadth",
     "Straight from shoulder point to shoulder point.", shoulder_width},
    {"back_shoulder_width", length, "", "From shoulder point to shoulder point over the back.",
     back_shoulder_width},
    {"back_width", length, "",
     "Over the back between the back folds of the arms, half-way between armpit and shoulder.",
     back_width},
    {"chest_width", length, "",
     "Over the chest between the front folds of the arms, half-way between armpit and shoulder.",
     chest_width},
    {"bust_point_width", length, "", "Straight from bust point to bust point.", bust_point_width},
    {"neck_side_to_bust_point", length, "",
     "Over the surface from the neck side point to the bust point.", neck_side_to_bust_point},
    {"front_waist_length", length, "",
     "From the neck side point over the bust point and straight down to the waist level.",
     front_waist_length},
    {"back_waist_length", length, "",
     "Down the middle of the back from the neck back point to the waist level.", back_waist_length},
    {"scye_depth", length, "",
     "Down the middle of the back from the neck back point to the level of the armpits.",
     scye_depth},
    {"waist_to_hip", length, "", "Over the side from the waist level to the hip level.",
     waist_to_hip},
    {"trunk_length", length, "", "Upright from the neck back point to the level of the crotch.",
     trunk_length},
    {"total_crotch_length", length, "",
     "From the middle of the front at the waist level through the crotch to the middle of the "
     "back.",
     total_crotch_length},
    {"upper_arm_length", length, "", "Straight from the shoulder point to the tip of the elbow.",
     upper_arm_length},
    {"lower_arm_length", length, "", "Straight from the tip of the elbow to the wrist bone.",
     lower_arm_length},
    {"arm_length", length, "",
     "From the shoulder point over the tip of the elbow to the wrist bone (also P2's and P5's arm "
     "length).",
     arm_length},
    {"cervical_to_wrist_length", length, "",
     "From the neck back point over the shoulder point and the tip of the elbow to the wrist "
     "bone.",
     cervical_to_wrist_length},
    {"underarm_length", length, "", "Straight from the armpit to the inner wrist bone.",
     underarm_length},
    {"hand_length", length, "handlength",
     "Straight from the inner wrist bone to the tip of the middle finger.", hand_length},
    {"inside_leg_length", length, "", "From the crotch straight down to the floor.", crotch_height},
    {"outside_leg_length", length, "",
     "From the waist level over the side to the hip level, then straight down to the floor.",
     outside_leg_length},
    {"thigh_length", length, "", "Straight from the trochanter to the middle of the knee cap.",
     thigh_length},
    {"foot_length", length, "footlength", "Along the foot from the heel to the longest toe.",
     foot_length},

    // Breadths and depths.
    {"bust_breadth", breadth, "chestbreadth", "Breadth of the trunk at the bust points' level.",
     bust_breadth},
    {"bust_depth", breadth, "chestdepth", "Depth of the trunk at the bust points' level.",
     bust_depth},
    {"waist_breadth", breadth, "", "Breadth of the trunk at the waist level.", waist_breadth},
    {"waist_depth", breadth, "", "Depth of the trunk at the waist level.", waist_depth},
    {"hip_breadth", breadth, "hipbreadth", "Breadth of the trunk at the hip level.", hip_breadth},
    {"hip_depth", breadth, "buttockdepth", "Depth of the trunk at the hip level.", hip_depth},

    // Of the papers.
    {"upper_body_length", length, "",
     "Down the middle of the back from the neck back point to the hip level (P1 4.4, which does "
     "not say between which points).",
     upper_body_length},
    {"neck_to_hip_distance", length, "",
     "Straight along the spine from the neck back point to the hip level (P2 table 1, P5).",
     neck_to_hip_distance},
    {"leg_length", length, "",
     "Straight from the trochanter to the outer ankle bone, then down to the floor (P2 table 1, "
     "P5).",
     leg_length},

    // ANSUR II's own paths where they are none of the above.
    {"ansur_waist_circumference", girth, "waistcircumference",
     "Around the trunk at the level of the navel.", navel_girth},
    {"ansur_waist_height", height, "waistheightomphalion", "From the floor to the navel.",
     navel_height},
    {"ansur_waist_back_length", length, "waistbacklength",
     "Down the middle of the back from the neck back point to the level of the navel.",
     back_navel_length},
    {"ansur_waist_breadth", breadth, "waistbreadth", "Breadth of the trunk at the navel's level.",
     navel_breadth},
    {"ansur_waist_depth", breadth, "waistdepth", "Depth of the trunk at the navel's level.",
     navel_depth},
    {"ansur_crotch_length", length, "crotchlengthomphalion",
     "From the navel through the crotch to the same level on the back.", navel_crotch_length},
    {"ansur_biceps_circumference_flexed", girth, "bicepscircumferenceflexed",
     "The largest girth of the middle third of the upper arm; the survey flexes the arm, so that "
     "this one is smaller and its confidence low.",
     biceps_flexed_girth},
    {"ansur_acromion_radiale_length", length, "acromionradialelength",
     "Straight from the shoulder point to the outer side of the elbow's crease.",
     acromion_radiale_length},
    {"ansur_radiale_stylion_length", length, "radialestylionlength",
     "Straight from the outer side of the elbow's crease to the inner wrist bone.",
     radiale_stylion_length},
    {"ansur_sleeve_outseam", length, "sleeveoutseam",
     "From the shoulder point over the outer side of the elbow's crease to the inner wrist bone.",
     sleeve_outseam},
    {"ansur_sleeve_length_spine_wrist", length, "sleevelengthspinewrist",
     "From the middle of the back at the back folds' level over the shoulder point and the tip of "
     "the elbow to the wrist bone; the survey raises and bends the arm, so that its confidence is "
     "low.",
     sleeve_spine_wrist},
    {"ansur_span", length, "span",
     "From fingertip to fingertip of spread arms: added up along the bones of the hanging arm.",
     rules::span},
});

} // namespace

std::span<const MeasurementDefinition> measurement_definitions() {
    return kDefinitions;
}

} // namespace toile::body
