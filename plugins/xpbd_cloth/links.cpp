#include "xpbd_cloth/links.h"

#include "xpbd_cloth/colouring.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace toile::xpbd_cloth {
namespace {

template <class Pairs>
std::vector<std::uint32_t> ends_of(const Pairs& pairs) {
    std::vector<std::uint32_t> ends;
    for (const auto& pair : pairs) {
        ends.insert(ends.end(), {pair.a, pair.b});
    }
    return ends;
}

/// Eight links of `order` to a block; empty places hold the row after the last one.
template <class Block>
std::vector<Block> blocks_of(std::span<const Link> links, std::span<const std::uint32_t> order,
                             std::size_t nobody) {
    using Index = std::remove_all_extents_t<decltype(Block::end)>;
    std::vector<Block> blocks(order.size() / kLanes);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Block& block = blocks[i / kLanes];
        const std::size_t lane = i % kLanes;
        const bool empty = order[i] == kNoConstraint;
        block.end[0][lane] = static_cast<Index>(empty ? nobody : links[order[i]].a);
        block.end[1][lane] = static_cast<Index>(empty ? nobody : links[order[i]].b);
        block.length[lane] = empty ? 1.0f : links[order[i]].length;
    }
    return blocks;
}

} // namespace

Links::Links(std::span<const Link> links, std::size_t vertex_count, float stiffness, bool one_sided)
    : softness_(1.0f / stiffness), one_sided_(one_sided) {
    const std::vector<std::uint32_t> order =
        coloured_order(ends_of(links), 2, vertex_count, kLanes);
    if (vertex_count < kSmallRows) {
        small_ = blocks_of<Block<SmallIndex>>(links, order, vertex_count);
    } else {
        large_ = blocks_of<Block<std::uint32_t>>(links, order, vertex_count);
    }
}

template <class Index>
void Links::solve_blocks(std::span<const Block<Index>> blocks, Vec4f* x) const noexcept {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 tiny = _mm256_set1_ps(1e-9f);
    // At least a little, for two that are held.
    const __m256 soft = _mm256_set1_ps(std::max(softness_ / (substep_ * substep_), 1e-6f));
    for (const Block<Index>& block : blocks) {
        cloth::read_ahead(block);
        Lanes4 a = load_rows4(x, block.end[0]);
        Lanes4 b = load_rows4(x, block.end[1]);
        const Lanes3 apart = b.xyz - a.xyz;
        const __m256 rest = load(block.length);
        const __m256 squared = dot(apart, apart);
        if (one_sided_ && _mm256_movemask_ps(
                              _mm256_cmp_ps(squared, _mm256_mul_ps(rest, rest), _CMP_GT_OQ)) == 0) {
            continue;
        }
        const __m256 length = _mm256_max_ps(_mm256_sqrt_ps(squared), tiny);
        __m256 excess = _mm256_sub_ps(length, rest);
        excess = one_sided_ ? _mm256_max_ps(excess, zero) : excess;
        const __m256 sum = _mm256_add_ps(_mm256_add_ps(a.w, b.w), soft);
        const __m256 pull = _mm256_div_ps(excess, _mm256_mul_ps(length, sum));
        add(a.xyz, _mm256_mul_ps(a.w, pull), apart);
        add(b.xyz, _mm256_sub_ps(zero, _mm256_mul_ps(b.w, pull)), apart);
        store_rows4(x, block.end[0], a);
        store_rows4(x, block.end[1], b);
    }
}

void Links::solve(std::span<Vec4f> x) const noexcept {
    solve_blocks<SmallIndex>(small_, x.data());
    solve_blocks<std::uint32_t>(large_, x.data());
}

VelocityDamping::VelocityDamping(std::span<const Edge> edges, std::span<const float> inverse_mass) {
    for (const std::uint32_t e : coloured_order(ends_of(edges), 2, inverse_mass.size(), 1)) {
        const float a = inverse_mass[edges[e].a];
        const float b = inverse_mass[edges[e].b];
        if (a + b > 0.0f) {
            pairs_.push_back({edges[e].a, edges[e].b, a / (a + b), b / (a + b)});
        }
    }
}

void VelocityDamping::apply(std::span<Vec4f> v, float share) const noexcept {
    for (const Pair& pair : pairs_) {
        const Vec4f change = share * (v[pair.b] - v[pair.a]);
        v[pair.a] += pair.share_a * change;
        v[pair.b] -= pair.share_b * change;
    }
}

} // namespace toile::xpbd_cloth
