// A driver for OpenNI2 that has two cameras of its own: pictures that tests can work out,
// unplugged, plugged in and doing wrong as a test wants. Loaded by the real library from its folder
// of drivers.
#include "openni2_sensor/tests/driver/test_pictures.h"

// OpenNI2 ships this header without the one that these come from.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

namespace {

namespace driver = oni::driver;
using namespace toile::openni2_sensor::test;

template <class T>
OniStatus give(const T& value, void* data, int* size) {
    if (*size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, &value, sizeof(T));
    return ONI_STATUS_OK;
}

OniVideoMode mode_of(OniSensorType sensor) {
    return {sensor == ONI_SENSOR_DEPTH ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888,
            kWidth, kHeight, kFramesPerSecond};
}

constexpr std::uint64_t kBeginUs = 1'000'000'000; // of the cameras' clock, so that it can go back

/// What tests wish of a camera.
struct Wishes {
    std::atomic<bool> plugged{false};
    std::atomic<Fault> fault{Fault::none}; ///< taken by its depth stream
};

class Stream : public driver::StreamBase {
  public:
    Stream(OniSensorType sensor, Wishes& wishes) : sensor_(sensor), wishes_(wishes) {}
    ~Stream() override { Stream::stop(); }

    OniStatus start() override {
        running_ = true;
        thread_ = std::thread([this] { run(); });
        return ONI_STATUS_OK;
    }
    void stop() override {
        running_ = false;
        if (thread_.joinable()) thread_.join();
    }
    OniStatus getProperty(int property, void* data, int* size) override {
        switch (property) {
        case ONI_STREAM_PROPERTY_VIDEO_MODE:
            return give(mode_of(sensor_), data, size);
        case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            return give(kAcross, data, size);
        case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            return give(kUp, data, size);
        case ONI_STREAM_PROPERTY_MAX_VALUE:
            return give(kLargestDepth, data, size);
        case ONI_STREAM_PROPERTY_MIRRORING:
            return give(OniBool{mirrored_ ? 1 : 0}, data, size);
        default:
            return ONI_STATUS_NOT_IMPLEMENTED;
        }
    }
    OniStatus setProperty(int property, const void* data, int size) override {
        if (property != ONI_STREAM_PROPERTY_MIRRORING || size != sizeof(OniBool))
            return ONI_STATUS_NOT_IMPLEMENTED;
        OniBool wanted = 0;
        std::memcpy(&wanted, data, sizeof(wanted));
        mirrored_ = wanted != 0;
        return ONI_STATUS_OK;
    }
    OniBool isPropertySupported(int property) override {
        return property == ONI_STREAM_PROPERTY_VIDEO_MODE ||
               property == ONI_STREAM_PROPERTY_HORIZONTAL_FOV ||
               property == ONI_STREAM_PROPERTY_VERTICAL_FOV ||
               property == ONI_STREAM_PROPERTY_MAX_VALUE ||
               property == ONI_STREAM_PROPERTY_MIRRORING;
    }

    int getRequiredFrameSize() override { return 4 * 3 * kWidth * kHeight; } // of larger ones too

  private:
    struct Picture {
        int number = 0, index = 0;
        std::uint64_t time_us = 0;
        Fault fault = Fault::none;
    };
    void run() {
        const auto began = std::chrono::steady_clock::now();
        for (int number = 1; running_; ++number) {
            std::this_thread::sleep_until(
                began + std::chrono::microseconds(number * 1000000LL / kFramesPerSecond));
            if (wishes_.plugged && running_ && number >= silent_until_) send_next(number);
        }
    }
    void send_next(int number) {
        const bool depth = sensor_ == ONI_SENSOR_DEPTH;
        const Fault wished = wishes_.fault.load();
        const bool lasts = wished == Fault::smaller_from_now || wished == Fault::clock_stands_still;
        const Fault fault = !depth  ? Fault::none
                            : lasts ? wished
                                    : wishes_.fault.exchange(Fault::none);
        if (fault == Fault::clock_back) clock_us_ -= 10'000'000;
        if (fault == Fault::clock_ahead) clock_us_ += 600'000'000;
        if (fault == Fault::counts_anew) count_ = 1 - number;
        if (fault == Fault::count_ahead) count_ += 1'000'000;
        if (fault == Fault::ten_dropped) {
            silent_until_ = number + 10;
            return;
        }
        const Picture before = last_;
        const auto time_us = static_cast<std::int64_t>(kBeginUs) +
                             std::int64_t{number} * 1000000 / kFramesPerSecond + clock_us_;
        last_ = {number, number + count_, static_cast<std::uint64_t>(time_us), fault};
        if (fault == Fault::clock_stands_still) last_.time_us = before.time_us;
        send(last_);
        const auto pause = std::chrono::milliseconds(5); // so that it is seen as one of its own
        if (fault == Fault::twice || fault == Fault::late) {
            std::this_thread::sleep_for(pause);
            send(fault == Fault::twice ? last_ : before);
        }
    }
    void send(const Picture& picture) {
        OniFrame* frame = getServices().acquireFrame();
        if (frame == nullptr) return;
        const bool depth = sensor_ == ONI_SENSOR_DEPTH;
        const Fault fault = picture.fault;
        const bool small = fault == Fault::smaller || fault == Fault::smaller_from_now;
        frame->frameIndex = picture.index;
        frame->timestamp = picture.time_us;
        frame->sensorType = sensor_;
        frame->videoMode = mode_of(sensor_);
        frame->width = small ? kWidth / 2 : fault == Fault::larger ? 2 * kWidth : kWidth;
        frame->height = small ? kHeight / 2 : fault == Fault::larger ? 2 * kHeight : kHeight;
        frame->videoMode.resolutionX = frame->width;
        frame->videoMode.resolutionY = frame->height;
        if (fault == Fault::other_format)
            frame->videoMode.pixelFormat = ONI_PIXEL_FORMAT_DEPTH_100_UM;
        frame->stride = frame->width * (depth ? 2 : 3);
        frame->dataSize = frame->stride * frame->height;
        frame->croppingEnabled = 0;
        frame->cropOriginX = frame->cropOriginY = 0;
        for (int y = 0; y < frame->height; ++y)
            for (int x = 0; x < frame->width; ++x)
                draw(*frame, picture, x, y);
        raiseNewFrame(frame);
        getServices().releaseFrame(frame);
    }
    void draw(const OniFrame& frame, const Picture& picture, int x, int y) const {
        auto* row = static_cast<std::uint8_t*>(frame.data) + y * frame.stride;
        const int from = mirrored_ ? kWidth - 1 - x : x;
        if (sensor_ != ONI_SENSOR_DEPTH) {
            for (int c = 0; c < 3; ++c)
                row[3 * x + c] = color_at(from, y, c, picture.number);
            return;
        }
        std::uint16_t value = depth_at(from, y, picture.number);
        if (picture.fault == Fault::all_zero) value = 0;
        if (picture.fault == Fault::all_saturated) value = kLargestDepth;
        std::memcpy(row + 2 * x, &value, 2);
    }

