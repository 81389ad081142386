// A driver for OpenNI2 that has two cameras of its own: pictures that tests can work out, unplugged
// and plugged in as a test wants. Loaded by the real library from its folder of drivers.
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

class Stream : public driver::StreamBase {
  public:
    Stream(OniSensorType sensor, const std::atomic<bool>& plugged)
        : sensor_(sensor), plugged_(plugged) {}
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
               property == ONI_STREAM_PROPERTY_MIRRORING;
    }

  private:
    void run() {
        const auto began = std::chrono::steady_clock::now();
        for (int number = 1; running_; ++number) {
            std::this_thread::sleep_until(
                began + std::chrono::microseconds(number * 1000000LL / kFramesPerSecond));
            if (plugged_ && running_) send(number);
        }
    }
    void send(int number) {
        OniFrame* frame = getServices().acquireFrame();
        if (frame == nullptr) return;
        const bool depth = sensor_ == ONI_SENSOR_DEPTH;
        frame->frameIndex = number;
        frame->timestamp = static_cast<std::uint64_t>(number) * 1000000 / kFramesPerSecond;
        frame->sensorType = sensor_;
        frame->videoMode = mode_of(sensor_);
        frame->width = kWidth;
        frame->height = kHeight;
        frame->stride = kWidth * (depth ? 2 : 3);
        frame->dataSize = frame->stride * kHeight;
        frame->croppingEnabled = 0;
        frame->cropOriginX = frame->cropOriginY = 0;
        auto* bytes = static_cast<std::uint8_t*>(frame->data);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const int from = mirrored_ ? kWidth - 1 - x : x;
                if (depth) {
                    const std::uint16_t value = depth_at(from, y, number);
                    std::memcpy(bytes + y * frame->stride + 2 * x, &value, 2);
                } else {
                    for (int c = 0; c < 3; ++c)
                        bytes[y * frame->stride + 3 * x + c] = color_at(from, y, c, number);
                }
            }
        raiseNewFrame(frame);
        getServices().releaseFrame(frame);
    }

    OniSensorType sensor_;
    const std::atomic<bool>& plugged_;
    std::atomic<bool> running_{false}, mirrored_{true}; // as real ones begin
    std::thread thread_;
};

class Camera : public driver::DeviceBase {
  public:
    explicit Camera(const std::atomic<bool>& plugged) : plugged_(plugged) {
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
        return new Stream(sensor, plugged_);
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
    const std::atomic<bool>& plugged_;
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
            plugged_[i] = true;
            deviceConnected(&infos_[i]);
        }
        return ONI_STATUS_OK;
    }
    driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
        for (std::size_t i = 0; i < kUris.size(); ++i)
            if (std::strcmp(uri, kUris[i]) == 0 && plugged_[i]) return new Camera(plugged_[i]);
        return nullptr;
    }
    void deviceClose(driver::DeviceBase* device) override { delete device; }
    void shutdown() override {}

    void plug(std::size_t camera, bool in) {
        if (plugged_[camera].exchange(in) == in) return;
        in ? deviceConnected(&infos_[camera]) : deviceDisconnected(&infos_[camera]);
    }

  private:
    std::array<OniDeviceInfo, 2> infos_{};
    std::array<std::atomic<bool>, 2> plugged_{};
};

} // namespace

/// For tests: the library has loaded this driver already.
extern "C" ONI_API_EXPORT void toile_test_plug(int camera, int in) {
    if (the_driver != nullptr) the_driver->plug(static_cast<std::size_t>(camera), in != 0);
}

ONI_EXPORT_DRIVER(TestDriver)
