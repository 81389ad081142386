// A skinned surface relaxed as flesh on bones: what poses are learned from. Each triangle of the
// skin and a point near the bone beneath make a tetrahedron, which resists stretch and change of
// volume; cores and skin that belongs to one bone alone move with the bones.
#pragma once

#include "body/body_model.h"
#include "body/skeleton.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace toile::body {

struct FleshOptions {
    int iterations = 20;
    double shape_stiffness =
        1.0; ///< of the distance to the nearest rotation (as rigid as possible)
    double volume_stiffness = 2.0; ///< of the distance to the same shape at rest volume
    double bone_pull = 250.0;      ///< 1/m, of skin that one bone alone moves, per area
    float core_depth = 0.85f;      ///< of the way from the skin to the bone
};

/// Built once per body; `relax` is const and may run side by side.
class Flesh {
  public:
    /// Rest surface (closed), joints and weights of `model`. \throw Error when the system is
    /// singular
    explicit Flesh(const BodyModel& model, const FleshOptions& options = {});

    /// The surface at rest energy when the bones are moved by `skinning` (see
    /// skinning_transforms): local-global iterations from dual quaternion skinning. No contact:
    /// parts may pass through each other. (nv)
    [[nodiscard]] std::vector<Vec3f> relax(const JointTransforms& skinning) const;

  private:
    struct Element {
        Triangle skin{};
        std::array<Vec3f, 3> slope; ///< F = sum of vertex_i slope_i^T - core core_slope^T
        Vec3f core_slope;
        float stiffness = 0.0f; ///< volume of its part
    };
    using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

    void add_element(const BodyModel& model, const Triangle& t, const std::vector<Vec3f>& cores);

    FleshOptions options_;
    std::vector<Vec3f> rest_, cores_; ///< (nv); the core of a triangle is the mean of three
    SkinWeights skin_;
    std::vector<Element> elements_;
    Eigen::VectorXd pull_; ///< (nv)
    Solver solver_;
};

/// Nearest rotation to F by Mueller et al. 2016, starting from `guess`; right also for inverted F.
[[nodiscard]] Quatf nearest_rotation(const Mat3f& F, Quatf guess) noexcept;

} // namespace toile::body
