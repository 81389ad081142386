// A source that survives its camera: unplugged and plugged in again it goes on.
#pragma once

#include "openni2_sensor/camera_device.h"
#include "openni2_sensor/frame_clock.h"

#include <chrono>
#include <functional>
#include <future>

namespace toile::openni2_sensor {

/// Bad frames so far.
struct FrameFaults {
    std::uint32_t wrong_size = 0;  ///< left out
    std::uint32_t repeated = 0;    ///< left out
    std::uint32_t late = 0;        ///< left out
    std::uint32_t clock_jumps = 0; ///< set right
};

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
    /// the device says (FrameClock), and what was missed while it was unplugged counts as dropped.
    /// Never waits for a device. \throw Error once, when the pictures have another size than was
    /// described for good; nothing comes any more then
    bool poll();
    [[nodiscard]] const SensedFrame& frame() const noexcept { return frame_; }
    [[nodiscard]] const FrameFaults& faults() const noexcept { return faults_; }
    /// Of a recording: everything was given.
    [[nodiscard]] bool over() const noexcept { return over_; }
    /// A recording from its beginning. \throw Error
    void rewind();

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] std::unique_ptr<CameraDevice> open_device() const;
    /// Closed after what was posted before; nobody need wait.
    std::future<void> close_device();
    void look_for_device();
    bool accept();
    void note_wrong_size();

    const OpenNiLibrary& library_;
    DeviceOptions options_;
    Log log_;
    Address address_;
    imaging::Intrinsics intrinsics_;
    double period_s_ = 0.0;
    bool has_color_ = false, registered_ = false;
    bool over_ = false, begun_ = false;    ///< begun: polled since it was opened or rewound
    std::unique_ptr<CameraDevice> device_; ///< none: unplugged
    std::future<std::unique_ptr<CameraDevice>> returning_;
    Clock::time_point looked_, last_seen_;
    SensedFrame frame_;
    FrameClock clock_;
    FrameFaults faults_;
    int wrong_in_a_row_ = 0;
};

} // namespace toile::openni2_sensor
