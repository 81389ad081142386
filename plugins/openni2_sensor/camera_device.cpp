#include "openni2_sensor/camera_device.h"

#include "core/error.h"

#include <OpenNI.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::openni2_sensor {
namespace {

constexpr double kUsualView = 1.0226;    // radians: 58.6 degrees, of the cameras of this family
constexpr int kReadTimeout = 2000;       // milliseconds: a recording that gives nothing is over
constexpr int kFirstFrameTimeout = 1000; // milliseconds, at closing
constexpr std::int64_t kNanoseconds = 1000;
constexpr openni::DepthPixel kAllBits = 0xffff; // saturated too, whatever the device tells

Error failed(const std::string& uri, const std::string& what) {
    std::string told = openni::OpenNI::getExtendedError();
    while (!told.empty() && (told.back() == '\n' || told.back() == '\r' || told.back() == ' '))
        told.pop_back();
    std::replace(told.begin(), told.end(), '\n', ' ');
    return Error("openni2:" + uri + ": " + what + (told.empty() ? "" : ": " + told));
}

/// Whether a picture is what the stream's mode and our buffers promise.
bool fits(const openni::VideoFrameRef& frame, const imaging::Intrinsics& in,
          openni::PixelFormat format, int bytes_a_pixel) {
    return frame.getWidth() == in.width && frame.getHeight() == in.height &&
           frame.getVideoMode().getPixelFormat() == format &&
           frame.getStrideInBytes() >= in.width * bytes_a_pixel &&
           frame.getDataSize() >=
               frame.getStrideInBytes() * (in.height - 1) + in.width * bytes_a_pixel;
}

} // namespace

class CameraDevice::Streams : public openni::OpenNI::DeviceDisconnectedListener {
  public:
    explicit Streams(std::string uri) : uri_(std::move(uri)) {
        openni::OpenNI::addDeviceDisconnectedListener(this);
    }
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;
    ~Streams() override {
        openni::OpenNI::removeDeviceDisconnectedListener(this);
        wait_for_player();
        depth_frame.release();
        color_frame.release();
        for (openni::VideoStream* stream : {&color, &depth}) {
            if (!stream->isValid()) continue;
            stream->stop();
            stream->destroy();
        }
        if (device.isValid()) device.close();
    }

    void onDeviceDisconnected(const openni::DeviceInfo* info) override {
        if (uri_ == info->getUri()) gone = true;
    }

    openni::Device device;
    openni::VideoStream depth, color;
    openni::VideoFrameRef depth_frame, color_frame;
    std::atomic<bool> gone{false};
    int frames = 0, read = 0; ///< of a recording

  private:
    /// The player's thread, if it has not begun when its recording is closed, misses that and is
    /// waited for in vain, three seconds. A frame shows that it has begun.
    void wait_for_player() {
        if (frames == 0 || depth_frame.isValid()) return;
        openni::VideoStream* stream = &depth;
        int ready = 0;
        openni::OpenNI::waitForAnyStream(&stream, 1, &ready, kFirstFrameTimeout);
    }

    std::string uri_;
};

CameraDevice::CameraDevice(const OpenNiLibrary&, const Address& address,
                           const DeviceOptions& options)
    : streams_(std::make_unique<Streams>(address.uri)), recording_(address.recording),
      live_(options.live) {
    openni::Device& device = streams_->device;
    if (device.open(address.uri.c_str()) != openni::STATUS_OK)
        throw failed(address.uri,
                     recording_ ? "the recording cannot be played" : "cannot be opened");
    if (!device.hasSensor(openni::SENSOR_DEPTH) ||
        streams_->depth.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK)
        throw failed(address.uri, "gives no depth");
    if (device.hasSensor(openni::SENSOR_COLOR) &&
        streams_->color.create(device, openni::SENSOR_COLOR) != openni::STATUS_OK)
        throw failed(address.uri, "its colour camera does not start");
    describe(address, options);
    if (recording_) {
        openni::PlaybackControl& playing = *device.getPlaybackControl();
        // At a recording's end OpenNI2's player tells of a lost device and may then crash when it
        // is closed: let it begin anew, and stop at the last frame ourselves.
        playing.setRepeatEnabled(true);
        playing.setSpeed(live_ ? 1.0f : -1.0f);
        streams_->frames = playing.getNumberOfFrames(streams_->depth);
    }
    if (streams_->depth.start() != openni::STATUS_OK ||
        (streams_->color.isValid() && streams_->color.start() != openni::STATUS_OK))
        throw failed(address.uri, "does not start");
}

