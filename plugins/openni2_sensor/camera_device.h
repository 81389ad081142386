// One camera or recording that OpenNI2 opened: depth in metres and colour, frame by frame.
#pragma once

#include "imaging/camera.h"
#include "openni2_sensor/open_ni.h"

#include <atomic>
#include <memory>
#include <optional>

namespace toile::openni2_sensor {

struct DeviceOptions {
    bool mirrored = false; ///< pictures as a mirror shows them
    bool recording_registered =
        true;          ///< colour of recordings is registered to depth: they do not say
    bool live = false; ///< recordings keep to their own pace
};

struct PictureSize {
    int width = 0, height = 0;
    bool operator==(const PictureSize&) const = default;
};

struct SensedFrame {
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0;   ///< the device's clock
    std::vector<float> depth;        ///< (width * height) metres, NaN where unknown
    std::vector<std::uint8_t> color; ///< (width * height * 4) sRGB, or empty
};

class CameraDevice {
  public:
    /// \throw Error when it cannot be opened or gives no depth
    CameraDevice(const OpenNiLibrary& library, const Address& address,
                 const DeviceOptions& options);
    CameraDevice(const CameraDevice&) = delete;
    CameraDevice& operator=(const CameraDevice&) = delete;
    ~CameraDevice();

    [[nodiscard]] const imaging::Intrinsics& intrinsics() const noexcept { return intrinsics_; }
    [[nodiscard]] bool has_color() const noexcept;
    [[nodiscard]] bool registered() const noexcept { return registered_; }
    [[nodiscard]] double period_s() const noexcept { return period_s_; }
    /// The field of view is a guess, since the device does not tell it.
    [[nodiscard]] bool guessed_view() const noexcept { return guessed_view_; }

    enum class Step : std::uint8_t { invalid, frame, nothing_new, over, lost, wrong_size };
    /// Takes what is there: a live device's newest picture, a recording's next one (live: when it
    /// is due). `lost`: unplugged. `wrong_size`: a depth picture came that is not of the size or
    /// kind that was described; it is taken and left out. Colour of a wrong size is left out alone.
    /// Allocates nothing after the first frame.
    Step poll(SensedFrame& out);
    /// Of the last depth picture, right or wrong.
    [[nodiscard]] PictureSize last_size() const noexcept { return last_size_; }

  private:
    class Streams; ///< OpenNI2's own
    void describe(const Address& address, const DeviceOptions& options);
    Step next_of_recording(SensedFrame& out);
    Step take_depth(SensedFrame& out);
    void take_color(SensedFrame& out);

    std::unique_ptr<Streams> streams_;
    imaging::Intrinsics intrinsics_;
    double period_s_ = 0.0;
    bool registered_ = false, guessed_view_ = false, recording_ = false, live_ = false;
    bool flip_depth_ = false, flip_color_ = false;
    float unit_m_ = 0.001f;
    int saturated_ = 0xffff; ///< the device's largest value
    PictureSize last_size_;
};

} // namespace toile::openni2_sensor
