// Rules of toile.cloth/1.
#include "host/contract_bench.h"

#include <cmath>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

constexpr double kStep = 1.0 / 30;

/// A world with one body and any number of tubes, stepped along a path.
class World {
  public:
    World(Bench& bench, const CapsuleFigure& figure, const ClothTube& tube, int garments)
        : bench_(bench), figure_(figure), tube_(tube) {
        const auto& table = bench.table<toile_cloth>();
        Job job;
        bench.ok("set_body",
                 [&](auto* i) { return table.set_body(i, &figure.abi(), job.handle()); });
        for (int k = 0; k < garments; ++k) {
            toile_cloth_garment garment = tube.garment();
            garment.layer = static_cast<std::uint32_t>(k);
            handles.push_back(0);
            bench.ok("add_garment", [&](auto* i) {
                return table.add_garment(i, &garment, k == 0 ? nullptr : job.handle(),
                                         &handles.back());
            });
            bench.rule(handles.back() != 0, "add_garment: gives the handle 0");
            bench.rule(k == 0 || handles.back() != handles.front(),
                       "add_garment: gives one handle twice");
        }
    }

    /// Moves the body to `yaw, move` and returns the garments' positions.
    std::vector<std::vector<Float3>> step(double yaw, const Float3& move, bool reset = false) {
        const Joints joints = figure_.joints(yaw, move);
        if (sequence_ == 0 || reset) before_ = joints;
        Surface from(figure_, before_, sequence_);
        Surface to(figure_, joints, ++sequence_);
        // Targets: the tube moved with the whole figure.
        std::vector<Float3> target = tube_.positions();
        const Quatf turn(Eigen::AngleAxisf(static_cast<float>(yaw), Vec3f::UnitY()));
        for (Float3& p : target) {
            const Vec3f q = turn * Vec3f(p[0], p[1], p[2]) + Vec3f(move[0], move[1], move[2]);
            p = {q.x(), q.y(), q.z()};
        }
        std::vector<toile_garment_target> targets;
        std::vector<Guarded<Float3>> positions(handles.size(), Guarded<Float3>(target.size()));
        std::vector<Guarded<Float3>> normals = positions;
        std::vector<toile_garment_state> states;
        for (std::size_t k = 0; k < handles.size(); ++k) {
            targets.push_back({handles[k], 0, view_of(target)});
            states.push_back(
                {sizeof(toile_garment_state), handles[k], positions[k].view(), normals[k].view()});
        }
        auto request = sized<toile_cloth_step>();
        request.flags = sequence_ == 1 || reset ? TOILE_STEP_RESET : TOILE_STEP_NONE;
        request.body_before = &from.state;
        request.body_after = &to.state;
        request.dt_s = kStep;
        request.targets = targets.data();
        request.states = states.data();
        request.garment_count = static_cast<std::uint32_t>(handles.size());
        bench_.ok("step", [&](auto* i) { return bench_.table<toile_cloth>().step(i, &request); });
        before_ = joints;
        std::vector<std::vector<Float3>> out;
        for (std::size_t k = 0; k < handles.size(); ++k) {
            bench_.rule(positions[k].intact() && normals[k].intact(),
                        "step: writes beyond its buffers");
            out.push_back(positions[k].rows());
            bench_.finite("step", out.back());
            bench_.finite("step", normals[k].rows());
        }
        target_ = std::move(target);
        return out;
    }

    [[nodiscard]] const std::vector<Float3>& target() const { return target_; }
    std::vector<std::uint32_t> handles;

  private:
    struct Surface {
        Surface(const CapsuleFigure& figure, const Joints& at, std::uint32_t sequence)
            : joints(at) {
            figure.pose(joints, positions, normals);
            state = figure.state(joints, sequence, &positions, &normals);
        }
        Surface(const Surface&) = delete;
        Joints joints;
        std::vector<Float3> positions, normals;
        toile_body_state state{};
    };

