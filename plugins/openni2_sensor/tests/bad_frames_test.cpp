// Cameras that do wrong: each bad frame does what the README's table says, and the ones after it
// come as ever.
#include "openni2_sensor/tests/test_camera.h"
#include "support/throws.h"

#include <algorithm>

namespace toile::openni2_sensor {
namespace {

using namespace test;

constexpr double kPeriod = 1.0 / kFramesPerSecond;

class BadFrames : public ::testing::Test {
  protected:
    void SetUp() override {
        wish(0, Fault::none);
        ASSERT_TRUE(wait_for_frame(sensor_));
    }
    void TearDown() override { wish(0, Fault::none); }

    /// Some frames from now on: their numbers and times rise, and none comes with a step of more
    /// than a second.
    std::vector<SensedFrame> next_frames(int count) {
        std::vector<SensedFrame> out;
        SensedFrame before = sensor_.frame();
        for (int i = 0; i < count && wait_for_frame(sensor_); ++i) {
            const SensedFrame& frame = sensor_.frame();
            EXPECT_GT(frame.sequence, before.sequence);
            EXPECT_LT(frame.sequence, before.sequence + kFramesPerSecond);
            EXPECT_GT(frame.timestamp_ns, before.timestamp_ns);
            EXPECT_LT(frame.timestamp_ns, before.timestamp_ns + 1'000'000'000);
            EXPECT_EQ(frame.depth.size(), std::size_t{kWidth * kHeight});
            out.push_back(before = frame);
        }
        EXPECT_EQ(out.size(), static_cast<std::size_t>(count));
        return out;
    }
    /// Has the fault done until it was seen: a poll that comes late misses a picture, since cameras
    /// have their newest one alone.
    void until(const std::function<bool()>& seen, Fault fault,
               const std::function<void(const SensedFrame&)>& look) {
        for (int i = 0; i < 20 && !seen(); ++i) {
            wish(0, fault);
            for (const SensedFrame& frame : next_frames(5))
                look(frame);
        }
        EXPECT_TRUE(seen());
    }
    static bool without_reading(const SensedFrame& frame) {
        return std::all_of(frame.depth.begin(), frame.depth.end(),
                           [](float d) { return std::isnan(d); });
    }

    OpenNiSensor sensor_{kUris[0], {}, log_to_heard()};
};

TEST_F(BadFrames, PicturesOfZerosAndSaturatedOnesHaveNoReading) {
    for (const Fault fault : {Fault::all_zero, Fault::all_saturated}) {
        std::int64_t empty = 0;
        until([&] { return empty > 0; }, fault,
              [&](const SensedFrame& frame) {
                  empty += without_reading(frame) ? 1 : 0;
                  EXPECT_TRUE(without_reading(frame) || shown_number(frame) > 0);
              });
        EXPECT_EQ(empty, 1);
    }
    EXPECT_TRUE(heard.empty());
}

TEST_F(BadFrames, PicturesOfAWrongSizeAreLeftOutAndCounted) {
    std::uint32_t wrong = 0;
    for (const Fault fault : {Fault::smaller, Fault::larger, Fault::other_format}) {
        until([&] { return sensor_.faults().wrong_size > wrong; }, fault,
              [](const SensedFrame& frame) { EXPECT_GT(shown_number(frame), 0); });
        EXPECT_EQ(sensor_.faults().wrong_size, ++wrong);
    }
    ASSERT_EQ(heard.size(), 1u); // once, not for each
    EXPECT_NE(heard[0].find("32 x 24 pixels, described were 64 x 48"), std::string::npos);
}

TEST_F(BadFrames, ACameraThatChangesItsSizeForGoodIsAnError) {
    wish(0, Fault::smaller_from_now);
    EXPECT_ERROR((void)wait_for_frame(sensor_), "32 x 24 pixels, described were 64 x 48");
    EXPECT_EQ(sensor_.faults().wrong_size, 30u);
    EXPECT_FALSE(sensor_.poll()); // one error, no more
    EXPECT_TRUE(sensor_.over());
}

TEST_F(BadFrames, DroppedFramesAreAGapInTheNumbers) {
    wish(0, Fault::ten_dropped);
    SensedFrame before = sensor_.frame();
    double longest = 0.0;
    for (const SensedFrame& frame : next_frames(8)) {
        const auto numbers = static_cast<double>(frame.sequence - before.sequence);
        const double time = 1e-9 * static_cast<double>(frame.timestamp_ns - before.timestamp_ns);
        EXPECT_NEAR(time, numbers * kPeriod, 0.1 * kPeriod);
        longest = std::max(longest, numbers);
        before = frame;
    }
    EXPECT_GE(longest, 11.0);
}

TEST_F(BadFrames, DoubledAndLateFramesAreLeftOut) {
    int number = 0;
    const auto rises = [&](const SensedFrame& frame) {
        EXPECT_GT(shown_number(frame), number);
        number = shown_number(frame);
    };
    until([&] { return sensor_.faults().repeated > 0; }, Fault::twice, rises);
    until([&] { return sensor_.faults().late > 0; }, Fault::late, rises);
}

TEST_F(BadFrames, ClocksThatJumpAreSetRight) {
    std::uint32_t jumps = 0;
    for (const Fault fault : {Fault::clock_back, Fault::clock_ahead, Fault::clock_ahead}) {
        const std::int64_t before_ns = sensor_.frame().timestamp_ns;
        wish(0, fault);
        next_frames(8);
        EXPECT_EQ(sensor_.faults().clock_jumps, ++jumps);
        EXPECT_LT(sensor_.frame().timestamp_ns - before_ns, 2'000'000'000);
    }
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_NE(heard[0].find("its clock jumped by -9.9"), std::string::npos) << heard[0];
}

TEST_F(BadFrames, ClocksThatStandStillGoOn) {
    wish(0, Fault::clock_stands_still);
    const auto frames = next_frames(8);
    EXPECT_NEAR(1e-9 * static_cast<double>(frames[7].timestamp_ns - frames[1].timestamp_ns),
                kPeriod * (frames[7].sequence - frames[1].sequence), 0.1 * kPeriod);
}

TEST_F(BadFrames, CountsThatJumpAreSetRight) {
    for (const Fault fault : {Fault::count_ahead, Fault::counts_anew}) {
        wish(0, fault);
        next_frames(8);
    }
}

} // namespace
} // namespace toile::openni2_sensor