CameraDevice::~CameraDevice() = default;

bool CameraDevice::has_color() const noexcept {
    return streams_->color.isValid();
}

/// Sets the device up and learns what its pictures mean.
void CameraDevice::describe(const Address& address, const DeviceOptions& options) {
    openni::VideoStream &depth = streams_->depth, &color = streams_->color;
    const openni::VideoMode mode = depth.getVideoMode();
    switch (mode.getPixelFormat()) {
    case openni::PIXEL_FORMAT_DEPTH_1_MM:
        unit_m_ = 1e-3f;
        break;
    case openni::PIXEL_FORMAT_DEPTH_100_UM:
        unit_m_ = 1e-4f;
        break;
    default:
        throw failed(address.uri, "its depth is neither in millimetres nor in tenths of them");
    }
    const int largest = depth.getMaxPixelValue();
    if (largest > 0) saturated_ = largest;
    intrinsics_.width = mode.getResolutionX();
    intrinsics_.height = mode.getResolutionY();
    const double across = depth.getHorizontalFieldOfView();
    const double up = depth.getVerticalFieldOfView();
    guessed_view_ = !(across > 0.1 && across < 3.0 && up > 0.1 && up < 3.0);
    intrinsics_.fx =
        0.5 * intrinsics_.width / std::tan(0.5 * (guessed_view_ ? kUsualView : across));
    intrinsics_.fy = guessed_view_ ? intrinsics_.fx : 0.5 * intrinsics_.height / std::tan(0.5 * up);
    intrinsics_.cx = 0.5 * (intrinsics_.width - 1);
    intrinsics_.cy = 0.5 * (intrinsics_.height - 1);
    imaging::check_intrinsics(intrinsics_);
    period_s_ = mode.getFps() > 0 ? 1.0 / mode.getFps() : 1.0 / 30.0;

    if (color.isValid()) {
        const openni::VideoMode shown = color.getVideoMode();
        const bool usable = shown.getPixelFormat() == openni::PIXEL_FORMAT_RGB888 &&
                            shown.getResolutionX() == intrinsics_.width &&
                            shown.getResolutionY() == intrinsics_.height;
        if (!usable) color.destroy();
    }
    openni::Device& device = streams_->device;
    if (color.isValid() && recording_) {
        registered_ = options.recording_registered;
    } else if (color.isValid()) {
        const auto wanted = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
        registered_ = device.isImageRegistrationModeSupported(wanted) &&
                      device.setImageRegistrationMode(wanted) == openni::STATUS_OK;
        device.setDepthColorSyncEnabled(true); // where it can: else times may differ by a frame
    }
    // Recordings cannot be told to mirror, and some devices cannot either.
    const auto flips = [&](openni::VideoStream& stream) {
        if (!stream.isValid()) return false;
        if (!recording_) stream.setMirroringEnabled(options.mirrored);
        return stream.getMirroringEnabled() != options.mirrored;
    };
    flip_depth_ = flips(depth);
    flip_color_ = flips(color);
}

