// toile bench: how fast this machine dresses somebody, as milliseconds and against a plain loop.
#include "apps/commands.h"
#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/picture_options.h"
#include "apps/still_look.h"
#include "body/motion.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/paths.h"
#include "pipeline/motion_source.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace toile::apps {
namespace {

struct BenchOptions {
    std::string body = "woman", garments = "t-shirt,skirt", motion, json;
    std::uint64_t frames = 60;
    PictureOptions picture{"960x540", "fast", ""};
};

/// The loop that everything is held against: linear blend skinning of the body, one vertex after
/// the other, one thread, nothing clever. Median of several passes; ms.
double baseline_ms(const body::BodyModel& model, const body::JointTransforms& joints) {
    constexpr int kPasses = 31;
    std::vector<Vec3f> out(model.rest.positions.size());
    std::array<double, kPasses> times{};
    for (double& time : times) {
        const double start = pipeline::cpu_seconds();
        for (std::size_t v = 0; v < out.size(); ++v) {
            Vec3f p = Vec3f::Zero();
            for (std::size_t k = 0; k < 4; ++k)
                p += model.skin.weights[v][k] *
                     (joints[model.skin.joints[v][k]] * model.rest.positions[v]);
            out[v] = p;
        }
        time = 1e3 * (pipeline::cpu_seconds() - start);
    }
    std::sort(times.begin(), times.end());
    return times[kPasses / 2];
}

std::string motion_of(const BenchOptions& options) {
    if (!options.motion.empty()) return options.motion;
    for (const auto& folder : data_folders("avatars"))
        if (std::filesystem::exists(folder / "motions" / "walk.json"))
            return (folder / "motions" / "walk.json").string();
    throw Error("bench: avatars/motions/walk.json is not there; choose a --motion");
}

pipeline::RunReport run(FittingRoom& room, const BenchOptions& options) {
    const body::BodyModel& model = room.body().model();
    const body::BodyVolumes volumes =
        body::measure_volumes(model.skeleton, model.rest.positions, model.parts);
    pipeline::MotionSource source(body::load_motion(motion_of(options), model.skeleton, &volumes),
                                  model.skeleton, kFramesPerSecond);
    pipeline::RunOptions run_options;
    run_options.most_frames = options.frames;
    run_options.interrupted = [] { return host::interrupt_flag().load(); };
    pipeline::TryOnRun run(source, room.person(), run_options);
    const auto context = render::make_offscreen_context();
    Look look(*context, options.picture.renderer(), room.person());
    const render::View view = render::view_from_name("front");
    while (run.next()) {
        run.begin_drawing();
        look.update();
        look.draw(view, bounds_now(room.person()));
        run.end_drawing();
    }
    return run.report();
}

void tell(const pipeline::RunReport& report, double baseline, const BenchOptions& options) {
    nlohmann::ordered_json json;
    json["schema"] = 1;
    json["version"] = TOILE_VERSION;
    json["body"] = options.body;
    json["garments"] = split_names(options.garments, "--garment");
    json["picture"] = options.picture.size;
    json["frames"] = report.frames;
    json["baseline_ms"] = baseline;
    std::printf("CPU of a frame, %llu frames; baseline: plain skinning of the body, %.3f ms\n"
                "stage       median ms     p95 ms   x baseline\n",
                static_cast<unsigned long long>(report.frames), baseline);
    const auto row = [&](const std::string& name, const pipeline::Quantiles& q) {
        std::printf("%-10s %10.2f %10.2f %12.1f\n", name.c_str(), q.median_ms, q.p95_ms,
                    q.median_ms / baseline);
        json["stages"][name] = {
            {"median_ms", q.median_ms}, {"p95_ms", q.p95_ms}, {"ratio", q.median_ms / baseline}};
    };
    for (const char* name : {"skinning", "targets", "cloth", "surfaces", "drawing"})
        row(name, report.stages.at(name));
    row("compute", report.compute);
    if (!options.json.empty()) write_text(options.json, json.dump(2) + "\n");
}

void bench(const BenchOptions& options, const GlobalOptions& global) {
    (void)options.picture.renderer();
    host::catch_interrupts();
    FittingRoom room(global, {options.body, split_names(options.garments, "--garment"), "auto"},
                     false);
    const body::BodyModel& model = room.body().model();
    const double baseline = baseline_ms(
        model, body::skinning_transforms(
                   model.skeleton,
                   body::forward_kinematics(model.skeleton, body::rest_pose(model.skeleton))));
    const pipeline::RunReport report = run(room, options);
    if (report.frames == 0) throw Error("bench: interrupted before the first frame");
    tell(report, baseline, options);
}

} // namespace

void add_bench_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command =
        app.add_subcommand("bench", "Tells how long this machine takes to dress somebody");
    auto options = std::make_shared<BenchOptions>();
    command->add_option("--body", options->body, "Who is dressed")
        ->type_name("AVATAR|body.json")
        ->capture_default_str();
    command->add_option("--garment", options->garments, "Garments, by id, folder or zip")
        ->type_name("ID[,ID...]")
        ->capture_default_str();
    command->add_option("--motion", options->motion, "Motion to play; else a walk of our own")
        ->type_name("FILE");
    command->add_option("--frames", options->frames, "Stops after this many")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command->add_option("--json", options->json, "Writes the figures to a file, too")
        ->type_name("FILE");
    options->picture.add_to(*command);
    command->footer("Example: toile bench --garment dress --json bench.json");
    command->callback([options, &global] { bench(*options, global); });
}

} // namespace toile::apps
