// The test driver's cameras as tests handle them: unplugged, doing wrong, looked at.
#pragma once

#include "openni2_sensor/openni_sensor.h"
#include "openni2_sensor/tests/driver/test_pictures.h"

#include <gtest/gtest.h>

#include <dlfcn.h>

#include <cmath>
#include <thread>

namespace toile::openni2_sensor::test {

/// Calls the driver that OpenNI2 has loaded.
inline void tell_driver(const char* function, int camera, int value) {
    void* driver = dlopen(TOILE_TEST_DRIVER, RTLD_NOW | RTLD_NOLOAD);
    ASSERT_NE(driver, nullptr) << "OpenNI2 has not loaded " << TOILE_TEST_DRIVER;
    const auto call = reinterpret_cast<void (*)(int, int)>(dlsym(driver, function));
    ASSERT_NE(call, nullptr) << function;
    call(camera, value);
    dlclose(driver);
}
inline void plug(int camera, bool in) {
    tell_driver("toile_test_plug", camera, in ? 1 : 0);
}
inline void wish(int camera, Fault fault) {
    tell_driver("toile_test_wish", camera, static_cast<int>(fault));
}

/// Polls for at most some seconds.
inline bool wait_for_frame(OpenNiSensor& sensor, double seconds = 5.0) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < until) {
        if (sensor.poll()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

/// Number of the picture that a frame shows, told by its depth; -1: it is none of the driver's.
inline int shown_number(const SensedFrame& frame, bool mirrored = false) {
    for (int number = 1; number <= 4000; ++number) {
        bool same = true;
        for (int y = 0; y < kHeight && same; ++y)
            for (int x = 0; x < kWidth && same; ++x) {
                const float metres = frame.depth[static_cast<std::size_t>(
                    y * kWidth + (mirrored ? kWidth - 1 - x : x))];
                const std::uint16_t true_mm = depth_at(x, y, number);
                same = true_mm == 0 ? std::isnan(metres)
                                    : std::lround(1000.0f * metres) == long{true_mm};
            }
        if (same) return number;
    }
    return -1;
}

inline std::vector<std::string> heard;
inline OpenNiSensor::Log log_to_heard() {
    heard.clear();
    return [](const std::string& text) { heard.push_back(text); };
}

} // namespace toile::openni2_sensor::test
