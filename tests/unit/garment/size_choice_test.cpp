#include "garment/size_choice.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

using testing::HasSubstr;

GarmentPackage three_sizes() {
    GarmentPackage package;
    package.manifest.id = "test";
    const std::array<std::pair<const char*, double>, 3> sizes = {
        {{"S", 0.70}, {"M", 0.76}, {"L", 0.82}}};
    for (const auto& [name, waist] : sizes) {
        GarmentSize size;
        size.entry.name = name;
        size.entry.chart = {{"waist_girth", {waist - 0.03, waist + 0.03}},
                            {"hip_girth", {waist + 0.17, waist + 0.23}}};
        package.sizes.push_back(size);
    }
    return package;
}

TEST(SizeChoice, TakesTheSizeWhoseRangesHoldTheBody) {
    const auto choice = choose_size(three_sizes(), {{"waist_girth", 0.77}, {"hip_girth", 0.95}});
    EXPECT_EQ(choice.index, 1u);
    EXPECT_TRUE(choice.within);
    EXPECT_THAT(choice.reason, HasSubstr("M: "));
}

TEST(SizeChoice, TakesTheLeastMissedSizeAndSaysWhatItMisses) {
    const auto choice = choose_size(three_sizes(), {{"waist_girth", 1.10}});
    EXPECT_EQ(choice.index, 2u);
    EXPECT_FALSE(choice.within);
    EXPECT_THAT(choice.reason, HasSubstr("waist_girth 1.100 m is above 0.790 to 0.850 m"));
}

TEST(SizeChoice, OnABoundaryTheBetterCentredSizeWins) {
    // 0.73 ends S and begins M; the hips lie nearer to the middle of M.
    const auto choice = choose_size(three_sizes(), {{"waist_girth", 0.73}, {"hip_girth", 0.935}});
    EXPECT_EQ(choice.index, 1u);
}

TEST(SizeChoice, NearABoundaryItSaysBetweenWhichTwo) {
    // M charts the waist from 0.73 to 0.79, hips from 0.93 to 0.99.
    const auto near = choose_size(three_sizes(), {{"waist_girth", 0.785}});
    EXPECT_EQ(near.index, 1u);
    EXPECT_EQ(near.between, 2u);
    EXPECT_THAT(near.reason, HasSubstr("between M and L"));
    EXPECT_THAT(near.reasons.back(), HasSubstr("waist of 78.5 cm is near 79.0 cm, where L begins"));
    const auto low = choose_size(three_sizes(), {{"waist_girth", 0.735}});
    EXPECT_EQ(low.index, 1u);
    EXPECT_EQ(low.between, 0u);
    EXPECT_THAT(low.reason, HasSubstr("between S and M"));
    EXPECT_THAT(low.reasons.back(), HasSubstr("S sits closer, M gives more room"));
}

TEST(SizeChoice, InTheMiddleItIsBetweenNone) {
    const auto choice = choose_size(three_sizes(), {{"waist_girth", 0.76}, {"hip_girth", 0.96}});
    EXPECT_FALSE(choice.between);
    EXPECT_EQ(choice.reasons.size(), 2u);
    EXPECT_THAT(choice.reasons.back(), HasSubstr("waist of 76.0 cm lies within M's 73.0 to 79.0"));
}

// With a size step s and girths that are off by e (either way), about 2 e / s of all people are
// within e of a boundary, and only they.
TEST(SizeChoice, HowManyAreBetweenSizesFollowsTheTolerance) {
    SizeChoiceOptions options;
    options.tolerance_m = 0.006;
    int between = 0, all = 0;
    for (double waist = 0.67; waist < 0.85; waist += 0.0005, ++all) {
        const auto choice = choose_size(three_sizes(), {{"waist_girth", waist}}, options);
        const double off = std::min(std::abs(waist - 0.73), std::abs(waist - 0.79));
        EXPECT_EQ(choice.between.has_value(), off < 0.00599 || (off < 0.00601 && choice.between))
            << waist;
        between += choice.between ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(between) / all, 2.0 * 2.0 * 0.006 / 0.18, 0.01);
}

TEST(SizeChoice, ABodyWithoutAChartedMeasurementIsRefused) {
    EXPECT_THROW((void)choose_size(three_sizes(), {{"neck_girth", 0.36}}), Error);
}

} // namespace
} // namespace toile::garment
