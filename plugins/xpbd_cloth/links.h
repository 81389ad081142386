// Pairs of vertices: seams (of rest length zero) and longest distances along the cloth.
#pragma once

#include "xpbd_cloth/bending.h"

namespace toile::xpbd_cloth {

/// Two vertices and how far apart they are at rest or at most.
struct Link {
    std::uint32_t a, b;
    float length; ///< m
};

/// Distance constraints of one stiffness, eight of one colour at a time. One-sided ones act only
/// when too long.
class Links {
  public:
    /// `vertex_count` of the garment; `stiffness` N/m, infinite: a hard limit
    Links(std::span<const Link> links, std::size_t vertex_count, float stiffness, bool one_sided);

    void set_substep(float seconds) noexcept { substep_ = seconds; }
    /// One pass over the rows of membrane.h.
    void solve(std::span<Vec4f> x) const noexcept;

  private:
    template <class Index>
    struct alignas(16) Block {
        Index end[2][kLanes];
        float length[kLanes]; ///< m
    };
    template <class Index>
    void solve_blocks(std::span<const Block<Index>> blocks, Vec4f* x) const noexcept;

    std::vector<Block<SmallIndex>> small_;
    std::vector<Block<std::uint32_t>> large_;
    float softness_; ///< m/N
    bool one_sided_;
    float substep_ = 1.0f; ///< s
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
