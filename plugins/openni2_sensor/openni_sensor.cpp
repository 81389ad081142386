#include "openni2_sensor/openni_sensor.h"

#include "core/error.h"

#include <algorithm>
#include <cstdio>

namespace toile::openni2_sensor {
namespace {

constexpr std::chrono::milliseconds kLookAgain{500};
constexpr int kMostWrong = 30; // pictures of a wrong size, one after another

std::string text_of(const PictureSize& size) {
    return std::to_string(size.width) + " x " + std::to_string(size.height);
}

std::int64_t nanoseconds(std::chrono::steady_clock::duration time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
}

} // namespace

OpenNiSensor::OpenNiSensor(const std::string& source, const DeviceOptions& options, Log log)
    : library_(OpenNiLibrary::running()), options_(options), log_(std::move(log)),
      address_(library_.post([&] { return resolve(source, library_); }).get()),
      device_(open_device()), clock_(device_->period_s()) {
    intrinsics_ = device_->intrinsics();
    has_color_ = device_->has_color();
    registered_ = device_->registered();
    period_s_ = device_->period_s();
    if (device_->guessed_view())
        log_("openni2:" + address_.uri +
             " does not tell its field of view; 58.6 degrees across are taken");
}

OpenNiSensor::~OpenNiSensor() {
    if (returning_.valid()) device_ = returning_.get();
    close_device().wait();
}

std::unique_ptr<CameraDevice> OpenNiSensor::open_device() const {
    return library_
        .post([this] { return std::make_unique<CameraDevice>(library_, address_, options_); })
        .get();
}

std::future<void> OpenNiSensor::close_device() {
    return library_.post(
        [device = std::shared_ptr<CameraDevice>(std::move(device_))]() mutable { device.reset(); });
}

void OpenNiSensor::rewind() {
    if (!address_.recording || (!begun_ && !options_.live)) return;
    over_ = begun_ = false;
    // OpenNI2's own seeking crashes on some recordings: opened anew instead.
    close_device().wait();
    device_ = open_device();
    clock_ = FrameClock(period_s_);
    wrong_in_a_row_ = 0;
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
            close_device();
            looked_ = Clock::now() + std::chrono::hours(1);
            return;
        }
        clock_.resume(nanoseconds(Clock::now() - last_seen_));
        log_("openni2:" + address_.uri + " is back");
        return;
    }
    if (Clock::now() - looked_ < kLookAgain) return;
    looked_ = Clock::now();
    returning_ = library_.post([this]() -> std::unique_ptr<CameraDevice> {
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

/// Gives the device's frame its number and time in the stream; false for one to be left out.
bool OpenNiSensor::accept() {
    wrong_in_a_row_ = 0;
    const Clock::time_point now = Clock::now();
    std::optional<std::int64_t> waited_ns;
    if (!address_.recording) waited_ns = nanoseconds(now - last_seen_);
    switch (clock_.take({frame_.sequence, frame_.timestamp_ns}, waited_ns)) {
    case FrameClock::Verdict::repeated:
        ++faults_.repeated;
        return false;
    case FrameClock::Verdict::late:
        ++faults_.late;
        return false;
    default:
        break;
    }
    if (clock_.jump_ns() != 0 && ++faults_.clock_jumps == 1) {
        std::array<char, 32> seconds{};
        std::snprintf(seconds.data(), seconds.size(), "%+.3f",
                      1e-9 * static_cast<double>(clock_.jump_ns()));
        log_("openni2:" + address_.uri + ": its clock jumped by " + seconds.data() +
             " s; frames keep their usual distance (later jumps are not told)");
    }
    last_seen_ = now;
    frame_.sequence = clock_.stamp().number;
    frame_.timestamp_ns = clock_.stamp().time_ns;
    return true;
}

void OpenNiSensor::note_wrong_size() {
    ++faults_.wrong_size;
    const std::string what = "openni2:" + address_.uri + ": a picture is " +
                             text_of(device_->last_size()) + " pixels, described were " +
                             text_of({intrinsics_.width, intrinsics_.height});
    if (faults_.wrong_size == 1) log_(what + "; it is left out (later ones are not told)");
    if (++wrong_in_a_row_ < kMostWrong) return;
    close_device();
    over_ = true;
    throw Error(what + ", and so were the " + std::to_string(kMostWrong - 1) +
                " before; set it to one size and open it anew");
}

bool OpenNiSensor::poll() {
    if (over_) return false;
    begun_ = true;
    if (device_ == nullptr) {
        look_for_device();
        if (device_ == nullptr) return false;
    }
    switch (device_->poll(frame_)) {
    case CameraDevice::Step::frame:
        return accept();
    case CameraDevice::Step::wrong_size:
        note_wrong_size();
        return false;
    case CameraDevice::Step::over:
        over_ = true;
        return false;
    case CameraDevice::Step::lost:
        log_("openni2:" + address_.uri + " was unplugged; it goes on when it is back");
        close_device();
        looked_ = Clock::now();
        return false;
    default:
        return false;
    }
}

} // namespace toile::openni2_sensor
