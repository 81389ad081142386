// Rules of toile.skinning/1.
#include "host/contract_bench.h"

#include <cmath>
#include <limits>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

struct Posed {
    std::vector<Float3> positions, normals;
    bool operator==(const Posed&) const = default;
};

void bind(Bench& bench, const CapsuleFigure& figure) {
    Job job;
    bench.ok("bind", [&](auto* i) {
        return bench.table<toile_skinning>().bind(i, &figure.abi(), job.handle());
    });
}

Posed pose(Bench& bench, const CapsuleFigure& figure, const Joints& joints) {
    Guarded<Float3> positions(figure.positions().size());
    Guarded<Float3> normals(figure.positions().size());
    const toile_body_state state = figure.state(joints, 1);
    bench.ok("pose", [&](auto* i) {
        return bench.table<toile_skinning>().pose(i, &state, positions.view(), normals.view());
    });
    bench.rule(positions.intact() && normals.intact(), "pose: writes beyond its buffers");
    Posed out{positions.rows(), normals.rows()};
    bench.finite("pose", out.positions);
    bench.finite("pose", out.normals);
    return out;
}

void moves_rigidly(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    Bench bench(plugin);
    bench.activate();
    bind(bench, figure);
    for (const double yaw : {0.0, 1.0, -2.5})
        for (const float shift : {0.0f, 0.7f}) {
            const Joints joints = figure.joints(yaw, {shift, 0.5f * shift, -shift});
            Posed wanted;
            figure.pose(joints, wanted.positions, wanted.normals);
            const Posed got = pose(bench, figure, joints);
            bench.rule(Bench::distance(got.positions, wanted.positions) < 1e-4,
                       "pose: the surface does not follow when all joints move as one");
            bench.rule(Bench::distance(got.normals, wanted.normals) < 1e-2,
                       "pose: the normals do not turn with the surface, or are not unit vectors");
        }
}

void poses_bend(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    Bench bench(plugin);
    bench.activate();
    bind(bench, figure);
    // Every joint turned by half a turn on its own: ugly, but finite.
    Joints joints = figure.joints(0, {0, 0, 0});
    for (std::size_t k = 0; k < joints.size(); ++k) {
        const float turn = (k % 2 == 0 ? 1.0f : -1.0f) * 3.14159f / 2;
        float* r = joints[k].rotation;
        r[k % 3] = std::sin(turn), r[(k + 1) % 3] = 0, r[(k + 2) % 3] = 0, r[3] = std::cos(turn);
    }
    (void)pose(bench, figure, joints);
}

void repeats(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const auto run = [&](std::uint32_t threads) {
        Bench bench(plugin, threads);
        bench.activate();
        bind(bench, figure);
        (void)pose(bench, figure, figure.joints(0.3, {0, 0, 0}));
        return pose(bench, figure, figure.joints(0.9, {0.1f, 0, 0}));
    };
    const Posed once = run(1);
    const Bench bench(plugin);
    bench.rule(once == run(1), "pose: two runs give different bytes");
    bench.rule(once == run(2), "pose: two threads give other bytes than one");
}

void takes_newer_structs(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    Bench bench(plugin);
    bench.activate();
    Longer<toile_body> body(figure.abi());
    bench.ok("bind without a job",
             [&](auto* i) { return bench.table<toile_skinning>().bind(i, body.get(), nullptr); });
    (void)pose(bench, figure, figure.joints(0, {0, 0, 0}));
}

void refuses_nonsense(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_skinning>();
    const std::size_t count = figure.positions().size();
    Guarded<Float3> positions(count);
    Guarded<Float3> normals(count);
    Joints joints = figure.joints(0, {0, 0, 0});
    toile_body_state state = figure.state(joints, 1);
    const auto posing = [&](toile_instance* i) {
        return table.pose(i, &state, positions.view(), normals.view());
    };
    bench.fails("pose", "before bind", posing);
    bench.fails("bind", "without a body", [&](auto* i) { return table.bind(i, nullptr, nullptr); });
    bind(bench, figure);
    Guarded<Float3> few(count - 1);
    bench.fails("pose", "with too small a buffer",
                [&](auto* i) { return table.pose(i, &state, few.view(), normals.view()); });
    bench.rule(few.intact(), "pose: writes beyond a buffer that is too small");
    joints[TOILE_JOINT_CHEST].rotation[3] = std::numeric_limits<float>::quiet_NaN();
    if (bench.any("pose", posing) >= 0) bench.finite("pose of a NaN joint", positions.rows());
    state.joints.count = 3;
    bench.fails("pose", "with three joints", posing);
}

constexpr ContractCase kCases[] = {
    {TOILE_SKINNING, "skinning: the surface follows rigid motion, from the rest pose on",
     &moves_rigidly},
    {TOILE_SKINNING, "skinning: any pose is finite", &poses_bend},
    {TOILE_SKINNING, "skinning: same bytes for every run and thread count", &repeats},
    {TOILE_SKINNING, "skinning: longer structs of a newer host, and no job", &takes_newer_structs},
    {TOILE_SKINNING, "skinning: wrong calls are refused with a text", &refuses_nonsense},
};

} // namespace

std::span<const ContractCase> skinning_cases() {
    return kCases;
}

} // namespace toile::host
