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

/// Our joint that each bone of the rig moves with. (bones)
[[nodiscard]] std::vector<Joint> bone_joints(const MakeHumanData& data);

} // namespace toile::body
