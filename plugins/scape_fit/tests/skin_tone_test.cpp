// Which colours are a person's skin.
#include "scape_fit/skin_tone.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace toile::scape_fit {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

/// A face of a colour, with some noise.
std::vector<Vec2f> face_of(const Rgb& color, std::size_t count, double noise) {
    Random random(3);
    std::vector<Vec2f> out;
    for (std::size_t i = 0; i < count; ++i) {
        Rgb seen{};
        for (std::size_t c = 0; c < 3; ++c)
            seen[c] = static_cast<std::uint8_t>(
                std::lround(std::clamp(color[c] + noise * random.normal(), 0.0, 255.0)));
        out.push_back(hue_of(seen.data()));
    }
    return out;
}

TEST(SkinTone, AHueHardlyChangesWithLight) {
    const Rgb bright{220, 170, 140}, dim{122, 93, 76}; // 0.29 of the light
    const Vec2f off = hue_of(bright.data()) - hue_of(dim.data());
    EXPECT_LT(off.norm(), 0.03f);
    EXPECT_FALSE(hue_of(Rgb{255, 240, 230}.data()).allFinite()); // burnt out
    EXPECT_FALSE(hue_of(Rgb{20, 10, 6}.data()).allFinite());
}

TEST(SkinTone, SkinOfAllShadesIsToldFromCloth) {
    for (const Rgb& skin : {Rgb{228, 185, 160}, Rgb{190, 135, 100}, Rgb{110, 70, 50}}) {
        const auto tone = SkinTone::learn(face_of(skin, 400, 4.0));
        ASSERT_TRUE(tone);
        EXPECT_LT((tone->hue() - hue_of(skin.data())).norm(), 0.04f);
        Rgb shaded = skin;
        for (auto& c : shaded)
            c = static_cast<std::uint8_t>(c * 3 / 4);
        EXPECT_TRUE(tone->like(hue_of(shaded.data())));
        for (const Rgb& cloth :
             {Rgb{200, 200, 200}, Rgb{60, 80, 140}, Rgb{150, 40, 45}, Rgb{70, 70, 70}})
            EXPECT_FALSE(tone->like(hue_of(cloth.data()))) << int{cloth[0]};
    }
}

TEST(SkinTone, NothingIsLearnedFromWhatIsNoFace) {
    EXPECT_FALSE(SkinTone::learn(face_of({228, 185, 160}, 20, 4.0))); // too little
    EXPECT_FALSE(SkinTone::learn(face_of({60, 90, 160}, 400, 4.0)));  // a mask
    auto half = face_of({228, 185, 160}, 200, 4.0);
    const auto scarf = face_of({200, 60, 60}, 210, 4.0);
    half.insert(half.end(), scarf.begin(), scarf.end());
    EXPECT_FALSE(SkinTone::learn(half));
    // A grey mannequin in warm light: white cloth looks the same.
    EXPECT_FALSE(SkinTone::learn(face_of({200, 194, 184}, 400, 4.0)));
    EXPECT_FALSE(SkinTone::learn({}));
}

} // namespace
} // namespace toile::scape_fit
