// How each measurement is taken; docs/measurements.md tells it in words.
#pragma once

#include "body/survey.h"

namespace toile::body::rules {

// Vertical distances from the floor.
Reading stature(Survey& s);
Reading cervical_height(Survey& s);
Reading shoulder_height(Survey& s);
Reading armpit_height(Survey& s);
Reading bust_height(Survey& s);
Reading waist_height(Survey& s);
Reading navel_height(Survey& s);
Reading trochanter_height(Survey& s);
Reading hip_height(Survey& s);
Reading crotch_height(Survey& s);
Reading knee_height(Survey& s);
Reading ankle_height(Survey& s);

// Girths: a tape pulled tight around a part of the body (P5, figure 9b).
Reading head_girth(Survey& s);
Reading neck_girth(Survey& s);
Reading neck_base_girth(Survey& s);
Reading upper_chest_girth(Survey& s);
Reading chest_girth(Survey& s);
Reading bust_girth(Survey& s);
Reading under_bust_girth(Survey& s);
Reading waist_girth(Survey& s);
Reading navel_girth(Survey& s);
Reading high_hip_girth(Survey& s);
Reading hip_girth(Survey& s);
Reading armscye_girth(Survey& s);
Reading upper_arm_girth(Survey& s);
Reading elbow_girth(Survey& s);
Reading forearm_girth(Survey& s);
Reading wrist_girth(Survey& s);
Reading thigh_girth(Survey& s);
Reading mid_thigh_girth(Survey& s);
Reading knee_girth(Survey& s);
Reading lower_knee_girth(Survey& s);
Reading calf_girth(Survey& s);
Reading minimum_leg_girth(Survey& s);
Reading ankle_girth(Survey& s);
Reading trunk_circumference(Survey& s);
Reading biceps_flexed_girth(Survey& s);

// Over the surface or straight, from point to point.
Reading shoulder_length(Survey& s);
Reading shoulder_width(Survey& s);
Reading back_shoulder_width(Survey& s);
Reading back_width(Survey& s);
Reading chest_width(Survey& s);
Reading bust_point_width(Survey& s);
Reading neck_side_to_bust_point(Survey& s);
Reading front_waist_length(Survey& s);
Reading back_waist_length(Survey& s);
Reading back_navel_length(Survey& s);
Reading scye_depth(Survey& s);
Reading waist_to_hip(Survey& s);
Reading trunk_length(Survey& s);
Reading total_crotch_length(Survey& s);
Reading navel_crotch_length(Survey& s);
Reading upper_body_length(Survey& s);
Reading neck_to_hip_distance(Survey& s);
Reading upper_arm_length(Survey& s);
Reading lower_arm_length(Survey& s);
Reading arm_length(Survey& s);
Reading cervical_to_wrist_length(Survey& s);
Reading underarm_length(Survey& s);
Reading hand_length(Survey& s);
Reading outside_leg_length(Survey& s);
Reading thigh_length(Survey& s);
Reading leg_length(Survey& s);
Reading foot_length(Survey& s);
Reading acromion_radiale_length(Survey& s);
Reading radiale_stylion_length(Survey& s);
Reading sleeve_outseam(Survey& s);
Reading sleeve_spine_wrist(Survey& s);
Reading span(Survey& s);

// Between two upright planes.
Reading bust_breadth(Survey& s);
Reading bust_depth(Survey& s);
Reading waist_breadth(Survey& s);
Reading waist_depth(Survey& s);
Reading navel_breadth(Survey& s);
Reading navel_depth(Survey& s);
Reading hip_breadth(Survey& s);
Reading hip_depth(Survey& s);

} // namespace toile::body::rules
