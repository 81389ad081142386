// Bending over every inner edge, from the angle between its two triangles.
#pragma once

#include "cloth/length_limits.h"
#include "xpbd_cloth/membrane.h"

namespace toile::xpbd_cloth {

/// A flat sheet of rigidity B folded by theta about an edge of length l between triangles of areas
/// A1 and A2 stores B l^2 / (2 (A1 + A2)) theta^2: then it bends as the continuum does (Seung and
/// Nelson 1988; the factor 3 of the mean-curvature energy of Bergou et al. 2006 belongs to folds
/// along all three edges of a triangle and is three times too stiff for a cylinder). For cloth,
/// which keeps its lengths, that is quadratic in the positions, with the cotangent weights of
/// Bergou's paper:
///     C = sum_i k_i x_i  (a vector, of length l theta for small angles), compliance (A1 + A2) / B.
/// Its gradient does not change, so a hinge costs four rows, one dot product and no root.
class Bending {
  public:
    /// `inverse_mass` (nv) 1/kg, 0 = held.
    Bending(const ClothMesh& mesh, const Fabric& fabric, std::span<const float> inverse_mass);

    void set_substep(float seconds) noexcept;
    /// One pass over the rows of membrane.h.
    void solve(std::span<Vec4f> x) const noexcept;

    [[nodiscard]] std::size_t hinge_count() const noexcept { return softness_.size(); }

  private:
    template <class Index>
    struct Hinge {
        Index vertex[4]; ///< the edge's ends, then those opposite
        float k[3];      ///< of all but the first; all four sum to 0
        float step;      ///< 1 / (sum of w k^2 + compliance / h^2)
    };
    struct Softness {
        float sum;        ///< of w k^2, 1/kg
        float compliance; ///< 1/(N m)
    };
    template <class Index>
    static void solve_hinge(const Hinge<Index>& hinge, Vec4f* x) noexcept;

    std::vector<Hinge<SmallIndex>> small_;
    std::vector<Hinge<std::uint32_t>> large_;
    std::vector<Softness> softness_; ///< of each hinge
    float substep_ = 0.0f;
};

/// The mesh's edges, each once, a < b, in order of a and b.
struct Edge {
    std::uint32_t a, b;
    float rest;  ///< m, of the material
    bool border; ///< of one triangle only
};
[[nodiscard]] std::vector<Edge> material_edges(const ClothMesh& mesh);
/// The edges, and the straight ways across each between the corners opposite it.
[[nodiscard]] std::vector<cloth::MaterialPath> material_paths(const ClothMesh& mesh);

} // namespace toile::xpbd_cloth