CameraDevice::Step CameraDevice::next_of_recording(SensedFrame& out) {
    if (streams_->read >= streams_->frames) return Step::over;
    openni::VideoStream* depth = &streams_->depth;
    int ready = 0;
    const int wait = live_ ? 0 : kReadTimeout;
    if (openni::OpenNI::waitForAnyStream(&depth, 1, &ready, wait) != openni::STATUS_OK)
        return live_ && !streams_->gone ? Step::nothing_new : Step::over;
    const Step step = take_depth(out);
    if (step == Step::nothing_new) return step;
    const int index = streams_->depth_frame.getFrameIndex();
    if (index < streams_->read) { // begun anew
        streams_->read = streams_->frames;
        return Step::over;
    }
    streams_->read = index;
    if (step != Step::frame || !streams_->color.isValid()) return step;
    openni::VideoStream* color = &streams_->color;
    // The colour of the same moment stands beside the depth.
    const std::int64_t wanted = out.timestamp_ns / kNanoseconds;
    const auto half = static_cast<std::int64_t>(0.5e6 * period_s_);
    for (bool late = true; late;) {
        if (openni::OpenNI::waitForAnyStream(&color, 1, &ready, wait) != openni::STATUS_OK) break;
        take_color(out);
        late = static_cast<std::int64_t>(streams_->color_frame.getTimestamp()) + half < wanted;
    }
    return Step::frame;
}

CameraDevice::Step CameraDevice::poll(SensedFrame& out) {
    if (recording_) return next_of_recording(out);
    if (streams_->gone) return Step::lost;
    openni::VideoStream* depth = &streams_->depth;
    int ready = 0;
    if (streams_->color.isValid()) {
        openni::VideoStream* color = &streams_->color;
        while (openni::OpenNI::waitForAnyStream(&color, 1, &ready, 0) == openni::STATUS_OK)
            take_color(out);
    }
    if (openni::OpenNI::waitForAnyStream(&depth, 1, &ready, 0) != openni::STATUS_OK)
        return streams_->gone ? Step::lost : Step::nothing_new;
    const Step step = take_depth(out);
    return streams_->gone ? Step::lost : step;
}

CameraDevice::Step CameraDevice::take_depth(SensedFrame& out) {
    openni::VideoFrameRef& frame = streams_->depth_frame;
    if (streams_->depth.readFrame(&frame) != openni::STATUS_OK) return Step::nothing_new;
    last_size_ = {frame.getWidth(), frame.getHeight()};
    const auto format =
        unit_m_ < 5e-4f ? openni::PIXEL_FORMAT_DEPTH_100_UM : openni::PIXEL_FORMAT_DEPTH_1_MM;
    if (!fits(frame, intrinsics_, format, sizeof(openni::DepthPixel))) return Step::wrong_size;
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    const auto height = static_cast<std::size_t>(intrinsics_.height);
    out.depth.assign(width * height, std::numeric_limits<float>::quiet_NaN());
    out.sequence = static_cast<std::uint32_t>(frame.getFrameIndex());
    out.timestamp_ns = static_cast<std::int64_t>(frame.getTimestamp()) * kNanoseconds;
    const auto* bytes = static_cast<const std::uint8_t*>(frame.getData());
    for (std::size_t y = 0; y < height; ++y) {
        const auto* row = reinterpret_cast<const openni::DepthPixel*>(
            bytes + y * static_cast<std::size_t>(frame.getStrideInBytes()));
        for (std::size_t x = 0; x < width; ++x)
            if (row[x] != 0 && row[x] != saturated_ && row[x] != kAllBits)
                out.depth[y * width + (flip_depth_ ? width - 1 - x : x)] =
                    unit_m_ * static_cast<float>(row[x]);
    }
    return Step::frame;
}

void CameraDevice::take_color(SensedFrame& out) {
    openni::VideoFrameRef& frame = streams_->color_frame;
    if (streams_->color.readFrame(&frame) != openni::STATUS_OK) return;
    if (!fits(frame, intrinsics_, openni::PIXEL_FORMAT_RGB888, 3)) return out.color.clear();
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    const auto height = static_cast<std::size_t>(intrinsics_.height);
    out.color.assign(4 * width * height, 255);
    const auto* bytes = static_cast<const std::uint8_t*>(frame.getData());
    for (std::size_t y = 0; y < height; ++y) {
        const auto* row = bytes + y * static_cast<std::size_t>(frame.getStrideInBytes());
        for (std::size_t x = 0; x < width; ++x)
            std::copy_n(row + 3 * x, 3,
                        out.color.begin() +
                            static_cast<std::ptrdiff_t>(
                                4 * (y * width + (flip_color_ ? width - 1 - x : x))));
    }
}

} // namespace toile::openni2_sensor
