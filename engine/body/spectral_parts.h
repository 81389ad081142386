// Parts of a person by the lowest Laplace-Beltrami eigenvectors: the same in every pose (P3 3.3,
// 4).
#pragma once

#include "geometry/mesh.h"

namespace toile::body {

/// In the order of their numbers everywhere. Left and right are the person's who faces +Z.
enum class SpectralPart : std::uint8_t {
    invalid,
    head_and_chest,
    abdomen, ///< from the crotch to below the bust
    left_arm,
    left_hand, ///< from about the elbow on
    right_arm,
    right_hand,
    left_thigh,
    left_foot, ///< from about the knee on
    right_thigh,
    right_foot,
};
inline constexpr std::size_t kSpectralPartCount = 11; ///< with `invalid`

struct SpectralParts {
    std::vector<SpectralPart> of; ///< (nv)
    Eigen::MatrixXd axes;         ///< (nv x 3) up, legs, arms: see below; mean square 1
    Eigen::Vector3d values = Eigen::Vector3d::Zero(); ///< their eigenvalues, 1/m^2
    int rounds = 0;                                   ///< of the clustering
};

/// Eigenvectors 2, 3 and 4 of a closed surface of one person, arms and legs free of each other on
/// the mesh, who stands (+Y up). Which is which is told by what they do, not by their order, which
/// changes from body to body: "up" goes with height; of the other two "legs" is large where "up"
/// is low, "arms" where it is high; both rise towards the left. k-means in their space starts from
/// fixed places, so that numbers of parts mean the same on every body.
/// \throw Error when the surface has no such eigenvectors: no person, limbs grown together
[[nodiscard]] SpectralParts spectral_parts(const geometry::TriangleMesh& mesh);

/// Share of the area that two sets of vertices have in common, of what either has.
[[nodiscard]] double overlap(const std::vector<SpectralPart>& a, const std::vector<SpectralPart>& b,
                             SpectralPart part, const Eigen::VectorXd& areas);

} // namespace toile::body
