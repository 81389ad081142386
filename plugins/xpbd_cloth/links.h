// Pairs of vertices: seams (of rest length zero) and longest distances along the cloth.
#pragma once

#include "xpbd_cloth/bending.h"

namespace toile::xpbd_cloth {

/// Two vertices and how far apart they are at rest or at most.
struct Link {
    std::uint32_t a, b;
    float length;    ///< m
    float stiffness; ///< N/m; 0: a hard limit
};

/// Distance constraints, eight of one colour at a time. One-sided ones act only when too long.
class Links {
  public:
    Links(std::span<const Link> links, std::span<const float> inverse_mass, bool one_sided);

    void set_substep(float seconds) noexcept;
    /// One pass. `x` (nv + 1): the last row stands for the empty places of a group.
    void solve(std::span<Vec4f> x) const noexcept;
    [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }

  private:
    struct alignas(32) Block {
        std::uint32_t end[2][kLanes];
        float mass[2][kLanes]; ///< 1/kg
        float length[kLanes];  ///< m
        float soft[kLanes];    ///< m/N
        float step[kLanes];    ///< 1 / (w_a + w_b + soft / h^2), or 0
    };
    std::vector<Block> blocks_;
    bool one_sided_;
    float substep_ = 0.0f;
};

/// Neighbours lose a share of their relative velocity; momentum is kept. One row at a time.
class VelocityDamping {
  public:
    VelocityDamping(std::span<const Edge> edges, std::span<const float> inverse_mass);
    void apply(std::span<Vec4f> v, float share) const noexcept;

  private:
    struct Pair {
        std::uint32_t a, b;
        float share_a, share_b; ///< w / (w_a + w_b)
    };
    std::vector<Pair> pairs_;
};

} // namespace toile::xpbd_cloth