    Bench& bench_;
    const CapsuleFigure& figure_;
    const ClothTube& tube_;
    Joints before_{};
    std::uint32_t sequence_ = 0;
    std::vector<Float3> target_;
};

void hangs_and_follows(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    World world(bench, figure, tube, 1);
    for (int frame = 0; frame < 45; ++frame) {
        const float along = static_cast<float>(std::max(0, frame - 15)) * 0.01f;
        const auto cloth = world.step(0.01 * frame, {along, 0, 0}).front();
        std::vector<Float3> pinned;
        std::vector<Float3> wanted;
        for (std::size_t i = 0; i < cloth.size(); ++i)
            if (tube.pins()[i] == 1.0f) {
                pinned.push_back(cloth[i]);
                wanted.push_back(world.target()[i]);
            }
        bench.rule(Bench::distance(pinned, wanted) < 2e-3,
                   "step: vertices with attachment 1 leave their targets");
        bench.rule(Bench::distance(cloth, world.target()) < 0.6,
                   "step: the cloth flies away from a slowly walking body");
    }
}

void resets(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    World world(bench, figure, tube, 1);
    for (int frame = 0; frame < 5; ++frame)
        (void)world.step(0, {0, 0, 0});
    const auto cloth = world.step(2.0, {3, 0, 1}, true).front();
    bench.rule(Bench::distance(cloth, world.target()) < 0.1,
               "step: with TOILE_STEP_RESET it does not start from the targets");
}

void repeats(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    const auto run = [&](std::uint32_t threads) {
        Bench bench(plugin, threads);
        bench.activate();
        World world(bench, figure, tube, 1);
        for (int frame = 0; frame < 12; ++frame)
            (void)world.step(0.02 * frame, {0.01f * static_cast<float>(frame), 0, 0});
        return world.step(0.3, {0.2f, 0, 0});
    };
    const auto once = run(1);
    const Bench bench(plugin);
    bench.rule(once == run(1), "step: two runs give different bytes");
    bench.rule(once == run(2), "step: two threads give other bytes than one");
}

void changes_garments(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_cloth>();
    World world(bench, figure, tube, 2);
    (void)world.step(0, {0, 0, 0});
    const std::uint32_t gone = world.handles.front();
    bench.ok("remove_garment", [&](auto* i) { return table.remove_garment(i, gone); });
    world.handles.erase(world.handles.begin());
    (void)world.step(0, {0, 0, 0});
    bench.fails("remove_garment", "for a garment that is gone",
                [&](auto* i) { return table.remove_garment(i, gone); });
    bench.ok("remove_garment",
             [&](auto* i) { return table.remove_garment(i, world.handles.front()); });
    world.handles.clear();
    (void)world.step(0, {0, 0, 0});
}

void refuses_nonsense(const PluginPtr& plugin) {
    const CapsuleFigure figure;
    const ClothTube tube(figure);
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_cloth>();
    std::uint32_t handle = 0;
    bench.fails("set_body", "without a body",
                [&](auto* i) { return table.set_body(i, nullptr, nullptr); });
    bench.fails("add_garment", "without a garment",
                [&](auto* i) { return table.add_garment(i, nullptr, nullptr, &handle); });
    bench.fails("step", "without a request", [&](auto* i) { return table.step(i, nullptr); });
    Longer<toile_body> body(figure.abi());
    bench.ok("set_body with a newer host's struct",
             [&](auto* i) { return table.set_body(i, body.get(), nullptr); });
}

constexpr ContractCase kCases[] = {
    {TOILE_CLOTH, "cloth: a pinned tube hangs and follows a walking body", &hangs_and_follows},
    {TOILE_CLOTH, "cloth: a reset starts from the targets", &resets},
    {TOILE_CLOTH, "cloth: same bytes for every run and thread count", &repeats},
    {TOILE_CLOTH, "cloth: garments come and go", &changes_garments},
    {TOILE_CLOTH, "cloth: wrong calls are refused with a text", &refuses_nonsense},
};

} // namespace

std::span<const ContractCase> cloth_cases() {
    return kCases;
}

} // namespace toile::host
