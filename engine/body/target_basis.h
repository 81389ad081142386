// Every target of a modifier set carried onto the template once, so that a body is one product:
// half = origin + targets * amounts.
#pragma once

#include "body/avatar_template.h"
#include "body/body_shape.h"

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace toile::body {

/// Coordinates stand as x y z of each vertex of the template's first half, then of each joint.
struct TargetBasis {
    Eigen::VectorXf origin;  ///< (3 half + 66) the base mesh without targets, metres
    Eigen::MatrixXf targets; ///< (3 half + 66 x targets) per unit amount

    /// The coordinates of a body; its floor is anywhere.
    [[nodiscard]] Eigen::VectorXf coordinates(const Eigen::VectorXd& amounts) const;
};

/// Carries `names` ("/l-" brings its "/r-" along). Forearms are laid into the rest pose by the turn
/// of the template's own shape, so that all is linear. Takes about 30 ms a target. \throw Error
[[nodiscard]] TargetBasis make_target_basis(const MakeHumanData& data, const AvatarTemplate& avatar,
                                            const ShapeCarrier& carrier,
                                            std::span<const std::string> names);

/// Both halves of a displacement: vertices and joints as they move.
[[nodiscard]] BodyShape unfold_offsets(const AvatarTemplate& avatar,
                                       const Eigen::VectorXf& coordinates);

/// Both halves of `coordinates`, stood on the floor.
[[nodiscard]] BodyShape unfold(const AvatarTemplate& avatar, const Eigen::VectorXf& coordinates);

} // namespace toile::body
