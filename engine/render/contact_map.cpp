#include "render/contact_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::render {
namespace {

constexpr float kHighest = 0.7f;
constexpr float kMargin = 0.35f;

} // namespace

void ContactMap::begin(const Box& box) noexcept {
    const Vec3f low = box.empty() ? Vec3f::Constant(-0.5f) : box.low;
    const Vec3f high = box.empty() ? Vec3f::Constant(0.5f) : box.high;
    // A fixed set of sizes and corners, so that the cells stay put while the subject moves a
    // little.
    const float extent = std::max(high.x() - low.x(), high.z() - low.z()) + 2.0f * kMargin;
    size_ = 0.4f * std::ceil(extent / 0.4f + 0.5f);
    x_ = 0.2f * std::round((0.5f * (low.x() + high.x()) - 0.5f * size_) / 0.2f);
    z_ = 0.2f * std::round((0.5f * (low.z() + high.z()) - 0.5f * size_) / 0.2f);
    heights_.fill(kHighest);
}

void ContactMap::put(const Vec3f& p) noexcept {
    const float cell = size_ / kSide;
    const int i = static_cast<int>(std::floor((p.x() - x_) / cell));
    const int j = static_cast<int>(std::floor((p.z() - z_) / cell));
    if (i < 0 || j < 0 || i >= kSide || j >= kSide) return;
    float& height = heights_[static_cast<std::size_t>(j * kSide + i)];
    height = std::min(height, std::max(p.y(), 0.0f));
}

void ContactMap::add(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                     const RigidTransform& world_from_mesh) noexcept {
    const float spacing = 0.7f * size_ / kSide;
    for (const Triangle& t : triangles) {
        const Vec3f a = world_from_mesh * positions[t[0]];
        const Vec3f b = world_from_mesh * positions[t[1]];
        const Vec3f c = world_from_mesh * positions[t[2]];
        if (std::min({a.y(), b.y(), c.y()}) >= kHighest) continue;
        const float longest = std::sqrt(
            std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
        const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 128);
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                const float u = static_cast<float>(i) / static_cast<float>(n);
                const float v = static_cast<float>(j) / static_cast<float>(n);
                put(a + u * (b - a) + v * (c - a));
            }
        }
    }
}

std::span<const float> ContactMap::finish() noexcept {
    lost_.fill(0.0f);
    const float cell = size_ / kSide;
    const float area = cell * cell;
    const float own2 = area / std::numbers::pi_v<float>; // so that a disc on the floor hides it all
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            const float height = heights_[static_cast<std::size_t>(j * kSide + i)];
            if (height >= kHighest) continue;
            const float h2 = height * height + own2;
            const float fade = 1.0f - height / kHighest;
            const int reach = std::min(kSide, static_cast<int>(3.0f * std::sqrt(h2) / cell) + 1);
            for (int y = std::max(0, j - reach); y <= std::min(kSide - 1, j + reach); ++y) {
                for (int x = std::max(0, i - reach); x <= std::min(kSide - 1, i + reach); ++x) {
                    const auto dx = static_cast<float>(x - i) * cell;
                    const auto dy = static_cast<float>(y - j) * cell;
                    const float s2 = dx * dx + dy * dy + h2;
                    lost_[static_cast<std::size_t>(y * kSide + x)] +=
                        fade * area * h2 / (std::numbers::pi_v<float> * s2 * s2);
                }
            }
        }
    }
    for (float& value : lost_)
        value = std::min(value, 1.0f);
    return lost_;
}

} // namespace toile::render
