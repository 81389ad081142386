// In-plane stretch of a woven sheet: warp, weft and shear of every triangle.
#pragma once

#include "cloth/lanes.h"
#include "cloth/sheet.h"

namespace toile::xpbd_cloth {

using cloth::ClothMesh;
using cloth::Fabric;
using cloth::kLanes;
using cloth::Lanes3;
using cloth::Lanes4;
using cloth::load;
using cloth::load_rows4;
using cloth::store_rows4;

/// Constraints of each kind move the rows `x` (nv + 1) of a garment: x y z, and in w the inverse
/// mass (1/kg, 0 = held), so that it comes with the position. The last row stands for the empty
/// places of a group; its w is 0. A garment of at most so many rows has small indices, since the
/// constraints are read in every substep and reading them is what that costs.
inline constexpr std::size_t kSmallRows = 65536;
using SmallIndex = std::uint16_t;

/// Constant-strain triangles as compliant constraints (Macklin et al. 2016, eq. 18, one iteration
/// a substep): with F = [x1 - x0, x2 - x0] Dm^-1, columns F_u along the weft and F_v along the
/// warp,
///     C_u = |F_u| - 1,  C_v = |F_v| - 1,  C_s = F_u . F_v
/// of compliance 1 / (A K_weft), 1 / (A K_warp), 1 / (A G). Eight triangles of one colour at a
/// time.
class Membrane {
  public:
    /// \throw Error for a triangle without area in its material coordinates
    Membrane(const ClothMesh& mesh, const Fabric& fabric);

    void set_substep(float seconds) noexcept { substep_ = seconds; }
    /// One pass.
    void solve(std::span<Vec4f> x) const noexcept;

  private:
    /// Eight triangles.
    template <class Index>
    struct alignas(16) Block {
        Index corner[3][kLanes];
        float weft[2][kLanes]; ///< 1/m, F_u = e1 weft[0] + e2 weft[1]
        float warp[2][kLanes]; ///< 1/m
    };
    /// 1/(N m s^2) times m^2: over a triangle's area it is compliance / h^2.
    struct Softness {
        __m256 u, v, shear;
    };
    template <class Index>
    static void solve_block(const Block<Index>& block, const Softness& soft, Vec4f* x) noexcept;
    template <class Index>
    void add_blocks(const ClothMesh& mesh, std::span<const std::uint32_t> order,
                    std::vector<Block<Index>>& blocks) const;

    std::vector<Block<SmallIndex>> small_;
    std::vector<Block<std::uint32_t>> large_;
    float stiffness_u_, stiffness_v_, stiffness_s_; ///< N/m
    float substep_ = 1.0f;                          ///< s
};

} // namespace toile::xpbd_cloth
