// In-plane stretch of a woven sheet: warp, weft and shear of every triangle.
#pragma once

#include "cloth/lanes.h"
#include "cloth/sheet.h"

namespace toile::xpbd_cloth {

using cloth::ClothMesh;
using cloth::Fabric;
using cloth::kLanes;
using cloth::Lanes3;
using cloth::load;
using cloth::load_rows;
using cloth::store_rows;

/// Constant-strain triangles as compliant constraints (Macklin et al. 2016, eq. 18, one iteration
/// a substep): with F = [x1 - x0, x2 - x0] Dm^-1, columns F_u along the weft and F_v along the
/// warp,
///     C_u = |F_u| - 1,  C_v = |F_v| - 1,  C_s = F_u . F_v
/// of compliance 1 / (A K_weft), 1 / (A K_warp), 1 / (A G). Eight triangles of one colour at a
/// time.
class Membrane {
  public:
    /// `inverse_mass` (nv) 1/kg, 0 = held.
    /// \throw Error for a triangle without area in its material coordinates
    Membrane(const ClothMesh& mesh, const Fabric& fabric, std::span<const float> inverse_mass);

    void set_substep(float seconds) noexcept;
    /// One pass. `x` (nv + 1): the last row stands for the empty places of a group.
    void solve(std::span<Vec4f> x) const noexcept;

  private:
    /// Eight triangles.
    struct alignas(32) Block {
        std::uint32_t corner[3][kLanes];
        float mass[3][kLanes];                ///< 1/kg
        float weft[2][kLanes];                ///< 1/m, F_u = e1 weft[0] + e2 weft[1]
        float warp[2][kLanes];                ///< 1/m
        float step_u[kLanes], step_v[kLanes]; ///< 1 / (sum of w |grad C|^2 + compliance / h^2)
        float compliance_s[kLanes];           ///< 1/(N m) / h^2
    };
    static void solve_block(const Block& block, Vec4f* x) noexcept;

    std::vector<Block> blocks_;
    float stiffness_u_, stiffness_v_, stiffness_s_; ///< N/m
    float substep_ = 0.0f;
};

} // namespace toile::xpbd_cloth
