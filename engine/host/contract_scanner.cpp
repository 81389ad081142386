// Rules of toile.scanner/1.
#include "host/contract_bench.h"
#include "host/scan_sink.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;
using Picture = std::vector<float>;

constexpr int kWidth = 240, kHeight = 320, kFrames = 24;
constexpr double kFocal = 300.0;
constexpr float kDistance_m = 2.0f, kEye_m = 0.9f;
constexpr float kClose_m = 0.03f;

/// Upright, 2 m before the figure, or `yaw_rad` around it.
toile_stream camera(double yaw_rad = 0.0, std::uint32_t number = 0) {
    auto out = sized<toile_stream>();
    out.depth = {kWidth, kHeight, kFocal, kFocal, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1), {}};
    for (const int i : {0, 5, 10, 15})
        out.color_from_depth[i] = out.world_from_camera[i] = 1.0;
    const double c = std::cos(yaw_rad), sine = std::sin(yaw_rad);
    out.world_from_camera[0] = out.world_from_camera[10] = c;
    out.world_from_camera[8] = sine;
    out.world_from_camera[2] = -sine;
    out.world_from_camera[12] = kDistance_m * sine;
    out.world_from_camera[13] = kEye_m;
    out.world_from_camera[14] = kDistance_m * c;
    out.camera = number;
    out.has_world = out.registered = 1;
    out.frame_period_s = 1.0 / 30.0;
    return out;
}

/// Fills what one triangle covers, where it is nearest. `p`: x, y in pixels, depth.
void draw(const std::array<Vec3f, 3>& p, Picture& out) {
    const auto low = [&](int k) { return std::min({p[0][k], p[1][k], p[2][k]}); };
    const auto high = [&](int k) { return std::max({p[0][k], p[1][k], p[2][k]}); };
    const auto cross = [](const Vec3f& a, const Vec3f& b, float x, float y) {
        return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
    };
    const float area = cross(p[0], p[1], p[2].x(), p[2].y());
    if (std::abs(area) < 1e-6f) return;
    for (int y = std::max(0, static_cast<int>(low(1)));
         y <= std::min<int>(kHeight - 1, static_cast<int>(high(1)) + 1); ++y)
        for (int x = std::max(0, static_cast<int>(low(0)));
             x <= std::min<int>(kWidth - 1, static_cast<int>(high(0)) + 1); ++x) {
            const auto u = static_cast<float>(x), v = static_cast<float>(y);
            const float a = cross(p[1], p[2], u, v) / area, b = cross(p[2], p[0], u, v) / area;
            if (a < 0.0f || b < 0.0f || a + b > 1.0f) continue;
            const float depth = 1.0f / (a / p[0].z() + b / p[1].z() + (1.0f - a - b) / p[2].z());
            float& pixel = out[static_cast<std::size_t>(y * kWidth + x)];
            if (!(pixel <= depth)) pixel = depth;
        }
}

/// The capsule figure, turned, as the camera sees it.
Picture seen(const CapsuleFigure& figure, double yaw_rad) {
    std::vector<Float3> positions, normals;
    figure.pose(figure.joints(yaw_rad, {0.0f, 0.0f, 0.0f}), positions, normals);
    Picture out(std::size_t{kWidth} * kHeight, std::numeric_limits<float>::quiet_NaN());
    std::vector<Vec3f> pixels;
    for (const Float3& p : positions) {
        const float depth = kDistance_m - p[2];
        const auto f = static_cast<float>(kFocal) / depth;
        pixels.emplace_back(0.5f * (kWidth - 1) + f * p[0],
                            0.5f * (kHeight - 1) - f * (p[1] - kEye_m), depth);
    }
    const auto* triangles = static_cast<const Triangle*>(figure.abi().rest.triangles.data);
    for (std::uint32_t t = 0; t < figure.abi().rest.triangles.count; ++t)
        draw({pixels[triangles[t][0]], pixels[triangles[t][1]], pixels[triangles[t][2]]}, out);
    return out;
}

