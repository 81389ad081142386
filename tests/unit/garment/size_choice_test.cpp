#include "garment/size_choice.h"

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

TEST(SizeChoice, ABodyWithoutAChartedMeasurementIsRefused) {
    EXPECT_THROW((void)choose_size(three_sizes(), {{"neck_girth", 0.36}}), Error);
}

} // namespace
} // namespace toile::garment
