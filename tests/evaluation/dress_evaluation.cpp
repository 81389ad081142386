// dress_evaluation MANNEQUIN_SCAN AVATAR CUSTOMER[=TRUTH.glb] ...: how right `toile dress` is.
// AVATAR is the body beneath the scan's garment; TRUTH the same garment simulated on the customer.
#include "assets/colored_mesh.h"
#include "core/error.h"
#include "geometry/cut.h"
#include "geometry/nearest_surface.h"
#include "laplace_beltrami_resize/trunk.h"
#include "pipeline/mannequin_dressing.h"
#include "silhouettes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace {

using namespace toile;
namespace resize = laplace_beltrami_resize;

struct Spread {
    double mean = 0.0, median = 0.0, p95 = 0.0, most = 0.0;

    explicit Spread(std::vector<double> values) {
        if (values.empty()) return;
        for (double& v : values) {
            v = std::abs(v);
            mean += v / static_cast<double>(values.size());
        }
        std::sort(values.begin(), values.end());
        median = values[values.size() / 2];
        p95 = values[values.size() * 95 / 100];
        most = values.back();
    }
    void print(const char* what) const {
        std::printf("  %-34s mean %5.1f  median %5.1f  p95 %5.1f  most %5.1f mm\n", what,
                    1000.0 * mean, 1000.0 * median, 1000.0 * p95, 1000.0 * most);
    }
};

/// Girths of the resized abdomen minus the customer's own, at 40 heights.
Spread girth_errors(const pipeline::MannequinDressing& dressed, bool whole_body) {
    const auto& customer = dressed.customer.mesh;
    const auto region = resize::abdomen_region(customer);
    const auto changed_region = resize::abdomen_region(dressed.mannequin_fit.surfaces.front());
    const resize::Trunk wanted(customer, region);
    const resize::Trunk has(dressed.changed_body, changed_region);
    std::vector<double> out;
    for (int i = 0; i < 40; ++i) {
        const float at = (static_cast<float>(i) + 0.5f) / 40.0f;
        const float height = wanted.low() + at * (wanted.high() - wanted.low());
        const float same = whole_body ? height : has.low() + at * (has.high() - has.low());
        out.push_back(has.girth(same) - wanted.girth(height));
    }
    return Spread(std::move(out));
}

/// Room between cloth and the true bodies, after minus before; `after` (nv of the mannequin).
Spread ease_errors(const pipeline::MannequinDressing& dressed,
                   const geometry::TriangleMesh& true_mannequin,
                   const geometry::TriangleMesh& true_after) {
    const geometry::NearestSurface before(true_mannequin.positions, true_mannequin.triangles);
    const geometry::NearestSurface after(true_after.positions, true_after.triangles);
    std::vector<double> out;
    for (std::size_t v = 0; v < dressed.moved.size(); ++v) {
        if (dressed.cover.cloth[v] < 0.5f) continue;
        out.push_back(static_cast<double>(
            after.nearest(dressed.moved[v]).signed_distance -
            before.nearest(dressed.mannequin.mesh.positions[v]).signed_distance));
    }
    return Spread(std::move(out));
}

/// Of the body beneath the garment from the true one.
Spread fit_errors(const pipeline::MannequinDressing& dressed, const geometry::TriangleMesh& truth) {
    const geometry::NearestSurface surface(truth.positions, truth.triangles);
    std::vector<double> out;
    for (const Vec3f& p : dressed.mannequin_fit.surfaces.front().positions)
        out.push_back(static_cast<double>(surface.nearest(p).distance));
    return Spread(std::move(out));
}

Vec3f cross_of(const std::vector<Vec3f>& p, const Triangle& t) {
    return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
}

/// Folds and steps that the change made on the cloth: a triangle that turned against its
/// neighbours, and the largest step between neighbours per centimetre of cloth.
void print_folds(const pipeline::MannequinDressing& dressed) {
    const auto& mesh = dressed.mannequin.mesh;
    std::size_t folded = 0, cloth = 0;
    double step = 0.0;
    for (const Triangle& t : mesh.triangles) {
        bool covered = true;
        for (const auto v : t)
            covered = covered && dressed.cover.cloth[v] >= 0.5f;
        if (!covered) continue;
        ++cloth;
        const Vec3f before = cross_of(mesh.positions, t), after = cross_of(dressed.moved, t);
        folded += before.dot(after) <= 0.0f ? 1 : 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = t[k], b = t[(k + 1) % 3];
            const Vec3f jump =
                (dressed.moved[a] - mesh.positions[a]) - (dressed.moved[b] - mesh.positions[b]);
            step = std::max(step, static_cast<double>(jump.norm()));
        }
    }
    std::printf(
        "  cloth: %zu of %zu triangles turned over; largest step between neighbours %.1f mm;"
        " open rims of the result %zu\n",
        folded, cloth, 1000.0 * step, geometry::rims(dressed.look.mesh).size());
}

void evaluate(host::Registry& registry, host::Services& services, const toile_limits& limits,
              const assets::ColoredMesh& mannequin, const geometry::TriangleMesh& truth,
              std::string customer_file) {
    std::string true_look;
    if (const auto at = customer_file.find('='); at != std::string::npos) {
        true_look = customer_file.substr(at + 1);
        customer_file.resize(at);
    }
    const auto customer = assets::load_colored_mesh(customer_file);
    for (const bool whole : {false, true}) {
        host::Job job;
        const std::clock_t cpu = std::clock();
        pipeline::MannequinDressingRequest request;
        request.whole_body = whole;
        const auto dressed = pipeline::dress_from_mannequin(registry, services, limits, mannequin,
                                                            customer, request, job);
        std::printf("%s --fit %s: %.1f s, %.1f s of one core\n", customer_file.c_str(),
                    whole ? "body" : "abdomen",
                    dressed.report.at("seconds").at("all").get<double>(),
                    static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
        girth_errors(dressed, whole).print("abdomen's girths");
        ease_errors(dressed, truth, whole ? dressed.customer.mesh : dressed.changed_body)
            .print("room of the garment (true bodies)");
        fit_errors(dressed, truth).print("body found beneath the garment");
        print_folds(dressed);
        if (true_look.empty()) continue;
        const auto look = assets::load_colored_mesh(true_look);
        std::printf("  outline over 8 views, overlap with the simulated garment: %.3f\n",
                    evaluation::silhouette_overlap(dressed.look.mesh, look.mesh));
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fputs("dress_evaluation MANNEQUIN_SCAN AVATAR CUSTOMER[=TRUTH.glb] ...\n", stderr);
        return 2;
    }
    try {
        host::Services services(2);
        host::Registry registry(services, {});
        toile_limits limits{};
        limits.size = sizeof(limits);
        limits.max_people = 1;
        limits.max_vertices = 2'000'000;
        limits.max_triangles = 4'000'000;
        limits.thread_count = services.thread_count();
        limits.frame_budget_s = 1.0 / 30.0;
        limits.random_seed = 1;
        const auto mannequin = assets::load_colored_mesh(argv[1]);
        const auto avatar = body::load_body_model(body::find_avatar(argv[2]));
        for (int i = 3; i < argc; ++i)
            evaluate(registry, services, limits, mannequin, avatar.rest, argv[i]);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dress_evaluation: %s\n", e.what());
        return 1;
    }
    return 0;
}
