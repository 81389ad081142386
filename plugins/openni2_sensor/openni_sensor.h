// A source that survives its camera: unplugged and plugged in again it goes on.
#pragma once

#include "openni2_sensor/camera_device.h"

#include <chrono>
#include <functional>
#include <future>

namespace toile::openni2_sensor {

class OpenNiSensor {
  public:
    /// Told in words what happened to the camera, once each time.
    using Log = std::function<void(const std::string&)>;

    /// \throw Error when the source cannot be opened
    OpenNiSensor(const std::string& source, const DeviceOptions& options, Log log);
    OpenNiSensor(const OpenNiSensor&) = delete;
    OpenNiSensor& operator=(const OpenNiSensor&) = delete;
    ~OpenNiSensor();

    [[nodiscard]] const imaging::Intrinsics& intrinsics() const noexcept { return intrinsics_; }
    [[nodiscard]] bool has_color() const noexcept { return has_color_; }
    [[nodiscard]] bool registered() const noexcept { return registered_; }
    [[nodiscard]] double period_s() const noexcept { return period_s_; }
    [[nodiscard]] bool recording() const noexcept { return address_.recording; }

    /// The next frame: true when there is one. Numbers and times rise from frame to frame, whatever
    /// the device says: one that comes twice is left out, a clock that goes back is set right, and
    /// what was missed while it was unplugged counts as dropped. Never waits for a device.
    bool poll();
    [[nodiscard]] const SensedFrame& frame() const noexcept { return frame_; }
    /// Of a recording: everything was given.
    [[nodiscard]] bool over() const noexcept { return over_; }
    /// A recording from its beginning. \throw Error
    void rewind();

  private:
    using Clock = std::chrono::steady_clock;
    void look_for_device();
    bool accept();

    const OpenNiLibrary& library_;
    DeviceOptions options_;
    Log log_;
    Address address_;
    imaging::Intrinsics intrinsics_;
    double period_s_ = 0.0;
    bool has_color_ = false, registered_ = false, over_ = false;
    std::unique_ptr<CameraDevice> device_; ///< none: unplugged
    std::future<std::unique_ptr<CameraDevice>> returning_;
    Clock::time_point looked_, last_seen_;
    SensedFrame frame_;
    bool any_ = false, fresh_ = true; ///< some frame was given; none by this device
    std::uint32_t device_number_ = 0; ///< of its last frame
    std::int64_t device_time_ns_ = 0;
    std::uint32_t number_ = 0; ///< as given
    std::int64_t time_ns_ = 0;
};

} // namespace toile::openni2_sensor
