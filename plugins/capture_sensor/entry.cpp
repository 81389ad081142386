// Kind toile.sensor/1: capture:DIR.
#include "capture_sensor/capture_player.h"
#include "core/error.h"
#include "sdk/plugin.h"
#include "sdk/sensor.h"
#include "sdk/views.h"

#include <chrono>
#include <memory>

namespace {

namespace sdk = toile::sdk;
using toile::capture_sensor::CapturePlayer;
using toile::capture_sensor::PlayedFrame;

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class CaptureSensor {
  public:
    static constexpr sdk::Info info{.id = "toile.capture_sensor",
                                    .name = "Recorded camera pictures",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Sensor>;

    explicit CaptureSensor(sdk::Host) {}

    void activate(const toile_limits& limits) { live_ = limits.live_clock != 0; }
    void reset() {
        if (player_) player_->rewind();
        started_s_.reset();
    }

    void open(const char* uri, sdk::Job job) {
        player_.reset();
        started_s_.reset();
        if (*uri == '\0') throw sdk::bad_argument("capture: names no folder (capture:DIR)");
        try {
            player_ = std::make_unique<CapturePlayer>(uri);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        job.progress(1.0);
    }

    std::uint32_t stream_count() {
        return player_ ? static_cast<std::uint32_t>(player_->capture().cameras.size()) : 0;
    }

    toile_stream describe(std::uint32_t stream) {
        const toile::imaging::CaptureCamera& camera = of(stream);
        toile_stream out{};
        out.size = sizeof(out);
        out.camera = stream;
        const toile::imaging::Intrinsics& in = camera.intrinsics;
        out.depth = {static_cast<std::uint32_t>(in.width),
                     static_cast<std::uint32_t>(in.height),
                     in.fx,
                     in.fy,
                     in.cx,
                     in.cy,
                     {}};
        std::copy(in.distortion.begin(), in.distortion.end(), out.depth.distortion);
        if (player_->has_color(stream)) out.color = out.depth;
        const Eigen::Isometry3d world =
            camera.world_from_camera.value_or(Eigen::Isometry3d::Identity());
        std::copy_n(world.matrix().data(), 16, out.world_from_camera);
        const Eigen::Matrix4d same = Eigen::Matrix4d::Identity();
        std::copy_n(same.data(), 16, out.color_from_depth);
        out.has_world = camera.world_from_camera ? 1 : 0;
        out.registered = 1;
        out.frame_period_s = player_->period(stream);
        return out;
    }

    toile_status poll(std::uint32_t stream, toile_frame& out) {
        (void)of(stream);
        std::optional<double> elapsed_s;
        if (live_) {
            if (!started_s_) started_s_ = wall_seconds();
            elapsed_s = wall_seconds() - *started_s_;
        }
        CapturePlayer::Step step{};
        try {
            step = player_->advance(stream, elapsed_s);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        if (step == CapturePlayer::Step::over) return TOILE_END_OF_STREAM;
        if (step == CapturePlayer::Step::nothing_new) return TOILE_NO_NEW_DATA;
        const PlayedFrame& frame = player_->frame(stream);
        out.camera = stream;
        out.sequence = frame.sequence;
        out.timestamp_ns = frame.timestamp_ns;
        out.depth_m = sdk::view_of<float>(frame.depth.metres);
        out.color = sdk::view_of<sdk::Byte4>(
            {reinterpret_cast<const sdk::Byte4*>(frame.color.pixels.data()),
             frame.color.pixels.size() / 4});
        return TOILE_OK;
    }

    void release(const toile_frame&) {}

  private:
    const toile::imaging::CaptureCamera& of(std::uint32_t stream) const {
        if (!player_) throw sdk::bad_argument("the sensor is not open");
        if (stream >= player_->capture().cameras.size())
            throw sdk::bad_argument("stream: there is no such camera");
        return player_->capture().cameras[stream];
    }

    std::unique_ptr<CapturePlayer> player_;
    bool live_ = false;
    std::optional<double> started_s_; // live clock: when the first frame was asked for
};

} // namespace

TOILE_PLUGIN(capture_sensor, CaptureSensor)
