#include "scape_fit/skin_tone.h"

#include "imaging/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace toile::scape_fit {
namespace {

constexpr float kDarkest = 0.01f, kBrightest = 0.97f; // linear light
constexpr std::size_t kFewest = 60;                   // pixels of a face
constexpr float kMostSpread = 0.25f;                  // of a face's hues
constexpr float kLeastReach = 0.12f;                  // of one skin: blood, tan, shade
constexpr float kPaintReach = 0.05f;                  // of a mannequin's
constexpr float kMostReach = 0.25f;
constexpr float kReachBySpread = 3.0f;
// Skin of all people, with room for the light of lamps: red well above green, green above blue. A
// grey mannequin is none.
constexpr std::array<float, 2> kRed{0.2f, 1.5f}, kBlue{-1.6f, 0.05f};

float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

Vec2f hue_of(const std::uint8_t* srgb) {
    std::array<float, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) {
        light[c] = imaging::linear_from_srgb(static_cast<float>(srgb[c]) / 255.0f);
        if (light[c] < kDarkest || light[c] > kBrightest)
            return Vec2f::Constant(std::numeric_limits<float>::quiet_NaN());
    }
    return {std::log(light[0] / light[1]), std::log(light[2] / light[1])};
}

std::optional<SkinTone> SkinTone::learn(std::span<const Vec2f> face, bool of_mannequins) {
    std::vector<float> red, blue;
    for (const Vec2f& hue : face) {
        if (!hue.allFinite()) continue;
        red.push_back(hue.x());
        blue.push_back(hue.y());
    }
    if (red.size() < kFewest) return std::nullopt;
    SkinTone out;
    out.hue_ = {median(red), median(blue)};
    std::vector<float> off;
    off.reserve(red.size());
    for (std::size_t i = 0; i < red.size(); ++i)
        off.push_back((Vec2f(red[i], blue[i]) - out.hue_).norm());
    const float spread = median(std::move(off));
    const auto within = [](float v, const std::array<float, 2>& range) {
        return v >= range[0] && v <= range[1];
    };
    const bool human = within(out.hue_.x(), kRed) && within(out.hue_.y(), kBlue);
    if (spread > kMostSpread || !(human || of_mannequins)) return std::nullopt;
    out.reach_ = std::clamp(kReachBySpread * spread,
                            human && !of_mannequins ? kLeastReach : kPaintReach, kMostReach);
    return out;
}

bool SkinTone::like(const Vec2f& hue) const {
    return (hue - hue_).norm() < reach_;
}

} // namespace toile::scape_fit
