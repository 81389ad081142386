// Whatever a device says, numbers and times of its stream rise, by steps that can be believed.
#include "openni2_sensor/frame_clock.h"

#include <gtest/gtest.h>

namespace toile::openni2_sensor {
namespace {

using Verdict = FrameClock::Verdict;

constexpr std::int64_t kPeriod = 20'000'000; // 50 frames a second
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kSecond = 1'000'000'000;

/// A stream that has given frame 100 of its device at 7 s.
class AfterAFrame : public ::testing::TestWithParam<bool> {
  protected:
    AfterAFrame() { EXPECT_EQ(clock_.take({100, 7 * kSecond}, waited(0)), Verdict::next); }

    [[nodiscard]] static std::optional<std::int64_t> waited(std::int64_t ns) {
        return GetParam() ? std::optional(ns) : std::nullopt;
    }
    /// The next frame as the device tells it, after the usual time; it takes a place.
    void expect_step(std::int64_t numbers, std::int64_t time_ns, std::uint32_t wanted_numbers,
                     std::int64_t wanted_ns, std::int64_t waited_ns = kPeriod) {
        const FrameStamp before = clock_.stamp();
        device_.number = static_cast<std::uint32_t>(device_.number + numbers);
        device_.time_ns += time_ns;
        ASSERT_EQ(clock_.take(device_, waited(waited_ns)), Verdict::next);
        EXPECT_EQ(clock_.stamp().number - before.number, wanted_numbers);
        EXPECT_EQ(clock_.stamp().time_ns - before.time_ns, wanted_ns);
    }
    void expect_left_out(std::int64_t numbers, std::int64_t time_ns, Verdict verdict) {
        const FrameStamp before = clock_.stamp();
        const FrameStamp odd{static_cast<std::uint32_t>(device_.number + numbers),
                             device_.time_ns + time_ns};
        EXPECT_EQ(clock_.take(odd, waited(kMillisecond)), verdict);
        EXPECT_EQ(clock_.stamp().number, before.number);
        EXPECT_EQ(clock_.stamp().time_ns, before.time_ns);
    }

    FrameClock clock_{1e-9 * kPeriod};
    FrameStamp device_{100, 7 * kSecond};
};
INSTANTIATE_TEST_SUITE_P(CamerasAndRecordings, AfterAFrame, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Camera" : "Recording"; });

TEST_P(AfterAFrame, StepsAreTheDevices) {
    EXPECT_EQ(clock_.stamp().number, 0u);
    EXPECT_EQ(clock_.stamp().time_ns, 0);
    expect_step(1, 21 * kMillisecond, 1, 21 * kMillisecond);
    expect_step(5, 99 * kMillisecond, 5, 99 * kMillisecond); // four were dropped
    expect_step(1, kSecond, 1, kSecond);                     // a pause
    EXPECT_EQ(clock_.jump_ns(), 0);
}

TEST_P(AfterAFrame, RepeatedAndLateFramesAreLeftOut) {
    expect_left_out(0, 0, Verdict::repeated);
    expect_left_out(0, kMillisecond, Verdict::repeated);
    expect_left_out(-1, -kPeriod, Verdict::late);
    expect_left_out(-30, -30 * kPeriod, Verdict::late);
    expect_step(1, kPeriod, 1, kPeriod);
}

TEST_P(AfterAFrame, DevicesThatDoNotCountOrHaveNoClock) {
    expect_step(0, kPeriod, 1, kPeriod);
    expect_step(0, kPeriod, 1, kPeriod);
    expect_step(1, 0, 1, kPeriod);
    expect_step(3, 0, 3, 3 * kPeriod);
    EXPECT_EQ(clock_.jump_ns(), 0);
}

TEST_P(AfterAFrame, AClockThatGoesBackCountsAsOnePeriod) {
    expect_step(1, -5 * kSecond, 1, kPeriod);
    EXPECT_EQ(clock_.jump_ns(), -5 * kSecond);
    expect_step(1, kPeriod, 1, kPeriod);
    EXPECT_EQ(clock_.jump_ns(), 0);
    expect_step(-90, -3 * kSecond, 1, kPeriod); // counts anew
    expect_step(1, kPeriod, 1, kPeriod);
}

TEST_P(AfterAFrame, AClockThatJumpsAheadIsNotBelieved) {
    expect_step(1, 600 * kSecond, 1, kPeriod);
    EXPECT_EQ(clock_.jump_ns(), 600 * kSecond);
    expect_step(1, kPeriod, 1, kPeriod);
    expect_step(3, 600 * kSecond, 3, 3 * kPeriod);
    EXPECT_EQ(clock_.jump_ns(), 600 * kSecond);
}

TEST_P(AfterAFrame, ACountThatJumpsAheadIsNotBelieved) {
    expect_step(1'000'000, 3 * kPeriod, 3, 3 * kPeriod);
    expect_step(1, kPeriod, 1, kPeriod);
    expect_step(1'000'000, 600 * kSecond, 1, kPeriod);
    EXPECT_EQ(clock_.jump_ns(), 600 * kSecond);
}

TEST_P(AfterAFrame, ALongGapIsBelievedWhereSomethingBearsItOut) {
    // A camera: the host waited as long. A recording: its numbers say the same.
    expect_step(500, 500 * kPeriod, 500, 500 * kPeriod, 500 * kPeriod);
    if (GetParam())
        expect_step(1, 10 * kSecond, 1, 10 * kSecond, 10 * kSecond); // it stood still
    else
        expect_step(1, 10 * kSecond, 1, kPeriod);
}

TEST_P(AfterAFrame, WhatWasMissedWhileAwayCounts) {
    clock_.resume(3 * kSecond);
    expect_step(-100, -7 * kSecond, 150, 3 * kSecond);
    expect_step(1, kPeriod, 1, kPeriod);
}

} // namespace
} // namespace toile::openni2_sensor
