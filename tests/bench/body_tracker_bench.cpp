// CPU of one frame of tracking, 320 x 240 and 640 x 480, one person, one thread: following, with a
// search, and the forest's part of it. Compare within one run.
//
//     body_tracker_bench --benchmark_format=json      counters: median_ms, p95_ms (CPU)
#include "body_tracker/parts_view.h"
#include "body_tracker/tests/drawn_room.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <ctime>

namespace {

using namespace toile;
using namespace toile::body_tracker;

constexpr int kKnown = 70, kFrames = 60;

double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::shared_ptr<const Forest> forest() {
    static const auto one = std::make_shared<Forest>(load_forest(
        std::filesystem::path(TOILE_SOURCE_DIR) / "plugins" / "body_tracker" / "adult.forest"));
    return one;
}

/// Each pixel of a small picture four times, as a camera of 640 x 480 has them.
std::vector<float> enlarged(const std::vector<float>& small) {
    std::vector<float> out(640 * 480);
    for (std::size_t y = 0; y < 480; ++y)
        for (std::size_t x = 0; x < 640; ++x)
            out[y * 640 + x] = small[(y / 2) * 320 + x / 2];
    return out;
}

imaging::Intrinsics large_camera(const imaging::Intrinsics& small) {
    imaging::Intrinsics out = small;
    out.width *= 2, out.height *= 2;
    out.fx *= 2.0, out.fy *= 2.0;
    out.cx = 2.0 * small.cx + 0.5, out.cy = 2.0 * small.cy + 0.5;
    return out;
}

/// Somebody waves; `searching`: is found anew every time.
void follow(benchmark::State& state, bool large, bool searching) {
    DrawnRoom room;
    std::vector<std::vector<float>> pictures;
    for (int f = 0; f < kKnown + kFrames; ++f) {
        room.clear();
        room.add(waving(f), 0.0f, 0.2f, 0.2f);
        pictures.push_back(large ? enlarged(room.depth) : room.depth);
    }
    const imaging::Intrinsics camera = large ? large_camera(room.camera) : room.camera;
    TrackingOptions options;
    options.person.forest = forest();
    std::vector<double> frames;
    const auto time = [&](BodyTracking& tracking, int f) {
        const double began = cpu_ms();
        tracking.update(pictures[static_cast<std::size_t>(f)].data(), frame_time(f));
        return cpu_ms() - began;
    };
    for (auto _ : state) {
        BodyTracking tracking(adult(), camera, room.world_from_camera, options);
        const int from = searching ? 0 : kKnown, to = searching ? 3 : kKnown + kFrames;
        for (int f = 0; f < to; ++f) {
            const double ms = time(tracking, f);
            if (f >= from) frames.push_back(ms);
        }
        if (!tracking.people()[0]->active()) return state.SkipWithError("nobody is followed");
    }
    std::sort(frames.begin(), frames.end());
    state.counters["median_ms"] = frames[frames.size() / 2];
    state.counters["p95_ms"] = frames[frames.size() * 95 / 100];
}

void tracked_frame_640(benchmark::State& state) {
    follow(state, true, false);
}
void tracked_frame_320(benchmark::State& state) {
    follow(state, false, false);
}
void searching_frame_640(benchmark::State& state) {
    follow(state, true, true);
}

BENCHMARK(tracked_frame_640)->Unit(benchmark::kMillisecond);
BENCHMARK(tracked_frame_320)->Unit(benchmark::kMillisecond);
BENCHMARK(searching_frame_640)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
