#include "xpbd_cloth/links.h"

#include "xpbd_cloth/colouring.h"

#include <algorithm>
#include <cmath>

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

} // namespace

Links::Links(std::span<const Link> links, std::span<const float> inverse_mass, bool one_sided)
    : one_sided_(one_sided) {
    const auto nobody = static_cast<std::uint32_t>(inverse_mass.size());
    const std::vector<std::uint32_t> order =
        coloured_order(ends_of(links), 2, inverse_mass.size(), kLanes);
    blocks_.resize(order.size() / kLanes);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Block& block = blocks_[i / kLanes];
        const std::size_t lane = i % kLanes;
        const bool empty = order[i] == kNoConstraint;
        const Link link = empty ? Link{nobody, nobody, 1.0f, 0.0f} : links[order[i]];
        block.end[0][lane] = link.a;
        block.end[1][lane] = link.b;
        block.mass[0][lane] = empty ? 0.0f : inverse_mass[link.a];
        block.mass[1][lane] = empty ? 0.0f : inverse_mass[link.b];
        block.length[lane] = link.length;
        block.soft[lane] = link.stiffness > 0.0f ? 1.0f / link.stiffness : 0.0f;
    }
}

void Links::set_substep(float seconds) noexcept {
    if (seconds == substep_) {
        return;
    }
    substep_ = seconds;
    for (Block& block : blocks_) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const float sum = block.mass[0][l] + block.mass[1][l];
            block.step[l] = sum > 0.0f ? 1.0f / (sum + block.soft[l] / (seconds * seconds)) : 0.0f;
        }
    }
}

void Links::solve(std::span<Vec4f> x) const noexcept {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 tiny = _mm256_set1_ps(1e-9f);
    for (const Block& block : blocks_) {
        Lanes3 a = load_rows(x.data(), block.end[0]);
        Lanes3 b = load_rows(x.data(), block.end[1]);
        const Lanes3 apart = b - a;
        const __m256 rest = load(block.length);
        const __m256 squared = dot(apart, apart);
        if (one_sided_ && _mm256_movemask_ps(
                              _mm256_cmp_ps(squared, _mm256_mul_ps(rest, rest), _CMP_GT_OQ)) == 0) {
            continue;
        }
        const __m256 length = _mm256_max_ps(_mm256_sqrt_ps(squared), tiny);
        __m256 excess = _mm256_sub_ps(length, rest);
        excess = one_sided_ ? _mm256_max_ps(excess, zero) : excess;
        const __m256 pull = _mm256_mul_ps(load(block.step), _mm256_div_ps(excess, length));
        add(a, _mm256_mul_ps(load(block.mass[0]), pull), apart);
        add(b, _mm256_sub_ps(zero, _mm256_mul_ps(load(block.mass[1]), pull)), apart);
        store_rows(x.data(), block.end[0], a);
        store_rows(x.data(), block.end[1], b);
    }
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
