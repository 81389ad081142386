// Rules of toile.garment/1.
#include "host/contract_bench.h"

#include <cmath>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

struct Bound {
    std::vector<Float3> positions;
    std::vector<Index4> joints;
    std::vector<Float4> weights;
    std::vector<float> attachment;
    bool operator==(const Bound&) const = default;
};

Bound bind(Bench& bench, const toile_body& body, const toile_garment_package& package,
           toile_job* job) {
    const std::size_t count = package.simulation.positions.count;
    Guarded<Float3> positions(count);
    Guarded<Index4> joints(count);
    Guarded<Float4> weights(count);
    Guarded<float> attachment(count);
    auto out = sized<toile_garment_binding>();
    out.positions = positions.view();
    out.joint_indices = joints.view();
    out.joint_weights = weights.view();
    out.attachment = attachment.view();
    bench.ok("bind", [&](auto* i) {
        return bench.table<toile_garment>().bind(i, &body, &package, job, &out);
    });
    bench.rule(positions.intact() && joints.intact() && weights.intact() && attachment.intact(),
               "bind: writes beyond its buffers");
    return {positions.rows(), joints.rows(), weights.rows(), attachment.rows()};
}

std::vector<Float3> targets(Bench& bench, const CapsuleFigure& figure, const Joints& joints,
                            std::size_t count) {
    Guarded<Float3> positions(count);
    std::vector<Float3> surface;
    std::vector<Float3> normals;
    figure.pose(joints, surface, normals);
    const toile_body_state state = figure.state(joints, 1, &surface, &normals);
    bench.ok("targets", [&](auto* i) {
        return bench.table<toile_garment>().targets(i, &state, positions.view());
    });
    bench.rule(positions.intact(), "targets: writes beyond its buffer");
    std::vector<Float3> out = positions.rows();
    bench.finite("targets", out);
    return out;
}

void binds_soundly(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    Job job;
    const Bound bound = bind(bench, figure.abi(), tube.package(), job.handle());
    bench.finite("bind", bound.positions);
    bench.finite("bind", bound.attachment);
    for (std::size_t i = 0; i < bound.positions.size(); ++i) {
        bench.finite("bind", bound.weights[i]);
        float sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            bench.rule(bound.joints[i][k] < TOILE_JOINT_COUNT, "bind: a joint index beyond 21");
            bench.rule(bound.weights[i][k] >= 0, "bind: a negative joint weight");
            sum += bound.weights[i][k];
        }
        bench.rule(std::abs(sum - 1) < 1e-3f, "bind: joint weights do not sum to 1");
        bench.rule(bound.attachment[i] >= 0 && bound.attachment[i] <= 1,
                   "bind: an attachment outside 0 to 1");
    }
    bench.rule(Bench::distance(bound.positions, tube.positions()) < 0.05,
               "bind: moves a garment by more than 5 cm on the body that it was made on");
}

void targets_follow(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    const Bound bound = bind(bench, figure.abi(), tube.package(), nullptr);
    const std::size_t count = bound.positions.size();
    const auto rest = targets(bench, figure, figure.joints(0, {0, 0, 0}), count);
    bench.rule(Bench::distance(rest, bound.positions) < 1e-3,
               "targets: in the rest pose they are not where bind put the garment");
    auto moved = targets(bench, figure, figure.joints(0, {0.5f, 0.1f, -0.2f}), count);
    for (Float3& p : moved)
        p = {p[0] - 0.5f, p[1] - 0.1f, p[2] + 0.2f};
    bench.rule(Bench::distance(moved, rest) < 1e-3, "targets: do not move with the body");
    auto turned = targets(bench, figure, figure.joints(std::acos(-1.0), {0, 0, 0}), count);
    for (Float3& p : turned)
        p = {-p[0], p[1], -p[2]};
    bench.rule(Bench::distance(turned, rest) < 1e-3, "targets: do not turn with the body");
}

void repeats(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    const auto run = [&](std::uint32_t threads) {
        Bench bench(plugin, threads);
        bench.activate();
        Bound bound = bind(bench, figure.abi(), tube.package(), nullptr);
        auto at = targets(bench, figure, figure.joints(0.4, {0.1f, 0, 0}), bound.positions.size());
        return std::pair(std::move(bound), std::move(at));
    };
    const auto once = run(1);
    const Bench bench(plugin);
    bench.rule(once == run(1), "garment: two runs give different bytes");
    bench.rule(once == run(2), "garment: two threads give other bytes than one");
}

void takes_newer_structs(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    Longer<toile_body> body(figure.abi());
    Longer<toile_garment_package> package(tube.package());
    (void)bind(bench, *body.get(), *package.get(), nullptr);
}

void refuses_nonsense(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_garment>();
    const Joints joints = figure.joints(0, {0, 0, 0});
    const toile_body_state state = figure.state(joints, 1);
    Guarded<Float3> positions(tube.positions().size());
    bench.fails("targets", "before bind",
                [&](auto* i) { return table.targets(i, &state, positions.view()); });
    bench.fails("bind", "without a body and a package",
                [&](auto* i) { return table.bind(i, nullptr, nullptr, nullptr, nullptr); });
    // An older host's struct ends before the last buffers; nothing may be written there.
    auto older = sized<toile_garment_binding>();
    older.positions = positions.view();
    older.size = offsetof(toile_garment_binding, joint_indices);
    (void)bench.any("bind", [&](auto* i) {
        return table.bind(i, &figure.abi(), &tube.package(), nullptr, &older);
    });
    bench.rule(positions.intact(), "bind: writes beyond its buffers");
    Guarded<Float3> few(3);
    (void)bind(bench, figure.abi(), tube.package(), nullptr);
    bench.fails("targets", "with too small a buffer",
                [&](auto* i) { return table.targets(i, &state, few.view()); });
    bench.rule(few.intact(), "targets: writes beyond a buffer that is too small");
}

constexpr ContractCase kCases[] = {
    {TOILE_GARMENT, "garment: bind gives sound weights, close to where it was made",
     &binds_soundly},
    {TOILE_GARMENT, "garment: targets start at the bound garment and follow the body",
     &targets_follow},
    {TOILE_GARMENT, "garment: same bytes for every run and thread count", &repeats},
    {TOILE_GARMENT, "garment: longer structs of a newer host, and no job", &takes_newer_structs},
    {TOILE_GARMENT, "garment: wrong calls are refused with a text", &refuses_nonsense},
};

} // namespace

std::span<const ContractCase> garment_cases() {
    return kCases;
}

} // namespace toile::host
