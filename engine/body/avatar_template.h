// Our own template surface: closed, near-uniform, symmetric; and how shapes are carried onto it.
#pragma once

#include "body/avatar_shape.h"
#include "geometry/mesh.h"
#include "geometry/subdivision.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace toile::body {

/// Where a template vertex sits on the refined base surface.
struct SurfacePoint {
    Triangle corners{}; ///< refined vertices
    Vec3f barycentric = Vec3f::Zero();
    float trust = 1.0f; ///< 0 where a cavity was filled: nothing lies beneath
};

/// One topology for all avatars. Vertices [0, half) have x >= 0; the rest are mirror images.
struct AvatarTemplate {
    geometry::TriangleMesh mesh; ///< in the shape it was made from, rest pose
    Skeleton skeleton;           ///< of that shape
    std::size_t half = 0;
    std::vector<std::uint32_t> mirror_of; ///< (nv) the counterpart of each vertex
    std::vector<SurfacePoint> points;     ///< (half)
    geometry::Subdivision refinement;     ///< of body and eyes
    std::vector<Vec3f> base;              ///< refined base surface of that shape
};

/// The shape that the template is made from: between woman and man, fingers spread.
[[nodiscard]] BaseShape template_shape(const MakeHumanData& data);

/// Builds the template from that shape. Takes about half a minute. `coarseness` multiplies the
/// edges' length and is 1 in all that is shipped; tests of the training take more.
[[nodiscard]] AvatarTemplate make_avatar_template(const MakeHumanData& data,
                                                  float coarseness = 1.0f);

/// The shape that the template is made from: between woman and man, its fingers spread.
[[nodiscard]] ShapeRecipe template_recipe();

/// Carries shapes of the base mesh onto the template; made once, used for many shapes.
class ShapeCarrier {
  public:
    /// `smoothness` (half) per vertex: 0 follows the shape, larger values flatten its detail.
    /// \throw Error when the system cannot be factored
    ShapeCarrier(const AvatarTemplate& avatar, std::span<const float> smoothness);

    /// The template's vertices in that shape, symmetric, lowest on y = 0. (nv)
    [[nodiscard]] std::vector<Vec3f> carry(const BaseShape& shape) const;

    /// The linear part of it: what displacements of the base mesh (19158), metres, do to the
    /// template's first half. (half x 3)
    [[nodiscard]] Eigen::MatrixXd carry_offsets(std::span<const Vec3f> offsets) const;

  private:
    /// Template displacements that follow those of the refined base surface.
    [[nodiscard]] Eigen::MatrixXd follow(std::span<const Vec3f> refined_offsets) const;

    using Solver = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

    const AvatarTemplate& avatar_;
    Eigen::VectorXd follow_; ///< (half) how closely the surface beneath is followed
    Solver odd_, even_;      ///< for x, and for y and z
};

/// Umbrella Laplacian of the mesh's first `half` vertices as one half of a symmetric whole:
/// row v takes the mean of the neighbours, mirrored ones by their counterparts. (half x half)
/// For odd quantities (x coordinates) mirrored neighbours count with opposite sign.
[[nodiscard]] Eigen::SparseMatrix<double> half_laplacian(const AvatarTemplate& avatar, bool odd);

} // namespace toile::body
