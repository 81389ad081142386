// feature_evaluation PERSON...: P1's Table 1 made again, and registration by features against plain
// ICP. PERSON: folders of `toile avatar test-people`; each is seen by simulated
// cameras beside, turned about, before and around a first one.
#include "core/error.h"
#include "core/random.h"
#include "scan/global_registration.h"
#include "scan/subject.h"
#include "scan/voxel_grid.h"
#include "simulated_views.h"

#include <cstdio>
#include <map>

namespace {

using namespace toile;
namespace sensor = simulated_sensor;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Place {
    std::string kind; ///< "" for the first
    Eigen::Isometry3d world_from_camera;
};

std::vector<Place> places() {
    const Vec3d target(0.0, 0.95, 0.0);
    const Vec3d home(0.0, 1.05, 2.0);
    std::vector<Place> out = {{"", sensor::look_at(home, target)}};
    for (const double aside : {-0.3, -0.15, 0.15, 0.3})
        out.push_back(
            {"pan", sensor::look_at(home + Vec3d(aside, 0, 0), target + Vec3d(aside, 0, 0))});
    for (const double roll : {20.0, 45.0, -90.0})
        out.push_back({"spin", sensor::look_at(home, target, roll * kDegree)});
    for (const double far : {1.6, 2.5})
        out.push_back({"zoom", sensor::look_at(Vec3d(0, 1.05, far), target)});
    for (const double angle : {10.0, 20.0, 30.0})
        out.push_back({"view" + std::to_string(static_cast<int>(angle)),
                       sensor::look_at(Vec3d(2.0 * std::sin(angle * kDegree), 1.05,
                                             2.0 * std::cos(angle * kDegree)),
                                       target)});
    return out;
}

struct View {
    scan::DepthView depth;
    std::map<scan::Descriptor, std::vector<scan::Feature>> features;
    std::map<scan::Descriptor, double> seconds; ///< finding and describing
};

std::vector<View> look(const std::string& person, const scan::GlobalOptions& options) {
    sensor::Scenario scenario = evaluation::empty_room();
    scenario.color = true;
    sensor::PersonSettings settings;
    settings.kind = sensor::BodyKind::test_person;
    settings.source = person;
    scenario.people.push_back(settings);
    for (const Place& place : places()) {
        sensor::CameraSettings camera = sensor::camera_of(sensor::CameraModel::kinect_v1);
        camera.name = "c" + std::to_string(scenario.cameras.size());
        camera.upright = true;
        camera.world_from_camera = place.world_from_camera;
        scenario.cameras.push_back(camera);
    }
    sensor::Simulator simulator(std::move(scenario), &evaluation::rows_on_all_cores);
    simulator.show(0);
    std::vector<View> out;
    for (std::size_t c = 0; c < simulator.camera_count(); ++c) {
        simulator.see(c);
        const imaging::Image& color = simulator.picture(c);
        std::vector<scan::Rgba8> colors;
        for (std::size_t i = 0; i + 3 < color.pixels.size(); i += 4)
            colors.push_back({color.pixels[i], color.pixels[i + 1], color.pixels[i + 2], 255});
        const scan::Picture picture{simulator.camera(c).intrinsics(),
                                    simulator.camera(c).depth().metres, colors};
        const Vec3f up =
            (simulator.camera(c).settings().world_from_camera.linear().transpose() * Vec3d::UnitY())
                .cast<float>();
        const scan::Subject subject = scan::find_subject(picture, up);
        if (!subject.trouble.empty()) throw Error(person + ": " + subject.trouble);
        View& view = out.emplace_back();
        view.depth = scan::filtered_view(picture, subject.mask, {}, evaluation::rows_on_all_cores);
        for (const auto descriptor : {scan::Descriptor::full, scan::Descriptor::simple}) {
            const double start = evaluation::seconds();
            view.features[descriptor] =
                scan::find_features(view.depth, descriptor, options.features);
            view.seconds[descriptor] = evaluation::seconds() - start;
        }
    }
    return out;
}

struct Row {
    double pictures = 0, features = 0, matches = 0, right = 0, kept = 0, kept_right = 0;
    double describe_s = 0, match_s = 0;
};

void add(const View& a, const View& b, const Eigen::Isometry3d& a_from_b,
         const scan::GlobalOptions& options, Row& row) {
    constexpr double kRight_m = 0.02;
    const auto& from = b.features.at(options.descriptor);
    const auto& to = a.features.at(options.descriptor);
    const double start = evaluation::seconds();
    const auto matches = scan::match(to, from, options.descriptor, options.ratio);
    row.match_s += evaluation::seconds() - start;
    row.describe_s += a.seconds.at(options.descriptor) + b.seconds.at(options.descriptor);
    row.pictures += 1;
    row.features += static_cast<double>(from.size());
    const auto error = [&](const scan::Match& m) {
        return (to[m.a].point.cast<double>() - a_from_b * from[m.b].point.cast<double>()).norm();
    };
    const auto found = scan::register_features(to, from, options);
    for (const scan::Match& m : matches) {
        row.matches += 1;
        const bool right = error(m) < kRight_m;
        row.right += right ? 1 : 0;
        if (!found ||
            (to[m.a].point.cast<double>() - found->a_from_b * from[m.b].point.cast<double>())
                    .norm() > options.reach_m)
            continue;
        row.kept += 1;
        row.kept_right += right ? 1 : 0;
    }
}

void print(const std::string& name, const Row& row) {
    std::printf("  %-8s %5.0f features  %5.1f matches  right %.4f  after RANSAC %5.1f  right %.4f  "
                "find and describe %6.1f ms  match %7.2f ms\n",
                name.c_str(), row.features / row.pictures, row.matches / row.pictures,
                row.right / std::max(1.0, row.matches), row.kept / row.pictures,
                row.kept_right / std::max(1.0, row.kept), 1e3 * row.describe_s / row.pictures,
                1e3 * row.match_s / row.pictures);
}

/// Off by 60 degrees about some axis through the subject and by half a metre.
Eigen::Isometry3d wrong_start(const Eigen::Isometry3d& right, const Vec3d& middle, Random& random) {
    const auto direction = [&] {
        Vec3d out;
        do
            out = Vec3d(random.normal(), random.normal(), random.normal());
        while (out.norm() < 0.1);
        return out.normalized();
    };
    Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
    move.translate(0.5 * direction());
    move.translate(middle);
    move.rotate(Eigen::AngleAxisd(60.0 * kDegree, direction()));
    move.translate(-middle);
    return move * right;
}

struct Success {
    int tries = 0, features = 0, features_simple = 0, planes = 0, points = 0;
    double turn_deg = 0, shift_mm = 0; ///< sums of what is left after features
};

std::vector<Vec3f> cloud(const scan::DepthView& view) {
    std::vector<Vec3f> all;
    for (int y = 0; y < view.camera.height; ++y)
        for (int x = 0; x < view.camera.width; ++x)
            if (view.depth[view.camera.at(x, y)] > 0.0f) all.push_back(view.point(x, y));
    return scan::thinned(all, scan::cell_size(all, 1.0, 8.0));
}

void converge(const View& a, const View& b, const Eigen::Isometry3d& right,
              scan::GlobalOptions options, Random& random, Success& out) {
    const auto cloud_a = cloud(a.depth), cloud_b = cloud(b.depth);
    Vec3d middle = Vec3d::Zero();
    for (const Vec3f& p : cloud_a)
        middle += p.cast<double>() / static_cast<double>(cloud_a.size());
    const auto left = [&](const Eigen::Isometry3d& found) {
        const Eigen::Isometry3d off = found * right.inverse();
        return std::pair{Eigen::AngleAxisd(off.linear()).angle() / kDegree,
                         1e3 * (off * middle - middle).norm()};
    };
    const auto good = [&](const Eigen::Isometry3d& found) {
        const auto [turn, shift] = left(found);
        return turn < 2.0 && shift < 20.0;
    };
    ++out.tries;
    const Eigen::Isometry3d start = wrong_start(right, middle, random);
    out.points += good(scan::register_clouds(cloud_a, cloud_b, start, 1e-9, 100).pose) ? 1 : 0;
    out.planes +=
        good(scan::register_surfaces(a.depth, b.depth, start, 0.3f, evaluation::rows_on_all_cores)
                 .pose)
            ? 1
            : 0;
    for (const auto descriptor : {scan::Descriptor::full, scan::Descriptor::simple}) {
        options.descriptor = descriptor;
        const auto found =
            scan::register_globally(a.depth, b.depth, options, evaluation::rows_on_all_cores);
        if (!found || !good(found->a_from_b)) continue;
        if (descriptor == scan::Descriptor::simple) {
            ++out.features_simple;
            continue;
        }
        ++out.features;
        const auto [turn, shift] = left(found->a_from_b);
        out.turn_deg += turn, out.shift_mm += shift;
    }
}

void run(const std::vector<std::string>& people) {
    std::map<std::string, std::map<scan::Descriptor, Row>> rows;
    std::map<std::string, Success> converged;
    scan::GlobalOptions options;
    Random random(60);
    const auto all = places();
    for (const std::string& person : people) {
        const std::vector<View> views = look(person, options);
        for (std::size_t c = 1; c < views.size(); ++c) {
            const Eigen::Isometry3d a_from_b =
                all[0].world_from_camera.inverse() * all[c].world_from_camera;
            for (const auto descriptor : {scan::Descriptor::full, scan::Descriptor::simple}) {
                options.descriptor = descriptor;
                add(views[0], views[c], a_from_b, options, rows[all[c].kind][descriptor]);
            }
            if (all[c].kind.starts_with("view"))
                converge(views[0], views[c], a_from_b, options, random, converged[all[c].kind]);
        }
        std::fprintf(stderr, "%s done\n", person.c_str());
    }
    for (const auto descriptor : {scan::Descriptor::full, scan::Descriptor::simple}) {
        std::printf("%s\n", descriptor == scan::Descriptor::full ? "128 numbers" : "12 numbers");
        for (const auto& [kind, both] : rows)
            print(kind, both.at(descriptor));
    }
    std::printf("from a start that is off by 60 degrees and 0.5 m, of so many tries\n");
    for (const auto& [kind, s] : converged)
        std::printf(
            "  %-8s of %d starts: plain ICP %d, point to plane %d; of %d pairs: features (128) "
            "%d, (12) %d; left %.2f deg %.1f mm\n",
            kind.c_str(), s.tries, s.points, s.planes, s.tries, s.features, s.features_simple,
            s.turn_deg / std::max(1, s.features), s.shift_mm / std::max(1, s.features));
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 2) throw toile::Error("feature_evaluation PERSON...");
        run({argv + 1, argv + argc});
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
