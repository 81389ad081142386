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

inline constexpr int kPoseFeatures = 6; ///< rotation vectors of two joints

/// The two joints nearest to something on the body, by which its flesh is shaped.
using JointPair = std::array<std::uint8_t, 2>;

/// (22) rotation vectors of the joints' local rotations, radians.
using RotationVectors = std::array<Vec3f, kJointCount>;
[[nodiscard]] RotationVectors rotation_vectors(const Pose& pose) noexcept;

/// (6) the features of a pair.
[[nodiscard]] inline Eigen::Matrix<float, kPoseFeatures, 1>
pose_features(const RotationVectors& rotations, const JointPair& pair) noexcept {
    Eigen::Matrix<float, kPoseFeatures, 1> out;
    out << rotations[pair[0]], rotations[pair[1]];
    return out;
}

/// Learned: Q - I of each triangle, linear in its features; zero at rest.
struct PoseDeformation {
    std::vector<JointPair> joints;                               ///< (nf)
    std::vector<Eigen::Matrix<float, 9, kPoseFeatures>> weights; ///< (nf) columns of Q - I
};

/// Joint pair of each triangle: where skin weights change hands, then what is near. (nf)
[[nodiscard]] std::vector<JointPair> nearest_joints(const BodyModel& model,
                                                    std::span<const Triangle> triangles);

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

    /// R of every triangle, (nf), and skinned places of `positions`, (nv).
    void skin(const JointTransforms& skinning, std::span<const Vec3f> positions,
              std::span<Quatf> rotations, std::span<Vec3f> places) const;

    /// Vertices whose edges are nearest to matrices * edges of the mean body, area-weighted, and
    /// which stay near `places` on the whole: min sum_t area |grad x - M_t|^2 + pull sum_v area
    /// |x - place|^2. Matrices (nf), places and result (nv).
    void solve(std::span<const Mat3f> matrices, std::span<const Vec3f> places,
               std::span<Vec3f> result) const;

    /// S of every triangle for a shape of the same topology: linear in the displacement from the
    /// mean, the normal unchanged. (nf)
    [[nodiscard]] std::vector<Mat3f> shape_matrices(std::span<const Vec3f> positions) const;

  private:
    struct Corners {
        std::array<Vec3f, 3> gradient; ///< of the hat function at each corner, 1/m
        float area = 0.0f;             ///< m^2
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
