// Frame cost of skinning + targets + cloth for one garment, 1/30 s frames, one thread; beside it
// its parts alone and the cloth without what makes it cheap, to compare within one run.
//
//     tryon_frame_bench --benchmark_format=json      counters: median_ms, p95_ms (CPU), vertices
#include "bench/dressed_scene.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <ctime>
#include <filesystem>

namespace {

using namespace toile;

constexpr double kFrame = 1.0 / 30.0;
constexpr int kFrames = 90;

const body::BodyModel& mannequin() {
    static const body::BodyModel model =
        body::load_body_model(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "mannequin");
    return model;
}

/// The walk that the repository brings, frame by frame.
const std::vector<body::JointTransforms>& walk() {
    static const std::vector<body::JointTransforms> frames = [] {
        const body::Motion motion = body::load_motion(std::filesystem::path(TOILE_SOURCE_DIR) /
                                                          "avatars" / "motions" / "walk.json",
                                                      mannequin().skeleton);
        std::vector<body::JointTransforms> made;
        for (int i = 0; i < kFrames; ++i) {
            const double time = std::fmod(i * kFrame, std::max(kFrame, motion.duration()));
            made.push_back(
                body::forward_kinematics(mannequin().skeleton, body::sample(motion, time)));
        }
        return made;
    }();
    return frames;
}

double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Plays the walk once per iteration and reports the frames' distribution.
void play(benchmark::State& state, const bullet_cloth::Settings& settings, bool cloth) {
    bench::DressedScene scene(mannequin(), settings);
    std::vector<double> frames;
    for (auto _ : state) {
        for (std::size_t i = 0; i < walk().size(); ++i) {
            const double begin = cpu_ms();
            scene.pose(walk()[i]);
            if (cloth && !scene.step_cloth(kFrame, i == 0)) {
                state.SkipWithError("the cloth refused a step");
                return;
            }
            frames.push_back(cpu_ms() - begin);
        }
        benchmark::ClobberMemory();
    }
    std::sort(frames.begin(), frames.end());
    state.counters["median_ms"] = frames[frames.size() / 2];
    state.counters["p95_ms"] = frames[frames.size() * 95 / 100];
    state.counters["vertices"] = static_cast<double>(scene.shirt().positions.size());
}

void skinning_and_targets(benchmark::State& state) {
    play(state, {}, false);
}

void skinning_targets_and_cloth(benchmark::State& state) {
    play(state, {}, true);
}

/// The same strain without length limits takes about four times the substeps.
void cloth_without_length_limits(benchmark::State& state) {
    bullet_cloth::Settings settings;
    settings.limit_edges = 0.0;
    settings.substep_rate *= 4.0;
    play(state, settings, true);
}

BENCHMARK(skinning_and_targets)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(skinning_targets_and_cloth)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(cloth_without_length_limits)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace

BENCHMARK_MAIN();
