#include "imaging/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace toile::imaging {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr float kFocal = 145.0f;

struct Noisy {
    std::vector<std::uint16_t> mm;
    std::vector<std::uint32_t> source;
};

/// A wall, with a block of 40 x 40 pixels before it when `near_mm` is not 0.
std::vector<std::uint16_t> scene(std::uint16_t far_mm, std::uint16_t near_mm) {
    std::vector<std::uint16_t> mm(kWidth * kHeight, far_mm);
    for (int y = 40; near_mm != 0 && y < 80; ++y)
        std::fill_n(mm.begin() + y * kWidth + 60, 40, near_mm);
    return mm;
}

Noisy make_noisy(const DepthNoise& noise, std::vector<std::uint16_t> mm, std::uint64_t seed = 3) {
    Noisy out{std::move(mm), {}};
    out.source.resize(out.mm.size());
    Random random(seed);
    DepthNoiseMaker(noise).apply(kWidth, kHeight, kFocal, out.mm, out.source, random);
    return out;
}

constexpr DepthNoise kNone{false, false, false, false, false};

TEST(DepthNoise, NothingSwitchedOnChangesNothing) {
    const auto clean = scene(2500, 1000);
    const Noisy noisy = make_noisy(kNone, clean);
    EXPECT_EQ(noisy.mm, clean);
    for (std::size_t i = 0; i < noisy.source.size(); ++i)
        EXPECT_EQ(noisy.source[i], i);
}

TEST(DepthNoise, TheSameRandomNumbersGiveTheSamePicture) {
    const auto clean = scene(0, 1500);
    EXPECT_EQ(make_noisy({}, clean, 5).mm, make_noisy({}, clean, 5).mm);
    EXPECT_NE(make_noisy({}, clean, 5).mm, make_noisy({}, clean, 6).mm);
}

TEST(DepthNoise, AWallHasTheDeviationOfTheFormula) {
    DepthNoise noise = kNone;
    noise.axial = true;
    const Noisy noisy = make_noisy(noise, scene(2000, 0));
    double sum = 0.0, squares = 0.0;
    for (const std::uint16_t mm : noisy.mm) {
        sum += mm - 2000.0;
        squares += (mm - 2000.0) * (mm - 2000.0);
    }
    const auto count = static_cast<double>(noisy.mm.size());
    EXPECT_NEAR(sum / count, 0.0, 0.2);
    EXPECT_NEAR(std::sqrt(squares / count), 1000.0 * axial_sigma(2.0, 0.0), 0.15);
}

TEST(DepthNoise, DepthsAreTheFewThatTheDisparityAllows) {
    DepthNoise noise = kNone;
    noise.axial = noise.quantisation = true;
    const Noisy noisy = make_noisy(noise, scene(2500, 0));
    std::set<std::uint16_t> found(noisy.mm.begin(), noisy.mm.end());
    EXPECT_LT(found.size(), 12u);
    for (const std::uint16_t mm : found)
        EXPECT_NEAR(1e3 * quantise_disparity(1e-3 * mm, kKinectBaseline_m * kKinectFocal_px), mm,
                    1.0);
}

TEST(DepthNoise, WhatTheProjectorDoesNotReachLiesLeftOfTheBlock) {
    DepthNoise noise = kNone;
    noise.shadow = true;
    const Noisy noisy = make_noisy(noise, scene(3000, 1000));
    // Disparities of 10.9 and 3.6 pixels: a shadow of 7 beside the block, none elsewhere.
    int lost = 0;
    for (int y = 40; y < 80; ++y)
        for (int x = 0; x < kWidth; ++x)
            if (noisy.mm[static_cast<std::size_t>(y * kWidth + x)] == 0) {
                EXPECT_GE(x, 52);
                EXPECT_LT(x, 60);
                ++lost;
            }
    EXPECT_NEAR(lost / 40.0, 7.3, 1.0);
}

TEST(DepthNoise, OnlySilhouettesAreShiftedAndRagged) {
    DepthNoise noise = kNone;
    noise.lateral = noise.ragged = true;
    const auto clean = scene(0, 1500);
    const Noisy noisy = make_noisy(noise, clean);
    int changed = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            if (noisy.mm[i] == clean[i]) continue;
            ++changed;
            EXPECT_TRUE(x < 62 || x > 97 || y < 42 || y > 77) << x << " " << y;
        }
    EXPECT_GT(changed, 5);
    EXPECT_LT(changed, 120); // of 312 pixels on both sides of it
}

} // namespace
} // namespace toile::imaging
