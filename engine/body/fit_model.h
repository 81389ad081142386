// A body space as fits and trackers move it: its baked form at one of its levels, and how every
// vertex moves with each unknown.
#pragma once

#include "body/body_space.h"
#include "body/dual_quaternion.h"
#include "body/pose_tables.h"

#include <memory>
#include <vector>

namespace toile::body {

using ShapeRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ShapeVector = Eigen::VectorXd;

inline constexpr int kPoseUnknowns = 3 + 3 * static_cast<int>(kJointCount);

/// Vertices of one level, with all that posing and its derivatives need.
struct FitLevel {
    std::vector<std::uint32_t> vertices; ///< (n) of the full surface
    std::vector<Triangle> triangles;     ///< of level vertices
    std::vector<Vec3f> mean;             ///< (n) rest places of the mean body, metres
    std::vector<Vec3f> mean_normals;     ///< (n) of the full surface, unit
    ShapeRows components;                ///< (3 n x k) metres per unit of a coefficient
    SkinWeights skin;                    ///< (n)
    Correctives correctives;             ///< (n)
    /// (n) share of each vertex that moves with a joint or what hangs on it.
    std::vector<std::array<float, kJointCount>> below;
    std::vector<float> areas;          ///< (n) of the mean body that belongs to each, m^2
    std::vector<std::uint8_t> clothed; ///< (n) 1: not head, hands or feet
    std::vector<std::uint8_t> face;    ///< (n) 1: between brow and chin, in front
    std::vector<float> trust; ///< (n) how far the model can be believed there: hands and face less
};

/// Immutable; finest level first.
class FitModel {
  public:
    /// \throw Error when the folder is no body space with pose tables
    explicit FitModel(const std::filesystem::path& folder);

    [[nodiscard]] const BodySpace& space() const { return space_; }
    [[nodiscard]] int component_count() const { return space_.component_count(); }
    [[nodiscard]] std::size_t level_count() const { return levels_.size(); }
    [[nodiscard]] const FitLevel& level(std::size_t index) const { return levels_.at(index); }
    [[nodiscard]] const PoseTables& pose_tables() const { return tables_; }

    /// Joints at rest of a shape, not stood on the floor: as FitLevel's rest places are.
    [[nodiscard]] Skeleton skeleton(const ShapeVector& shape) const;
    /// (3 joints x k)
    [[nodiscard]] const ShapeRows& joint_components() const { return joint_components_; }

  private:
    BodySpace space_;
    PoseTables tables_;
    std::vector<FitLevel> levels_;
    ShapeRows joint_components_;
};

/// One level's surface in one shape and pose. Reused from step to step: after the first call
/// nothing allocates.
struct PosedLevel {
    Skeleton skeleton;
    JointTransforms world;        ///< world_from_joint
    std::vector<Vec3f> rest;      ///< (n) of the shape
    std::vector<Vec3f> positions; ///< (n) world
    std::vector<Vec3f> normals;   ///< (n) unit
    std::vector<Quatf> rotations; ///< (n) of the skin there
    ShapeRows joint_moves;        ///< (3 joints x k) world joint places by coefficient
};

/// A person's shape: coefficients, and what the space cannot show.
struct FitShape {
    ShapeVector coefficients;   ///< (k) in standard deviations
    std::vector<float> offsets; ///< (nv) along the mean body's normals at rest, metres; or empty
};

/// Fills `out` for a level.
void pose_level(const FitModel& model, const FitLevel& level, const FitShape& shape,
                const Pose& pose, PosedLevel& out);
/// The full surface and joints at rest, stood on the floor.
[[nodiscard]] BodyShape rest_shape(const FitModel& model, const FitShape& shape);

/// How normal . x of a vertex changes with the unknowns: k coefficients, then the hips' place and
/// the rotation vectors of the joints (each before its own rotation, in the parent's frame; hips:
/// the world's). `row` (k + 69). The pose's correctives count as fixed.
void motion_row(const FitModel& model, const FitLevel& level, const PosedLevel& posed,
                std::uint32_t vertex, const Vec3f& normal, float* row);

/// `pose` moved by 69 unknowns as in `motion_row`.
[[nodiscard]] Pose moved_pose(const Pose& pose, const double* step);

} // namespace toile::body