    OniSensorType sensor_;
    Wishes& wishes_;
    std::atomic<bool> running_{false}, mirrored_{true}; // as real ones begin
    Picture last_;
    std::int64_t clock_us_ = 0;
    int count_ = 0, silent_until_ = 0;
    std::thread thread_;
};

class Camera : public driver::DeviceBase {
  public:
    explicit Camera(Wishes& wishes) : wishes_(wishes) {
        for (std::size_t i = 0; i < 2; ++i) {
            const OniSensorType sensor = i == 0 ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR;
            modes_[i] = mode_of(sensor);
            infos_[i] = {sensor, 1, &modes_[i]};
        }
    }
    OniStatus getSensorInfoList(OniSensorInfo** infos, int* count) override {
        *infos = infos_.data();
        *count = static_cast<int>(infos_.size());
        return ONI_STATUS_OK;
    }
    driver::StreamBase* createStream(OniSensorType sensor) override {
        return new Stream(sensor, wishes_);
    }
    void destroyStream(driver::StreamBase* stream) override { delete stream; }
    OniStatus getProperty(int property, void* data, int* size) override {
        if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION)
            return give(registration_, data, size);
        return ONI_STATUS_NOT_IMPLEMENTED;
    }
    OniStatus setProperty(int property, const void* data, int size) override {
        if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != sizeof(registration_))
            return ONI_STATUS_NOT_IMPLEMENTED;
        std::memcpy(&registration_, data, sizeof(registration_));
        return ONI_STATUS_OK;
    }
    OniBool isPropertySupported(int property) override {
        return property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
    }
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return 1; }

  private:
    Wishes& wishes_;
    std::array<OniVideoMode, 2> modes_{};
    std::array<OniSensorInfo, 2> infos_{};
    OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
};

class TestDriver;
TestDriver* the_driver = nullptr;

class TestDriver : public driver::DriverBase {
  public:
    explicit TestDriver(OniDriverServices* services) : DriverBase(services) { the_driver = this; }
    ~TestDriver() override { the_driver = nullptr; }

    OniStatus initialize(driver::DeviceConnectedCallback connected,
                         driver::DeviceDisconnectedCallback disconnected,
                         driver::DeviceStateChangedCallback changed, void* cookie) override {
        DriverBase::initialize(connected, disconnected, changed, cookie);
        for (std::size_t i = 0; i < kUris.size(); ++i) {
            std::strncpy(infos_[i].uri, kUris[i], ONI_MAX_STR - 1);
            std::strncpy(infos_[i].vendor, "Toile", ONI_MAX_STR - 1);
            std::strncpy(infos_[i].name, "Test camera", ONI_MAX_STR - 1);
            wishes_[i].plugged = true;
            deviceConnected(&infos_[i]);
        }
        return ONI_STATUS_OK;
    }
    driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
        for (std::size_t i = 0; i < kUris.size(); ++i)
            if (std::strcmp(uri, kUris[i]) == 0 && wishes_[i].plugged)
                return new Camera(wishes_[i]);
        return nullptr;
    }
    void deviceClose(driver::DeviceBase* device) override { delete device; }
    void shutdown() override {}

    void plug(std::size_t camera, bool in) {
        if (wishes_[camera].plugged.exchange(in) == in) return;
        in ? deviceConnected(&infos_[camera]) : deviceDisconnected(&infos_[camera]);
    }
    void wish(std::size_t camera, Fault fault) { wishes_[camera].fault = fault; }

  private:
    std::array<OniDeviceInfo, 2> infos_{};
    std::array<Wishes, 2> wishes_;
};

} // namespace

/// For tests: the library has loaded this driver already.
extern "C" ONI_API_EXPORT void toile_test_plug(int camera, int in) {
    if (the_driver != nullptr) the_driver->plug(static_cast<std::size_t>(camera), in != 0);
}
extern "C" ONI_API_EXPORT void toile_test_wish(int camera, int fault) {
    if (the_driver != nullptr)
        the_driver->wish(static_cast<std::size_t>(camera), static_cast<Fault>(fault));
}

ONI_EXPORT_DRIVER(TestDriver)
