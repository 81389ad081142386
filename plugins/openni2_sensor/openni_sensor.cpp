#include "openni2_sensor/openni_sensor.h"

#include "core/error.h"

#include <algorithm>

namespace toile::openni2_sensor {
namespace {

constexpr std::chrono::milliseconds kLookAgain{500};

} // namespace

OpenNiSensor::OpenNiSensor(const std::string& source, const DeviceOptions& options, Log log)
    : library_(OpenNiLibrary::running()), options_(options), log_(std::move(log)),
      address_(resolve(source, library_)),
      device_(std::make_unique<CameraDevice>(library_, address_, options)) {
    intrinsics_ = device_->intrinsics();
    has_color_ = device_->has_color();
    registered_ = device_->registered();
    period_s_ = device_->period_s();
    if (device_->guessed_view())
        log_("openni2:" + address_.uri +
             " does not tell its field of view; 58.6 degrees across are taken");
}

OpenNiSensor::~OpenNiSensor() {
    if (returning_.valid()) returning_.wait();
}

void OpenNiSensor::rewind() {
    over_ = false;
    if (!address_.recording) return;
    // OpenNI2's own seeking crashes on some recordings: opened anew instead.
    device_.reset();
    device_ = std::make_unique<CameraDevice>(library_, address_, options_);
    any_ = false;
    fresh_ = true;
}

/// Asks from time to time, aside, whether the camera is back.
void OpenNiSensor::look_for_device() {
    if (returning_.valid()) {
        if (returning_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        device_ = returning_.get();
        if (device_ == nullptr) return;
        const imaging::Intrinsics& now = device_->intrinsics();
        if (now.width != intrinsics_.width || now.height != intrinsics_.height ||
            device_->has_color() != has_color_) {
            log_("openni2:" + address_.uri +
                 " came back with other pictures; start anew to use it");
            device_.reset();
            looked_ = Clock::now() + std::chrono::hours(1);
            return;
        }
        fresh_ = true;
        log_("openni2:" + address_.uri + " is back");
        return;
    }
    if (Clock::now() - looked_ < kLookAgain) return;
    looked_ = Clock::now();
    returning_ = std::async(std::launch::async, [this]() -> std::unique_ptr<CameraDevice> {
        const auto devices = list_devices(library_);
        const bool there = std::any_of(devices.begin(), devices.end(), [&](const DeviceName& one) {
            return one.uri == address_.uri;
        });
        if (!there) return nullptr;
        try {
            return std::make_unique<CameraDevice>(library_, address_, options_);
        } catch (const Error&) {
            return nullptr; // not ready yet: asked again
        }
    });
}

/// Gives the device's frame its number and time in the stream; false for one that came before.
bool OpenNiSensor::accept() {
    const std::uint32_t number = frame_.sequence;
    const std::int64_t time_ns = frame_.timestamp_ns;
    const auto period_ns = static_cast<std::int64_t>(1e9 * period_s_);
    if (!any_) {
        number_ = 0;
        time_ns_ = 0;
    } else if (fresh_) { // back again: what the clock says was missed
        const std::int64_t away = std::max<std::int64_t>(
            period_ns,
            std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - last_seen_)
                .count());
        number_ += static_cast<std::uint32_t>(std::max<std::int64_t>(1, away / period_ns));
        time_ns_ += away;
    } else {
        if (number == device_number_) return false;
        // A device that counts anew, or back: the next one.
        number_ += number > device_number_ ? number - device_number_ : 1;
        time_ns_ += time_ns > device_time_ns_ ? time_ns - device_time_ns_ : period_ns;
    }
    any_ = true;
    fresh_ = false;
    last_seen_ = Clock::now();
    device_number_ = number;
    device_time_ns_ = time_ns;
    frame_.sequence = number_;
    frame_.timestamp_ns = time_ns_;
    return true;
}

bool OpenNiSensor::poll() {
    if (over_) return false;
    if (device_ == nullptr) {
        look_for_device();
        if (device_ == nullptr) return false;
    }
    switch (device_->poll(frame_)) {
    case CameraDevice::Step::frame:
        return accept();
    case CameraDevice::Step::over:
        over_ = true;
        return false;
    case CameraDevice::Step::lost:
        log_("openni2:" + address_.uri + " was unplugged; it goes on when it is back");
        device_.reset();
        looked_ = Clock::now();
        return false;
    default:
        return false;
    }
}

} // namespace toile::openni2_sensor
