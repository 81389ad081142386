// Kind toile.sensor/1: openni2:, a camera or an .oni recording.
#include "core/error.h"
#include "openni2_sensor/openni_sensor.h"
#include "sdk/host.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/sensor.h"
#include "sdk/views.h"

namespace {

namespace sdk = toile::sdk;
namespace oni = toile::openni2_sensor;

class OpenNi2Sensor {
  public:
    static constexpr sdk::Info info{.id = "toile.openni2_sensor",
                                    .name = "Depth cameras and .oni recordings",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Sensor>;
    using Extensions = sdk::Kinds<sdk::Parameters>;
    static constexpr std::array parameters{
        sdk::Parameter{"mirrored", TOILE_PARAMETER_SWITCH, "1",
                       "Pictures as a mirror shows them; counts from the next open", 0, 1, 0},
        sdk::Parameter{"recording_registered", TOILE_PARAMETER_SWITCH, "1",
                       "Colour of recordings is registered to depth; they do not say so themselves",
                       0, 1, 1}};

    explicit OpenNi2Sensor(sdk::Host host) : host_(host) {}

    double& parameter(std::size_t index) { return values_[index]; }
    void activate(const toile_limits& limits) { live_ = limits.live_clock != 0; }
    void reset() {
        if (sensor_) guarded([&] { sensor_->rewind(); });
    }

    void open(const char* uri, sdk::Job job) {
        sensor_.reset();
        oni::DeviceOptions options;
        options.mirrored = values_[0] != 0.0;
        options.recording_registered = values_[1] != 0.0;
        options.live = live_;
        guarded([&] {
            sensor_ = std::make_unique<oni::OpenNiSensor>(
                uri, options, [this](const std::string& text) { host_.warning(text); });
        });
        job.progress(1.0);
    }

    std::uint32_t stream_count() { return sensor_ ? 1 : 0; }

    toile_stream describe(std::uint32_t stream) {
        const oni::OpenNiSensor& sensor = opened(stream);
        toile_stream out{};
        out.size = sizeof(out);
        const toile::imaging::Intrinsics& in = sensor.intrinsics();
        out.depth = {static_cast<std::uint32_t>(in.width),
                     static_cast<std::uint32_t>(in.height),
                     in.fx,
                     in.fy,
                     in.cx,
                     in.cy,
                     {}};
        if (sensor.has_color()) out.color = out.depth;
        for (const std::size_t i : {0u, 5u, 10u, 15u})
            out.color_from_depth[i] = out.world_from_camera[i] = 1.0;
        out.registered = sensor.registered() ? 1 : 0;
        out.frame_period_s = sensor.period_s();
        return out;
    }

    toile_status poll(std::uint32_t stream, toile_frame& out) {
        (void)opened(stream);
        bool any = false;
        guarded([&] { any = sensor_->poll(); });
        if (!any) return sensor_->over() ? TOILE_END_OF_STREAM : TOILE_NO_NEW_DATA;
        const oni::SensedFrame& frame = sensor_->frame();
        out.camera = 0;
        out.sequence = frame.sequence;
        out.timestamp_ns = frame.timestamp_ns;
        out.depth_m = sdk::view_of<float>(frame.depth);
        out.color = sdk::view_of<sdk::Byte4>(
            {reinterpret_cast<const sdk::Byte4*>(frame.color.data()), frame.color.size() / 4});
        return TOILE_OK;
    }

    void release(const toile_frame&) {}

  private:
    template <class Work>
    static void guarded(Work&& work) {
        try {
            work();
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
    }
    oni::OpenNiSensor& opened(std::uint32_t stream) const {
        if (!sensor_) throw sdk::bad_argument("the sensor is not open");
        if (stream != 0) throw sdk::bad_argument("stream: there is one camera");
        return *sensor_;
    }

    sdk::Host host_;
    std::array<double, 2> values_{0.0, 1.0};
    bool live_ = false;
    std::unique_ptr<oni::OpenNiSensor> sensor_;
};

} // namespace

TOILE_PLUGIN(openni2_sensor, OpenNi2Sensor)
