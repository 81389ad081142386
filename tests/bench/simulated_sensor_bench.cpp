// One frame of a simulated Kinect v1 (640 x 480) before a mannequin of 26k triangles in a room,
// one thread: posing and the search tree, rays alone, with every error, and with colour.
//
//     simulated_sensor_bench --benchmark_format=json        times are CPU milliseconds a frame
#include "core/bytes.h"
#include "simulated_sensor/simulator.h"
#include "support/temporary_folder.h"

#include <benchmark/benchmark.h>

namespace {

using namespace toile;
using simulated_sensor::Simulator;

Simulator& turning(const std::string& noise, bool color) {
    static std::map<std::string, std::unique_ptr<Simulator>> made;
    auto& found = made[noise + (color ? "color" : "")];
    if (found) return *found;
    const test::TemporaryFolder folder;
    write_text(folder / "bench.json", R"({"schema": 1, "frames": 1000, "noise": {"preset": ")" +
                                          noise + R"("}, "color": )" + (color ? "true" : "false") +
                                          R"(, "people": [{"body": {"avatar": ")" +
                                          TOILE_SOURCE_DIR +
                                          R"(/avatars/mannequin"}, "turntable_s": 10}],
                   "scene": {"walls": [{"position": [0, 0, -1.5]}]},
                   "cameras": [{"mount": "upright", "position": [0, 1, 1.8]}]})");
    found = std::make_unique<Simulator>(simulated_sensor::load_scenario(folder / "bench.json"));
    return *found;
}

/// Shows and sees frame after frame.
void play(benchmark::State& state, const std::string& noise, bool color, bool pose, bool see) {
    Simulator& simulator = turning(noise, color);
    std::uint32_t frame = 0;
    simulator.show(0);
    simulator.see(0);
    for (auto _ : state) {
        if (pose) simulator.show(++frame % 1000);
        if (see) simulator.see(0);
        benchmark::ClobberMemory();
    }
}

void pose_and_tree(benchmark::State& state) {
    play(state, "none", false, true, false);
}
void rays_alone(benchmark::State& state) {
    play(state, "none", false, false, true);
}
void depth_and_noise(benchmark::State& state) {
    play(state, "usual", false, true, true);
}
void depth_and_full_noise(benchmark::State& state) {
    play(state, "full", false, true, true);
}
void depth_noise_and_color(benchmark::State& state) {
    play(state, "full", true, true, true);
}

BENCHMARK(pose_and_tree)->Unit(benchmark::kMillisecond);
BENCHMARK(rays_alone)->Unit(benchmark::kMillisecond);
BENCHMARK(depth_and_noise)->Unit(benchmark::kMillisecond);
BENCHMARK(depth_and_full_noise)->Unit(benchmark::kMillisecond);
BENCHMARK(depth_noise_and_color)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
