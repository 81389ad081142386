// Rules of toile.resizer/1.
#include "host/contract_bench.h"

#include <algorithm>
#include <cmath>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

constexpr double kSame_m = 0.001;
constexpr double kFollow_m = 0.005;
constexpr float kWider = 1.25f;

/// The capsule figure, its trunk the region; and the same figure with other vertices.
class Stand {
  public:
    Stand() : mesh_(figure_.abi().rest) {
        const auto* parts = static_cast<const std::uint8_t*>(figure_.abi().part_labels.data);
        for (std::uint32_t v = 0; v < figure_.abi().part_labels.count; ++v) {
            const std::uint8_t part = parts[v];
            region_.push_back(part == TOILE_PART_TORSO || part == TOILE_PART_PELVIS ? 1.0f : 0.0f);
        }
        rebuild(figure_.positions());
    }
    Stand(const Stand&) = delete;
    Stand& operator=(const Stand&) = delete;

    [[nodiscard]] const toile_mesh& mesh() const { return mesh_; }
    [[nodiscard]] const toile_mesh& changed() const { return changed_; }
    [[nodiscard]] const std::vector<Float3>& positions() const { return figure_.positions(); }
    [[nodiscard]] const std::vector<Float3>& changed_positions() const { return other_; }
    [[nodiscard]] const std::vector<float>& region() const { return region_; }
    [[nodiscard]] toile_view region_view() const { return view_of(region_); }
    [[nodiscard]] std::size_t size() const { return figure_.positions().size(); }

    void rebuild(std::vector<Float3> positions) {
        other_ = std::move(positions);
        changed_ = figure_.abi().rest;
        changed_.positions = view_of(other_);
        changed_.normals = {};
    }
    void widen(float factor) {
        auto positions = figure_.positions();
        for (Float3& p : positions)
            p[0] *= factor;
        rebuild(std::move(positions));
    }
    void move() {
        std::vector<Float3> positions, normals;
        figure_.pose(figure_.joints(0.4, {0.3f, 0.1f, -0.2f}), positions, normals);
        rebuild(std::move(positions));
    }
    [[nodiscard]] toile_resize_request to_target() const {
        auto out = sized<toile_resize_request>();
        out.subject = &mesh_;
        out.target = &changed_;
        out.region = out.target_region = view_of(region_);
        return out;
    }
    [[nodiscard]] toile_resize_request with_body() const {
        auto out = sized<toile_resize_request>();
        out.subject = out.body_before = &mesh_;
        out.body_after = &changed_;
        return out;
    }

  private:
    CapsuleFigure figure_;
    toile_mesh mesh_, changed_{};
    std::vector<Float3> other_;
    std::vector<float> region_;
};

std::vector<Float3> resized(Bench& bench, const toile_resize_request& request, std::size_t count) {
    Guarded<Float3> out(count);
    Longer<toile_resize_request> asked(request);
    Job job;
    bench.ok("resize", [&](auto* i) {
        return bench.table<toile_resizer>().resize(i, asked.get(), out.view(), job.handle());
    });
    bench.rule(out.intact(), "resize: writes beyond its buffer");
    bench.finite("resize", out.rows());
    return out.rows();
}

void keeps_what_fits(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const Stand stand;
    const auto same = resized(bench, stand.to_target(), stand.size());
    bench.rule(Bench::distance(same, stand.positions()) < kSame_m,
               "resize: changes a surface that has the target's proportions");
    const auto still = resized(bench, stand.with_body(), stand.size());
    bench.rule(Bench::distance(still, stand.positions()) < kSame_m,
               "resize: moves a surface whose body does not change");
}

/// Widest x of the region.
float half_width(const Stand& stand, const std::vector<Float3>& positions) {
    float out = 0.0f;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (stand.region()[v] >= 0.5f) out = std::max(out, std::abs(positions[v][0]));
    return out;
}

void takes_the_targets_width(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    Stand stand;
    stand.widen(kWider);
    for (const std::uint32_t strips : {0u, 3u, 60u}) {
        auto request = stand.to_target();
        request.strips = strips;
        const auto wider = resized(bench, request, stand.size());
        const float factor = half_width(stand, wider) / half_width(stand, stand.positions());
        bench.rule(factor > 1.0f + 0.6f * (kWider - 1.0f) && factor < 1.0f + 1.4f * (kWider - 1.0f),
                   "resize: does not give the region the target's width");
        for (std::size_t v = 0; v < wider.size(); ++v)
            bench.rule(std::abs(wider[v][1] - stand.positions()[v][1]) < kSame_m,
                       "resize: changes heights");
    }
}

void follows_the_body(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    Stand stand;
    stand.move();
    const auto moved = resized(bench, stand.with_body(), stand.size());
    bench.rule(Bench::distance(moved, stand.changed_positions()) < kFollow_m,
               "resize: a surface does not follow the body that it lies on");
}

void gives_the_same_twice(const PluginPtr& plugin) {
    std::vector<std::vector<Float3>> runs;
    for (const std::uint32_t threads : {1u, 2u}) {
        Bench bench(plugin, threads);
        bench.activate();
        Stand stand;
        stand.widen(kWider);
        runs.push_back(resized(bench, stand.to_target(), stand.size()));
        const auto moved = resized(bench, stand.with_body(), stand.size());
        runs.back().insert(runs.back().end(), moved.begin(), moved.end());
        bench.rule(runs.front() == runs.back(), "resize: two runs give different bytes");
    }
}

void refuses_wrong_calls(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const Stand stand;
    std::vector<Float3> out(stand.size());
    const auto call = [&](const toile_resize_request* request, toile_view_mut positions) {
        return [&bench, request, positions](toile_instance* i) {
            return bench.table<toile_resizer>().resize(i, request, positions, nullptr);
        };
    };
    bench.fails("resize", "without a request", call(nullptr, view_mut(out)));
    auto request = stand.to_target();
    bench.fails("resize", "into no buffer", call(&request, {}));
    request.subject = nullptr;
    bench.fails("resize", "without a subject", call(&request, view_mut(out)));
    request = stand.to_target();
    request.target = nullptr;
    bench.fails("resize", "without a target or a body", call(&request, view_mut(out)));
    request = stand.to_target();
    --request.region.count;
    bench.fails("resize", "with a region of another size", call(&request, view_mut(out)));
    request = stand.with_body();
    toile_mesh fewer = stand.changed();
    --fewer.triangles.count;
    request.body_after = &fewer;
    bench.fails("resize", "with a body of another topology", call(&request, view_mut(out)));
    out.pop_back();
    request = stand.to_target();
    bench.fails("resize", "into a buffer that is too small", call(&request, view_mut(out)));
}

constexpr ContractCase kCases[] = {
    {TOILE_RESIZER, "resizer: what fits stays as it is", &keeps_what_fits},
    {TOILE_RESIZER, "resizer: the region gets the target's width, with any number of strips",
     &takes_the_targets_width},
    {TOILE_RESIZER, "resizer: what lies on a body follows it", &follows_the_body},
    {TOILE_RESIZER, "resizer: two runs and any number of threads give the same bytes",
     &gives_the_same_twice},
    {TOILE_RESIZER, "resizer: wrong calls are refused with a text", &refuses_wrong_calls},
};

} // namespace

std::span<const ContractCase> resizer_cases() {
    return kCases;
}

} // namespace toile::host
