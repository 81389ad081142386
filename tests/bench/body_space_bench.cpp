// How long one body takes to be posed: SCAPE's full form with the shape fixed, and the baked form.
#include "body/body_space.h"
#include "body/joint_limits.h"
#include "body/pose_tables.h"

#include <benchmark/benchmark.h>

namespace toile::body {
namespace {

/// The shipped adult and a few poses, the same every time.
struct Adult {
    BodySpace space = BodySpace::load(find_avatar("adult"));
    PoseTables tables = load_pose_tables(space.model());
    ScapeModel scape{space.model(), tables.deformation};
    BodyShape shape = space.shape(std::vector<double>{0.5, -0.5, 1.0});
    std::vector<Pose> poses;
    std::vector<Vec3f> posed = std::vector<Vec3f>(shape.positions.size());

    Adult() {
        Random random(1);
        for (int i = 0; i < 8; ++i)
            poses.push_back(random_pose(shape.skeleton, random));
    }
};

Adult& adult() {
    static Adult adult;
    return adult;
}

void scape_new_pose(benchmark::State& state) {
    ScapeBody body(adult().scape, adult().shape);
    std::size_t i = 0;
    for (auto _ : state) {
        body.pose(adult().poses[i++ % adult().poses.size()], adult().posed);
        benchmark::DoNotOptimize(adult().posed.data());
    }
}
BENCHMARK(scape_new_pose)->Unit(benchmark::kMillisecond);

void baked_new_pose(benchmark::State& state) {
    const CorrectiveSkin body(adult().shape, adult().space.model().skin,
                              adult().tables.correctives);
    std::size_t i = 0;
    for (auto _ : state) {
        body.pose(adult().poses[i++ % adult().poses.size()], adult().posed);
        benchmark::DoNotOptimize(adult().posed.data());
    }
}
BENCHMARK(baked_new_pose)->Unit(benchmark::kMillisecond);

void new_shape(benchmark::State& state) {
    std::vector<double> coefficients(static_cast<std::size_t>(adult().space.component_count()),
                                     0.1);
    for (auto _ : state)
        benchmark::DoNotOptimize(adult().space.shape(coefficients));
}
BENCHMARK(new_shape)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace toile::body

BENCHMARK_MAIN();
