#include "host/faults.h"

#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace toile::host {
namespace {

TEST(AllFinite, SeesEveryBadNumberWhereverItIs) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          -std::numeric_limits<float>::infinity()})
        for (const std::size_t place : {0u, 7u, 32u}) {
            std::vector<float> values(33, std::numeric_limits<float>::max());
            EXPECT_TRUE(all_finite(values));
            values[place] = bad;
            EXPECT_FALSE(all_finite(values)) << place;
        }
    EXPECT_TRUE(all_finite(std::span<const float>()));
}

TEST(AllFinite, ReadsStridedViews) {
    std::vector<float> rows = {1, 2, 3, std::numeric_limits<float>::quiet_NaN(), 5, 6, 7, 8};
    toile_view view{rows.data(), 2, 16, TOILE_F32X3, 0};
    EXPECT_TRUE(view_finite(view)); // the NaN lies between the rows
    view.format = TOILE_F32X4;
    EXPECT_FALSE(view_finite(view));
    view.format = TOILE_U8;
    EXPECT_TRUE(view_finite(view));
}

TEST(FaultWatch, NonFiniteSwitchesOffAtOnce) {
    FaultWatch watch;
    EXPECT_FALSE(watch.frame(TOILE_OK, true, 100.0)) << "lock-step counts no time";
    EXPECT_TRUE(watch.frame(TOILE_OK, false, 0.0));
    EXPECT_FALSE(watch.on());
    EXPECT_FALSE(watch.frame(TOILE_OK, false, 0.0)) << "said once";
    EXPECT_EQ(watch.text("acme.cloth"),
              "acme.cloth is switched off: returned numbers that are not finite");
    watch.clear();
    EXPECT_TRUE(watch.on());
}

TEST(FaultWatch, OverrunsSwitchOffOnTheLiveClockOnly) {
    FaultWatch live({.live_clock = true, .budget_s = 0.02});
    FaultWatch lock_step({.live_clock = false, .budget_s = 0.02});
    int switched_off_at = 0;
    for (int frame = 1; frame <= 100; ++frame) {
        if (live.frame(TOILE_OK, true, 0.03)) switched_off_at = frame;
        EXPECT_FALSE(lock_step.frame(TOILE_OK, true, 0.03));
    }
    EXPECT_EQ(switched_off_at, 24);
    EXPECT_EQ(live.fault(), Fault::over_budget);
    EXPECT_EQ(live.text("x"), "x is switched off: overran its budget of 20 ms again and again");
}

TEST(FaultWatch, NowAndThenIsForgiven) {
    FaultWatch watch({.live_clock = true, .budget_s = 0.02});
    for (int frame = 0; frame < 1000; ++frame)
        EXPECT_FALSE(watch.frame(frame % 3 == 0 ? TOILE_E_NUMERIC : TOILE_OK, true,
                                 frame % 2 == 0 ? 0.03 : 0.01));
    EXPECT_EQ(watch.overruns(), 500u);
    EXPECT_EQ(watch.failures(), 334u);
}

TEST(FaultWatch, CallsThatKeepFailingSwitchOff) {
    FaultWatch watch;
    int frames = 0;
    while (watch.on() && frames < 100) {
        (void)watch.frame(TOILE_E_INTERNAL, true, 0);
        ++frames;
    }
    EXPECT_EQ(frames, 16);
    EXPECT_EQ(watch.fault(), Fault::failing);
}

} // namespace
} // namespace toile::host
