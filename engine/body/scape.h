// SCAPE (Anguelov et al. 2005; P5 eq. 21): a body from per-triangle matrices R (joints), S (shape)
// and Q (what a pose does to flesh), put together by one sparse solve.
#pragma once

#include "body/body_model.h"
#include "body/body_shape.h"
#include "body/dual_quaternion.h"

#include <Eigen/SparseCholesky>
#include <memory>
#include <span>

namespace toile::body {

/// The joints nearest to something on the body, by which its flesh is shaped; nearest first. Two,
/// as is usual, left 82 % of the error of linear blend skinning: the trunk bends with more.
inline constexpr std::size_t kNearJoints = 4;
using NearJoints = std::array<std::uint8_t, kNearJoints>;

/// Rotation vectors of the joints, then the products of components of the nearest and of the second
/// one: flesh bulges alike whether it turns this way or that.
inline constexpr int kPoseFeatures = 3 * static_cast<int>(kNearJoints) + 12;
using PoseFeatures = Eigen::Matrix<float, kPoseFeatures, 1>;

/// (22) rotation vectors of the joints' local rotations, radians.
using RotationVectors = std::array<Vec3f, kJointCount>;
[[nodiscard]] RotationVectors rotation_vectors(const Pose& pose) noexcept;

[[nodiscard]] inline PoseFeatures pose_features(const RotationVectors& rotations,
                                                const NearJoints& joints) noexcept {
    PoseFeatures out;
    for (std::size_t i = 0; i < kNearJoints; ++i)
        out.segment<3>(static_cast<int>(3 * i)) = rotations[joints[i]];
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3f& r = rotations[joints[i]];
        out.segment<6>(static_cast<int>(3 * kNearJoints + 6 * i)) << r.x() * r.x(), r.y() * r.y(),
            r.z() * r.z(), r.x() * r.y(), r.y() * r.z(), r.z() * r.x();
    }
    return out;
}

/// Two unit vectors at a right angle that span a triangle, as columns.
using Tangents = Eigen::Matrix<float, 3, 2>;
[[nodiscard]] Tangents tangents(std::span<const Vec3f> positions, const Triangle& triangle);

/// Learned: (Q - I) times the tangents of each triangle of the mean body, linear in its features;
/// zero at rest. Its two columns stand one below the other. What Q does to the normal moves no
/// edge, and is not kept.
struct PoseDeformation {
    std::vector<NearJoints> joints;                              ///< (nf)
    std::vector<Eigen::Matrix<float, 6, kPoseFeatures>> weights; ///< (nf)
};

/// The joints of each triangle: where skin weights change hands, then what is near. (nf)
[[nodiscard]] std::vector<NearJoints> nearest_joints(const BodyModel& model,
                                                     std::span<const Triangle> triangles);

/// How much of a vertex's skin one bone alone holds, [0, 1]: there skinning is right.
[[nodiscard]] float held_by_one_bone(const std::array<float, 4>& weights) noexcept;

/// What all shapes share; immutable. The rotation R of a triangle is the dual quaternion blend of
/// its corners' joints (a rigid part's own rotation, as in the papers, away from joints), so that Q
/// is small and smooth; Q acts first, then S, then R.
class ScapeModel {
  public:
    /// `model`: rest surface (the mean body), skeleton, weights. `deformation` with no rows: Q = I.
    /// \throw Error when sizes differ or the system is singular
    ScapeModel(const BodyModel& model, PoseDeformation deformation);

    [[nodiscard]] std::size_t vertex_count() const { return rest_.size(); }
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] const PoseDeformation& deformation() const { return deformation_; }
    /// Q - I of a triangle, up to what it does to the normal.
    [[nodiscard]] Mat3f flesh_change(std::size_t triangle, const RotationVectors& turns) const;

    /// R of every triangle, (nf), and skinned places of `positions`, (nv).
    void skin(const JointTransforms& skinning, std::span<const Vec3f> positions,
              std::span<Quatf> rotations, std::span<Vec3f> places) const;

    /// Vertices whose edges are nearest to matrices * edges of the mean body, area-weighted, and
    /// which stay near `places`, on the whole and where one bone holds them: min sum_t area
    /// |grad x - M_t|^2 + sum_v pull_v area |x - place|^2. Matrices (nf), places and result (nv).
    void solve(std::span<const Mat3f> matrices, std::span<const Vec3f> places,
               std::span<Vec3f> result) const;

    /// S of every triangle for a shape of the same topology: linear in the displacement from the
    /// mean, the normal unchanged. (nf)
    [[nodiscard]] std::vector<Mat3f> shape_matrices(std::span<const Vec3f> positions) const;

  private:
    struct Corners {
        std::array<Vec3f, 3> gradient; ///< of the hat function at each corner, 1/m
        Tangents tangents;
        float area = 0.0f; ///< m^2
        std::array<std::uint16_t, 4> joints{};
        std::array<float, 4> weights{};
    };
    using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

    std::vector<Vec3f> rest_;
    std::vector<Triangle> triangles_;
    SkinWeights skin_;
    std::vector<Corners> corners_; ///< (nf)
    PoseDeformation deformation_;
    Eigen::SparseMatrix<double> laplacian_;
    Eigen::VectorXd pull_; ///< (nv)
    Solver solver_;
};

/// One shape, to be posed many times. Borrows the model. Not for several threads at once: it keeps
/// its work space.
class ScapeBody {
  public:
    ScapeBody(const ScapeModel& model, BodyShape shape);

    [[nodiscard]] const BodyShape& shape() const { return shape_; }
    /// Writes (nv) vertices. Equivariant to rigid motions of the hips.
    void pose(const Pose& pose, std::span<Vec3f> positions);

  private:
    const ScapeModel& model_;
    BodyShape shape_;
    std::vector<Mat3f> S_;
    std::vector<Mat3f> matrices_;
    std::vector<Quatf> rotations_;
    std::vector<Vec3f> places_;
};

} // namespace toile::body
