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

Membrane::Membrane(const ClothMesh& mesh, const Fabric& fabric, std::span<const float> inverse_mass)
    : stiffness_u_(fabric.stretch_weft), stiffness_v_(fabric.stretch_warp),
      stiffness_s_(fabric.shear) {
    cloth::check_areas(mesh);
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : mesh.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    const auto nobody = static_cast<std::uint32_t>(inverse_mass.size());
    const std::vector<std::uint32_t> order =
        coloured_order(corners, 3, inverse_mass.size(), kLanes);
    blocks_.resize(order.size() / kLanes);
    for (std::size_t i = 0; i < order.size(); ++i) {
        Block& block = blocks_[i / kLanes];
        const std::size_t lane = i % kLanes;
        const bool empty = order[i] == kNoConstraint;
        const RestTriangle rest =
            empty ? RestTriangle{{1, 0}, {0, 1}} : rest_triangle(mesh, order[i]);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = empty ? nobody : mesh.triangles[order[i]][k];
            block.corner[k][lane] = v;
            block.mass[k][lane] = empty ? 0.0f : inverse_mass[v];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            block.weft[k][lane] = rest.weft[k];
            block.warp[k][lane] = rest.warp[k];
        }
    }
}

void Membrane::set_substep(float seconds) noexcept {
    if (seconds == substep_) {
        return;
    }
    substep_ = seconds;
    const auto step = [](const float(&c)[2], const float(&w)[3], float compliance) {
        const float c0 = c[0] + c[1];
        const float sum = w[0] * c0 * c0 + w[1] * c[0] * c[0] + w[2] * c[1] * c[1];
        return sum > 0.0f ? 1.0f / (sum + compliance) : 0.0f;
    };
    for (Block& block : blocks_) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const float u[2] = {block.weft[0][l], block.weft[1][l]};
            const float v[2] = {block.warp[0][l], block.warp[1][l]};
            const float w[3] = {block.mass[0][l], block.mass[1][l], block.mass[2][l]};
            const float area = 0.5f / std::abs(u[0] * v[1] - u[1] * v[0]);
            const float softness = 1.0f / (area * seconds * seconds);
            block.step_u[l] = step(u, w, softness / stiffness_u_);
            block.step_v[l] = step(v, w, softness / stiffness_v_);
            block.compliance_s[l] = softness / stiffness_s_;
        }
    }
}

void Membrane::solve_block(const Block& block, Vec4f* x) noexcept {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 one = _mm256_set1_ps(1.0f);
    const __m256 tiny = _mm256_set1_ps(1e-6f);
    Lanes3 p0 = load_rows(x, block.corner[0]);
    Lanes3 p1 = load_rows(x, block.corner[1]);
    Lanes3 p2 = load_rows(x, block.corner[2]);
    const __m256 w0 = load(block.mass[0]);
    const __m256 w1 = load(block.mass[1]);
    const __m256 w2 = load(block.mass[2]);

    // Weft, then warp: |F| - 1 along F.
    const auto stretch = [&](__m256 c1, __m256 c2, __m256 step) {
        const Lanes3 f = blend(p1 - p0, c1, p2 - p0, c2);
        const __m256 length = _mm256_max_ps(_mm256_sqrt_ps(dot(f, f)), tiny);
        const __m256 pull = _mm256_mul_ps(step, _mm256_div_ps(_mm256_sub_ps(one, length), length));
        add(p1, _mm256_mul_ps(_mm256_mul_ps(w1, c1), pull), f);
        add(p2, _mm256_mul_ps(_mm256_mul_ps(w2, c2), pull), f);
        const __m256 c0 = _mm256_sub_ps(zero, _mm256_add_ps(c1, c2));
        add(p0, _mm256_mul_ps(_mm256_mul_ps(w0, c0), pull), f);
    };
    const __m256 u1 = load(block.weft[0]);
    const __m256 u2 = load(block.weft[1]);
    const __m256 v1 = load(block.warp[0]);
    const __m256 v2 = load(block.warp[1]);
    stretch(u1, u2, load(block.step_u));
    stretch(v1, v2, load(block.step_v));

    // Shear: gradient of F_u . F_v.
    const Lanes3 e1 = p1 - p0;
    const Lanes3 e2 = p2 - p0;
    const Lanes3 fu = blend(e1, u1, e2, u2);
    const Lanes3 fv = blend(e1, v1, e2, v2);
    const Lanes3 g1 = blend(fv, u1, fu, v1);
    const Lanes3 g2 = blend(fv, u2, fu, v2);
    const Lanes3 g0 = {_mm256_add_ps(g1.x, g2.x), _mm256_add_ps(g1.y, g2.y),
                       _mm256_add_ps(g1.z, g2.z)};
    const __m256 sum = _mm256_fmadd_ps(
        w0, dot(g0, g0),
        _mm256_fmadd_ps(w1, dot(g1, g1),
                        _mm256_fmadd_ps(w2, dot(g2, g2), load(block.compliance_s))));
    const __m256 pull =
        _mm256_sub_ps(zero, _mm256_div_ps(dot(fu, fv), _mm256_max_ps(sum, _mm256_set1_ps(1e-12f))));
    add(p1, _mm256_mul_ps(w1, pull), g1);
    add(p2, _mm256_mul_ps(w2, pull), g2);
    add(p0, _mm256_sub_ps(zero, _mm256_mul_ps(w0, pull)), g0);
    store_rows(x, block.corner[0], p0);
    store_rows(x, block.corner[1], p1);
    store_rows(x, block.corner[2], p2);
}

void Membrane::solve(std::span<Vec4f> x) const noexcept {
    for (const Block& block : blocks_) {
        solve_block(block, x.data());
    }
}

} // namespace toile::xpbd_cloth
