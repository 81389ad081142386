// Rules of toile.sensor/1.
#include "host/contract_bench.h"

#include <cmath>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

constexpr int kMostFrames = 3000;
constexpr std::uint32_t kMostStreams = 64;

void refuses_wrong_calls(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_sensor>();
    bench.fails("open", "without a URI", [&](auto* i) { return table.open(i, nullptr, nullptr); });
    bench.fails("open", "for a file that is not there",
                [&](auto* i) { return table.open(i, "/no/such/file.contract", nullptr); });
    auto frame = sized<toile_frame>();
    bench.fails("poll", "before open", [&](auto* i) { return table.poll(i, 0, &frame); });
    auto stream = sized<toile_stream>();
    bench.fails("describe", "before open", [&](auto* i) { return table.describe(i, 0, &stream); });
}

/// A sensor whose own sample is open.
class OpenSample {
  public:
    OpenSample(const PluginPtr& plugin, std::uint32_t threads) : bench_(plugin, threads) {
        bench_.activate();
        const std::string sample = plugin->manifest().sample.string();
        Job job;
        bench_.ok("open", [&](auto* i) { return table().open(i, sample.c_str(), job.handle()); });
        count_ = table().stream_count(bench_.instance().handle());
        bench_.rule(count_ > 0 && count_ <= kMostStreams, "stream_count: no cameras, or too many");
    }

    Bench& bench() { return bench_; }
    const toile_sensor& table() { return bench_.table<toile_sensor>(); }
    [[nodiscard]] std::uint32_t count() const { return count_; }

    toile_stream describe(std::uint32_t stream) {
        auto out = sized<toile_stream>();
        bench_.ok("describe", [&](auto* i) { return table().describe(i, stream, &out); });
        return out;
    }

    /// Bytes of every picture of one stream, to its end.
    std::vector<unsigned char> play(std::uint32_t stream) {
        const toile_stream told = describe(stream);
        const std::size_t pixels = std::size_t{told.depth.width} * told.depth.height;
        std::vector<unsigned char> out;
        std::int64_t last_ns = INT64_MIN;
        std::int64_t last_sequence = -1;
        toile_status status = TOILE_OK;
        for (int n = 0; n < kMostFrames && status != TOILE_END_OF_STREAM; ++n) {
            Longer<toile_frame> frame(sized<toile_frame>());
            status =
                bench_.ok("poll", [&](auto* i) { return table().poll(i, stream, frame.get()); });
            if (status != TOILE_OK) continue;
            check(*frame.get(), told, stream, pixels);
            bench_.rule(frame.get()->timestamp_ns > last_ns, "poll: time does not rise");
            bench_.rule(frame.get()->sequence > last_sequence, "poll: sequence does not rise");
            last_ns = frame.get()->timestamp_ns;
            last_sequence = frame.get()->sequence;
            append(out, frame.get()->depth_m, pixels * sizeof(float));
            append(out, frame.get()->color, std::size_t{frame.get()->color.count} * 4);
            table().release(bench_.instance().handle(), frame.get());
        }
        auto frame = sized<toile_frame>();
        bench_.ok("poll", [&](auto* i) { return status = table().poll(i, stream, &frame); });
        bench_.rule(status == TOILE_END_OF_STREAM, "poll: goes on after the end of the recording");
        return out;
    }

  private:
    void check(const toile_frame& frame, const toile_stream& told, std::uint32_t stream,
               std::size_t pixels) {
        bench_.rule(frame.camera == told.camera && stream < count_,
                    "poll: a frame of another camera than described");
        bench_.rule(frame.depth_m.format == TOILE_F32 && frame.depth_m.stride == sizeof(float) &&
                        frame.depth_m.count == pixels && frame.depth_m.data != nullptr,
                    "poll: depth is not one float a pixel");
        const auto* depth = static_cast<const float*>(frame.depth_m.data);
        for (std::size_t i = 0; i < pixels; ++i)
            bench_.rule(std::isnan(depth[i]) || (depth[i] > 0.0f && std::isfinite(depth[i])),
                        "poll: a depth that is neither positive nor NaN");
        if (frame.color.count == 0) return;
        bench_.rule(frame.color.format == TOILE_U8X4 && frame.color.stride == 4 &&
                        frame.color.count == std::size_t{told.color.width} * told.color.height,
                    "poll: colour is not of the described size");
    }

    static void append(std::vector<unsigned char>& out, const toile_view& view, std::size_t bytes) {
        const auto* data = static_cast<const unsigned char*>(view.data);
        if (bytes > 0) out.insert(out.end(), data, data + bytes);
    }

    Bench bench_;
    std::uint32_t count_ = 0;
};

void describes_its_cameras(const PluginPtr& plugin) {
    if (plugin->manifest().sample.empty()) return;
    OpenSample sample(plugin, 1);
    for (std::uint32_t k = 0; k < sample.count(); ++k) {
        const toile_stream told = sample.describe(k);
        const toile_intrinsics& in = told.depth;
        sample.bench().rule(in.width > 0 && in.height > 0 && in.fx > 0 && in.fy > 0 &&
                                std::isfinite(in.cx + in.cy + in.fx + in.fy),
                            "describe: intrinsics that make no sense");
        sample.bench().rule(told.frame_period_s > 0 && std::isfinite(told.frame_period_s),
                            "describe: a frame period that is not positive");
        double off = 0.0; // the rotation's columns are orthonormal
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                double dot = 0.0;
                for (int r = 0; r < 3; ++r)
                    dot += told.world_from_camera[4 * a + r] * told.world_from_camera[4 * b + r];
                off = std::max(off, std::abs(dot - (a == b ? 1.0 : 0.0)));
            }
        sample.bench().rule(told.has_world == 0 || off < 1e-6,
                            "describe: world_from_camera is not a rigid motion");
    }
    auto beyond = sized<toile_stream>();
    sample.bench().fails("describe", "for a camera that is not there", [&](auto* i) {
        return sample.table().describe(i, sample.count(), &beyond);
    });
    auto frame = sized<toile_frame>();
    sample.bench().fails("poll", "for a camera that is not there",
                         [&](auto* i) { return sample.table().poll(i, sample.count(), &frame); });
}

void plays_its_sample(const PluginPtr& plugin) {
    if (plugin->manifest().sample.empty()) return;
    OpenSample once(plugin, 1);
    OpenSample again(plugin, 2);
    for (std::uint32_t k = 0; k < once.count(); ++k) {
        const auto first = once.play(k);
        once.bench().rule(!first.empty(), "poll: gives no frame of the plugin's own sample");
        once.bench().rule(first == again.play(k), "poll: two runs give different bytes");
    }
    // After a reset the recording begins anew.
    once.bench().instance().reset();
    const auto anew = once.play(0);
    again.bench().instance().reset();
    once.bench().rule(!anew.empty() && anew == again.play(0),
                      "reset: the recording does not begin anew");
}

constexpr ContractCase kCases[] = {
    {TOILE_SENSOR, "sensor: wrong calls are refused with a text", &refuses_wrong_calls},
    {TOILE_SENSOR, "sensor: describes its cameras", &describes_its_cameras},
    {TOILE_SENSOR, "sensor: its sample plays to the end, twice the same", &plays_its_sample},
};

} // namespace

std::span<const ContractCase> sensor_cases() {
    return kCases;
}

} // namespace toile::host
