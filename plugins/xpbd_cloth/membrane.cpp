#include "xpbd_cloth/membrane.h"

#include "xpbd_cloth/colouring.h"

#include <cmath>

namespace toile::xpbd_cloth {
namespace {

/// Inverse of the edges of a triangle in its material, and its area.
struct RestTriangle {
    float weft[2], warp[2];
};

RestTriangle rest_triangle(const ClothMesh& mesh, std::size_t t) {
    const std::array<Vec2f, 3> corner = cloth::material_corners(mesh, t);
    const Vec2f e1 = corner[1] - corner[0];
    const Vec2f e2 = corner[2] - corner[0];
    const float twice = e1.x() * e2.y() - e2.x() * e1.y();
    // Mirrored panels have a negative area: F is mirrored then, its columns' lengths are not.
    return {{e2.y() / twice, -e1.y() / twice}, {-e2.x() / twice, e1.x() / twice}};
}

} // namespace

template <class Index>
void Membrane::add_blocks(const ClothMesh& mesh, std::span<const std::uint32_t> order,
                          std::vector<Block<Index>>& blocks) const {
    const std::size_t nobody = mesh.positions.size();
    blocks.resize(order.size() / kLanes);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Block<Index>& block = blocks[i / kLanes];
        const std::size_t lane = i % kLanes;
        const bool empty = order[i] == kNoConstraint;
        const RestTriangle rest =
            empty ? RestTriangle{{1, 0}, {0, 1}} : rest_triangle(mesh, order[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            block.corner[k][lane] =
                static_cast<Index>(empty ? nobody : mesh.triangles[order[i]][k]);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            block.weft[k][lane] = rest.weft[k];
            block.warp[k][lane] = rest.warp[k];
        }
    }
}

Membrane::Membrane(const ClothMesh& mesh, const Fabric& fabric)
    : stiffness_u_(fabric.stretch_weft), stiffness_v_(fabric.stretch_warp),
      stiffness_s_(fabric.shear) {
    cloth::check_areas(mesh);
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : mesh.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    const std::size_t count = mesh.positions.size();
    const std::vector<std::uint32_t> order = coloured_order(corners, 3, count, kLanes);
    if (count < kSmallRows) {
        add_blocks(mesh, order, small_);
    } else {
        add_blocks(mesh, order, large_);
    }
}

template <class Index>
[[gnu::always_inline]] inline void Membrane::solve_block(const Block<Index>& block,
                                                         const Softness& soft, Vec4f* x) noexcept {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 one = _mm256_set1_ps(1.0f);
    const __m256 tiny = _mm256_set1_ps(1e-6f);
    Lanes4 p0 = load_rows4(x, block.corner[0]);
    Lanes4 p1 = load_rows4(x, block.corner[1]);
    Lanes4 p2 = load_rows4(x, block.corner[2]);
    const __m256 u1 = load(block.weft[0]);
    const __m256 u2 = load(block.weft[1]);
    const __m256 v1 = load(block.warp[0]);
    const __m256 v2 = load(block.warp[1]);
    // 1 / (2 A), without its sign: mirrored panels have a negative one.
    const __m256 per_area =
        _mm256_andnot_ps(_mm256_set1_ps(-0.0f), _mm256_fmsub_ps(u1, v2, _mm256_mul_ps(u2, v1)));

    // Weft, then warp: |F| - 1 along F.
    const auto stretch = [&](__m256 c1, __m256 c2, __m256 softness) __attribute__((always_inline)) {
        const Lanes3 f = blend(p1.xyz - p0.xyz, c1, p2.xyz - p0.xyz, c2);
        const __m256 length = _mm256_max_ps(_mm256_sqrt_ps(dot(f, f)), tiny);
        const __m256 c0 = _mm256_sub_ps(zero, _mm256_add_ps(c1, c2));
        const __m256 w0 = _mm256_mul_ps(p0.w, c0);
        const __m256 w1 = _mm256_mul_ps(p1.w, c1);
        const __m256 w2 = _mm256_mul_ps(p2.w, c2);
        const __m256 sum = _mm256_fmadd_ps(
            w0, c0,
            _mm256_fmadd_ps(w1, c1, _mm256_fmadd_ps(w2, c2, _mm256_mul_ps(softness, per_area))));
        const __m256 pull = _mm256_div_ps(_mm256_sub_ps(one, length), _mm256_mul_ps(length, sum));
        add(p1.xyz, _mm256_mul_ps(w1, pull), f);
        add(p2.xyz, _mm256_mul_ps(w2, pull), f);
        add(p0.xyz, _mm256_mul_ps(w0, pull), f);
    };
    stretch(u1, u2, soft.u);
    stretch(v1, v2, soft.v);

    // Shear: gradient of F_u . F_v.
    const Lanes3 e1 = p1.xyz - p0.xyz;
    const Lanes3 e2 = p2.xyz - p0.xyz;
    const Lanes3 fu = blend(e1, u1, e2, u2);
    const Lanes3 fv = blend(e1, v1, e2, v2);
    const Lanes3 g1 = blend(fv, u1, fu, v1);
    const Lanes3 g2 = blend(fv, u2, fu, v2);
    const Lanes3 g0 = g1 + g2;
    const __m256 sum = _mm256_fmadd_ps(
        p0.w, dot(g0, g0),
        _mm256_fmadd_ps(p1.w, dot(g1, g1),
                        _mm256_fmadd_ps(p2.w, dot(g2, g2), _mm256_mul_ps(soft.shear, per_area))));
    const __m256 pull = _mm256_sub_ps(zero, _mm256_div_ps(dot(fu, fv), sum));
    add(p1.xyz, _mm256_mul_ps(p1.w, pull), g1);
    add(p2.xyz, _mm256_mul_ps(p2.w, pull), g2);
    add(p0.xyz, _mm256_sub_ps(zero, _mm256_mul_ps(p0.w, pull)), g0);
    store_rows4(x, block.corner[0], p0);
    store_rows4(x, block.corner[1], p1);
    store_rows4(x, block.corner[2], p2);
}

void Membrane::solve(std::span<Vec4f> x) const noexcept {
    const auto softness = [&](float stiffness) {
        return _mm256_set1_ps(2.0f / (stiffness * substep_ * substep_));
    };
    const Softness soft{softness(stiffness_u_), softness(stiffness_v_), softness(stiffness_s_)};
    for (const Block<SmallIndex>& block : small_) {
        cloth::read_ahead(block);
        solve_block(block, soft, x.data());
    }
    for (const Block<std::uint32_t>& block : large_) {
        cloth::read_ahead(block);
        solve_block(block, soft, x.data());
    }
}

} // namespace toile::xpbd_cloth
