#include "apps/kiosk/light.h"

#include "imaging/srgb.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

constexpr float kReflected = 0.34f; // of a room on the whole
constexpr float kWhite = 0.97f;     // sRGB from which a value counts as clipped
constexpr std::size_t kFewest = 60;
constexpr std::size_t kGroups = 16;
const Vec3f kLuminance(0.2126f, 0.7152f, 0.0722f);

const std::array<float, 256>& linear_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = imaging::linear_from_srgb(static_cast<float>(i) / 255.0f);
        return made;
    }();
    return table;
}

// One group's luminance as a + b . n; false when its places do not tell.
bool fit_group(std::span<const LitPlace> places, std::uint8_t group, Eigen::Vector4f& out,
               float& weight) {
    Eigen::Matrix4f normal = Eigen::Matrix4f::Zero();
    Eigen::Vector4f right = Eigen::Vector4f::Zero();
    std::size_t count = 0;
    for (const LitPlace& place : places) {
        const float y = place.color.dot(kLuminance);
        if (place.group != group || y > 0.9f || y <= 0.0f) continue;
        const Eigen::Vector4f row(1.0f, place.normal.x(), place.normal.y(), place.normal.z());
        normal += row * row.transpose();
        right += row * y;
        ++count;
    }
    if (count < kFewest / 2) return false;
    // All normals look towards the camera: what they do not tell apart stays small.
    normal.diagonal().tail<3>().array() += 0.02f * static_cast<float>(count);
    out = normal.ldlt().solve(right);
    weight = static_cast<float>(count);
    return out.allFinite() && out[0] > 1e-4f;
}

} // namespace

PictureTone picture_tone(const imaging::Image& picture) {
    PictureTone out;
    if (picture.width < 16 || picture.height < 16) return out;
    const std::array<float, 256>& linear = linear_table();
    const auto width = static_cast<std::size_t>(picture.width);
    Vec3f sum = Vec3f::Zero();
    std::size_t count = 0;
    std::size_t clipped = 0;
    std::array<std::uint32_t, 64> steps{}; // of sRGB between neighbours
    for (std::size_t y = 2; y + 2 < static_cast<std::size_t>(picture.height); y += 5)
        for (std::size_t x = 2; x + 2 < width; x += 5) {
            const std::uint8_t* p = picture.pixels.data() + 4 * (y * width + x);
            const Vec3f c(linear[p[0]], linear[p[1]], linear[p[2]]);
            const bool white = std::max({p[0], p[1], p[2]}) >= kWhite * 255.0f;
            clipped += white ? 1 : 0;
            sum += c;
            ++count;
            const int step = std::abs(2 * p[1] - p[1 - 8] - p[1 + 8]);
            ++steps[static_cast<std::size_t>(std::min(step, 63))];
        }
    const Vec3f mean = sum / static_cast<float>(count);
    const float y = std::max(mean.dot(kLuminance), 1e-4f);
    out.level = std::clamp(y / kReflected, 0.02f, 1.2f);
    out.tint = (0.5f * (mean / y) + Vec3f::Constant(0.5f)).cwiseMax(0.6f).cwiseMin(1.5f);
    out.tint /= out.tint.mean();
    out.clipped = static_cast<float>(clipped) / static_cast<float>(count);
    // 35 % of |a - 2b + c| of noise alone are below 1.11 of its standard deviation; what lies above
    // may be the room's own pattern.
    std::size_t below = 0;
    std::size_t quantile = 0;
    while (quantile < steps.size() && (below += steps[quantile]) * 20 < 7 * count)
        ++quantile;
    out.noise = static_cast<float>(quantile) / 1.11f / 255.0f;
    return out;
}

PictureLight estimate_light(std::span<const LitPlace> places, const PictureTone& tone,
                            const PictureLight& before) {
    PictureLight out = before;
    out.level = tone.level;
    out.tint = tone.tint;
    if (places.size() < kFewest) return out;
    Vec3f gradient = Vec3f::Zero();
    float total = 0.0f;
    for (std::size_t group = 0; group < kGroups; ++group) {
        Eigen::Vector4f fit;
        float weight = 0.0f;
        if (!fit_group(places, static_cast<std::uint8_t>(group), fit, weight)) continue;
        gradient += weight * fit.tail<3>() / fit[0];
        total += weight;
    }
    if (total <= 0.0f) return out;
    gradient /= total;
    const float contrast = gradient.norm();
    if (contrast < 0.02f) return out;
    out.direction = gradient / contrast;
    out.contrast = std::min(contrast, 0.95f);
    return out;
}

PictureLight blended(const PictureLight& now, const PictureLight& seen, float share) {
    PictureLight out;
    const Vec3f direction = (1.0f - share) * now.direction + share * seen.direction;
    out.direction = direction.norm() > 1e-3f ? direction.normalized() : seen.direction;
    out.contrast = (1.0f - share) * now.contrast + share * seen.contrast;
    out.level = (1.0f - share) * now.level + share * seen.level;
    out.tint = (1.0f - share) * now.tint + share * seen.tint;
    return out;
}

render::Lighting lighting_of(const PictureLight& light) {
    // max(0, d . n) is 1/4 + (d . n) / 2 in its first two bands, so key = 2 b and the rest of a is
    // the surroundings'.
    const Vec3f level = light.level * light.tint;
    const float key = std::min(2.0f * light.contrast, 1.6f);
    const float around = std::max(1.0f - 0.25f * key, 0.15f);
    render::Lighting out;
    out.key_direction = light.direction;
    out.key_color = key * level;
    out.key_size = 0.45f;
    out.fill_color = Vec3f::Zero();
    out.rim_color = Vec3f::Zero();
    out.sky = 1.12f * around * level;
    out.ground = 0.88f * around * level;
    return out;
}

} // namespace toile::apps::kiosk
