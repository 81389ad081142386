// A MakeHuman body from its data: targets added up, brought into our rest pose, on our 22 joints.
#pragma once

#include "body/makehuman_data.h"
#include "body/skeleton.h"

#include <map>
#include <string>
#include <vector>

namespace toile::body {

/// Amounts of targets by name; those of one shape are simply added.
using ShapeRecipe = std::map<std::string, double>;

/// Young adult of average muscle and weight, `woman` in [0, 1] (0: man), the three regional
/// shapes of the data in equal parts.
[[nodiscard]] ShapeRecipe adult_recipe(double woman);

/// The base mesh (with helpers) in our rest pose: metres, feet on y = 0, facing +Z.
struct BaseShape {
    std::vector<Vec3f> positions; ///< (19158)
    Skeleton skeleton;
};

/// Adds targets to the base mesh, lets the forearms hang (MakeHuman's are bent forward), scales
/// by `scale` on top of decimetres to metres, and stands it on the floor. \throw Error
[[nodiscard]] BaseShape make_base_shape(const MakeHumanData& data, const ShapeRecipe& recipe,
                                        double scale = 1.0);

/// How a shape's left forearm is laid into our rest pose: its share of each vertex turns about the
/// elbow. Linear in the shape as long as the turn stays the same.
struct ElbowTurn {
    Quatf turn;
    std::vector<std::uint32_t> elbow; ///< vertices whose mean is the joint
    std::vector<float> share;         ///< (19158) of each vertex, [0, 1]
};

/// The turn of one shape, decimetres or metres, in the data's own pose.
[[nodiscard]] ElbowTurn left_elbow_turn(const MakeHumanData& data,
                                        const std::vector<Vec3f>& positions);

/// Joints of a shape in the data's own pose, in its unit; linear in the positions.
[[nodiscard]] Skeleton read_joints(const MakeHumanData& data, const std::vector<Vec3f>& positions);

/// Does `joint` move with `ancestor` (or is it the same)?
[[nodiscard]] bool descends(Joint joint, Joint ancestor);

/// Our joint that each bone of the rig moves with. (bones)
[[nodiscard]] std::vector<Joint> bone_joints(const MakeHumanData& data);

} // namespace toile::body