void begin(Bench& bench) {
    const Longer<toile_stream> stream(camera());
    auto copy = stream;
    bench.ok("begin",
             [&](auto* i) { return bench.table<toile_scanner>().begin(i, copy.get(), 1); });
}

toile_frame frame_of(const Picture& picture, std::uint32_t sequence) {
    auto out = sized<toile_frame>();
    out.sequence = sequence;
    out.timestamp_ns = 33'333'333ll * sequence;
    out.depth_m = view_of(picture);
    return out;
}

SunkScan scanned(const PluginPtr& plugin, std::uint32_t threads) {
    Bench bench(plugin, threads);
    bench.activate();
    begin(bench);
    const CapsuleFigure figure;
    for (std::uint32_t k = 0; k < kFrames; ++k) {
        const Picture picture = seen(figure, 2.0 * std::numbers::pi * k / kFrames);
        Longer<toile_frame> frame(frame_of(picture, k));
        bench.ok("feed",
                 [&](auto* i) { return bench.table<toile_scanner>().feed(i, frame.get(), 1); });
    }
    ScanSink sink(500'000, 1'000'000);
    Job job;
    bench.ok("finish", [&](auto* i) {
        return bench.table<toile_scanner>().finish(i, sink.handle(), job.handle());
    });
    return sink.take();
}

/// The figure in its first pose, all around: every part of it is near the scan, and the reverse.
void check_figure(const Bench& bench, const SunkScan& scan) {
    bench.rule(scan.mesh.triangles.size() > 500, "finish: a surface of hardly any triangles");
    bench.rule(scan.mesh.normals.empty() || scan.mesh.normals.size() == scan.mesh.positions.size(),
               "finish: not a normal for each vertex");
    const CapsuleFigure figure;
    const auto box = [](const std::vector<Float3>& rows) {
        Eigen::AlignedBox3f out;
        for (const Float3& p : rows)
            out.extend(Vec3f(p[0], p[1], p[2]));
        return out;
    };
    const auto has = box(scan.mesh.positions), wants = box(figure.positions());
    bench.rule((has.min() - wants.min()).cwiseAbs().maxCoeff() < kClose_m &&
                   (has.max() - wants.max()).cwiseAbs().maxCoeff() < kClose_m,
               "finish: the turning figure comes out of another size, or in another place");
    std::size_t near = 0;
    for (const Float3& wanted : figure.positions()) {
        const Vec3f p(wanted[0], wanted[1], wanted[2]);
        near += std::any_of(scan.mesh.positions.begin(), scan.mesh.positions.end(),
                            [&](const Float3& q) {
                                return (p - Vec3f(q[0], q[1], q[2])).squaredNorm() <
                                       kClose_m * kClose_m;
                            })
                    ? 1
                    : 0;
    }
    // Ends of capsules that lie within others are on no surface.
    bench.rule(5 * near > 3 * figure.positions().size(), "finish: parts of the figure are missing");
}

void finds_the_turning_figure(const PluginPtr& plugin) {
    const Bench bench(plugin);
    check_figure(bench, scanned(plugin, 1));
}

/// One before and one behind, or a plain refusal at begin. The second one misses an instant.
void takes_two_cameras_or_refuses(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_scanner>();
    const std::array streams = {camera(0.0, 3), camera(std::numbers::pi, 8)};
    const toile_status begun = bench.any("begin", [&](auto* i) {
        return table.begin(i, streams.data(), static_cast<std::uint32_t>(streams.size()));
    });
    if (begun == TOILE_E_UNSUPPORTED) return;
    bench.rule(begun >= 0, "begin: refuses two cameras that know where they stand, and not as "
                           "unsupported");
    const CapsuleFigure figure;
    for (std::uint32_t k = 0; k < kFrames; ++k) {
        const double turn = 2.0 * std::numbers::pi * k / kFrames;
        const std::array pictures = {seen(figure, turn), seen(figure, turn - std::numbers::pi)};
        std::array<toile_frame, 2> frames = {frame_of(pictures[0], k), frame_of(pictures[1], k)};
        frames[0].camera = 3;
        frames[1].camera = 8;
        bench.ok("feed", [&](auto* i) { return table.feed(i, frames.data(), k == 5 ? 1 : 2); });
    }
    ScanSink sink(500'000, 1'000'000);
    Job job;
    bench.ok("finish", [&](auto* i) { return table.finish(i, sink.handle(), job.handle()); });
    check_figure(bench, sink.take());
}

void gives_the_same_twice(const PluginPtr& plugin) {
    const Bench bench(plugin);
    const SunkScan a = scanned(plugin, 1), b = scanned(plugin, 2);
    bench.rule(a.mesh.positions == b.mesh.positions && a.mesh.triangles == b.mesh.triangles &&
                   a.mesh.colors == b.mesh.colors,
               "finish: two runs give different bytes");
}

void survives_broken_pictures(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_scanner>();
    begin(bench);
    std::vector<Picture> pictures;
    for (const float depth : {std::nanf(""), 0.0f, 65.535f, 0.01f, -1.0f, HUGE_VALF})
        pictures.emplace_back(std::size_t{kWidth} * kHeight, depth);
    Picture& noise = pictures.emplace_back(std::size_t{kWidth} * kHeight);
    for (std::size_t i = 0; i < noise.size(); ++i)
        noise[i] = 0.5f + static_cast<float>(i * 2654435761u % 7919) / 1600.0f;
    for (std::uint32_t k = 0; k < pictures.size(); ++k) {
        const toile_frame frame = frame_of(pictures[k], k);
        bench.any("feed", [&](auto* i) { return table.feed(i, &frame, 1); });
    }
    ScanSink sink(500'000, 1'000'000);
    bench.fails("finish", "for pictures that show nothing",
                [&](auto* i) { return table.finish(i, sink.handle(), nullptr); });
    begin(bench); // and goes on afterwards
}

void refuses_wrong_calls(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_scanner>();
    const Picture some(std::size_t{kWidth} * kHeight, 2.0f), short_one(kWidth, 2.0f);
    const toile_frame frame = frame_of(some, 0);
    ScanSink sink(500'000, 1'000'000);
    bench.fails("feed", "before begin", [&](auto* i) { return table.feed(i, &frame, 1); });
    bench.fails("finish", "before begin",
                [&](auto* i) { return table.finish(i, sink.handle(), nullptr); });
    bench.fails("begin", "without a camera", [&](auto* i) { return table.begin(i, nullptr, 0); });
    begin(bench);
    bench.fails("finish", "without a sink",
                [&](auto* i) { return table.finish(i, nullptr, nullptr); });
    bench.fails("finish", "without a frame",
                [&](auto* i) { return table.finish(i, sink.handle(), nullptr); });
    const toile_frame wrong = frame_of(short_one, 0);
    bench.fails("feed", "with a picture of another size than announced",
                [&](auto* i) { return table.feed(i, &wrong, 1); });
    toile_frame other = frame;
    other.camera = 7;
    bench.fails("feed", "with a camera that was not announced",
                [&](auto* i) { return table.feed(i, &other, 1); });
}

constexpr ContractCase kCases[] = {
    {TOILE_SCANNER, "scanner: a turning figure comes out whole, as it stood first",
     &finds_the_turning_figure},
    {TOILE_SCANNER, "scanner: two cameras see a figure whole, or are refused as unsupported",
     &takes_two_cameras_or_refuses},
    {TOILE_SCANNER, "scanner: two runs and any number of threads give the same bytes",
     &gives_the_same_twice},
    {TOILE_SCANNER, "scanner: broken pictures are survived, and refused with a text",
     &survives_broken_pictures},
    {TOILE_SCANNER, "scanner: wrong calls are refused with a text", &refuses_wrong_calls},
};

} // namespace

std::span<const ContractCase> scanner_cases() {
    return kCases;
}

} // namespace toile::host
