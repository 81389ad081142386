#include "garment/size_chart.h"

#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::garment {
namespace {

class SizeChartFile : public testing::Test {
  protected:
    [[nodiscard]] SizeChart read(const std::string& text) const {
        write_text(folder_ / "sizes.csv", text);
        return read_size_chart(folder_ / "sizes.csv");
    }
    void refused(const std::string& text, const std::string& words) const {
        EXPECT_ERROR((void)read(text), words);
        EXPECT_ERROR((void)read(text), "sizes.csv");
    }
    test::TemporaryFolder folder_;
};

TEST_F(SizeChartFile, AsShopsWriteIt) {
    const SizeChart chart = read("Size,Bust,Waist cm,hip_girth (in),Inseam\r\nS, 82-89 "
                                 ",66,36,\r\n\r\nXL,0.98-1.05,84.5,42,81\r\n");
    ASSERT_EQ(chart.size(), 2u);
    EXPECT_EQ(chart[0].first, "S");
    const auto& small = chart[0].second;
    ASSERT_EQ(small.size(), 3u) << "an empty cell says nothing";
    EXPECT_DOUBLE_EQ(small.at("bust_girth").minimum, 0.82);
    EXPECT_DOUBLE_EQ(small.at("bust_girth").maximum, 0.89);
    EXPECT_DOUBLE_EQ(small.at("waist_girth").minimum, 0.66);
    EXPECT_DOUBLE_EQ(small.at("waist_girth").maximum, 0.66);
    EXPECT_NEAR(small.at("hip_girth").maximum, 0.9144, 1e-9);
    const auto& large = chart[1].second;
    EXPECT_DOUBLE_EQ(large.at("bust_girth").minimum, 0.98) << "metres, as no bust is 98 cm / 100";
    EXPECT_EQ(large.size(), 4u);
}

TEST_F(SizeChartFile, WithSemicolonsCommasAreDecimal) {
    const SizeChart chart = read("\xEF\xBB\xBFGröße;Bust;Waist\nM;88,5\xE2\x80\x93"
                                 "96;72\n");
    ASSERT_EQ(chart.size(), 1u);
    EXPECT_DOUBLE_EQ(chart[0].second.at("bust_girth").minimum, 0.885);
    EXPECT_DOUBLE_EQ(chart[0].second.at("bust_girth").maximum, 0.96);
    EXPECT_EQ(read("size\tbust\nM\t90\n").front().second.at("bust_girth").minimum, 0.9);
}

TEST_F(SizeChartFile, WhatIsWrongIsSaidWithItsPlace) {
    refused("size,bust,colour\nM,90,red\n", "'colour'");
    refused("size,bust\nM,ninety\n", "line 2, 'bust' is 'ninety'");
    refused("size,bust\nM,96-88\n", "the first number is the larger one");
    refused("size,bust\nM,88-96-99\n", "write one number");
    refused("size,bust\nM,900\n", "out of 0.03 to 3 m");
    refused("size,bust\nM,90,80\n", "3 cells, the first 2");
    refused("size,bust\nM,90\nM,95\n", "stands twice");
    refused("size,bust\n,90\n", "names no size");
    refused("size,bust\n", "has no size");
    refused("size\nM\n", "must name the columns");
    EXPECT_THROW((void)read_size_chart(folder_ / "none.csv"), FileError);
}

} // namespace
} // namespace toile::garment
