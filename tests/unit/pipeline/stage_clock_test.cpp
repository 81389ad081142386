#include "pipeline/stage_clock.h"

#include <gtest/gtest.h>

namespace toile::pipeline {
namespace {

TEST(DurationHistogram, QuantilesOfKnownDurationsAreWithinABin) {
    DurationHistogram histogram;
    for (int i = 1; i <= 1000; ++i)
        histogram.add(i * 1e-3);
    const Quantiles q = histogram.quantiles();
    EXPECT_NEAR(q.median_ms, 500.0, 500.0 * 0.012);
    EXPECT_NEAR(q.p95_ms, 950.0, 950.0 * 0.012);
    EXPECT_DOUBLE_EQ(q.max_ms, 1000.0);
}

TEST(DurationHistogram, AQuantileNeverExceedsTheMaximum) {
    DurationHistogram histogram;
    histogram.add(3.3e-3);
    const Quantiles q = histogram.quantiles();
    EXPECT_LE(q.median_ms, q.max_ms);
    EXPECT_DOUBLE_EQ(q.max_ms, 3.3);
}

TEST(DurationHistogram, EmptyAndExtremeDurationsAreKept) {
    DurationHistogram histogram;
    EXPECT_EQ(histogram.quantiles().max_ms, 0.0);
    histogram.add(0.0);
    histogram.add(1e5);
    EXPECT_EQ(histogram.count(), 2u);
    EXPECT_DOUBLE_EQ(histogram.quantiles().max_ms, 1e8);
}

TEST(StageClock, DrawingDoesNotCountAsComputing) {
    StageClock clock;
    const auto spin = [](double seconds) {
        const double start = cpu_seconds();
        while (cpu_seconds() - start < seconds) {
        }
    };
    clock.begin(Stage::skinning);
    spin(0.004);
    clock.end(Stage::skinning);
    clock.begin(Stage::drawing);
    spin(0.02);
    clock.end(Stage::drawing);
    clock.end_frame();
    EXPECT_EQ(clock.frames(), 1u);
    EXPECT_GE(clock.stage(Stage::skinning).max_ms, 4.0);
    EXPECT_GE(clock.stage(Stage::drawing).max_ms, 20.0);
    EXPECT_EQ(clock.compute().max_ms, clock.stage(Stage::skinning).max_ms);
}

TEST(StageClock, PartsOfAStageAddUpWithinAFrame) {
    StageClock clock;
    for (int part = 0; part < 3; ++part) {
        clock.begin(Stage::cloth);
        const double start = cpu_seconds();
        while (cpu_seconds() - start < 0.002) {
        }
        clock.end(Stage::cloth);
    }
    clock.end_frame();
    clock.end_frame();
    EXPECT_GE(clock.stage(Stage::cloth).max_ms, 6.0);
    EXPECT_LT(clock.stage(Stage::cloth).median_ms, 1.0); // the second frame had none
}

} // namespace
} // namespace toile::pipeline
