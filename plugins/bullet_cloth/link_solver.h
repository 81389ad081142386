// Bullet's soft-body links as a position-based solver of springs. Nothing else of Bullet is used:
// its soft contact and self-collision do not hold (docs/decisions).
#pragma once

#include "bullet_cloth/cloth_model.h"
#include "cloth/moving_body.h"

#include <memory>

namespace toile::bullet_cloth {

using cloth::Vec4;

/// One garment's springs in a btSoftBody, solved by its serial Gauss-Seidel pass.
///
/// A link's denominator is set to w_a + w_b + 1 / (k h^2), so that one pass a substep is an
/// implicit (XPBD) step of a spring of k N/m: the stretch does not depend on the substeps.
class LinkSolver {
  public:
    /// `start` (nv) orders the pass from top to bottom; `inverse_mass` (nv) 1/kg, 0 = held.
    LinkSolver(std::span<const Vec3f> start, std::span<const float> inverse_mass,
               std::span<const Spring> stretch, std::span<const Spring> bend);
    ~LinkSolver();
    LinkSolver(LinkSolver&&) noexcept;
    LinkSolver& operator=(LinkSolver&&) noexcept;

    /// Length of the substeps that follow, seconds; cheap when unchanged.
    void set_substep(float seconds) noexcept;

    /// One pass over all links, in place. `positions` (nv)
    void solve(std::span<Vec4> positions) noexcept;

    [[nodiscard]] std::size_t link_count() const noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace toile::bullet_cloth
