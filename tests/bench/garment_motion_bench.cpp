// Garments of the repository in motion, by a cloth plugin that is linked in: contact, visible skin
// and strain of every frame, and what the cloth costs. One line of JSON per garment:
//
//     garment_motion_bench --garment tee,dress --motion walk.bvh --frames 120
//     garment_motion_bench --garment tee --motion walk.bvh --plugin toile.bullet_cloth --each
#include "body/body_volumes.h"
#include "body/motion.h"
#include "core/error.h"
#include "garment/cloth_strain.h"
#include "garment/contact_metrics.h"
#include "garment/size_choice.h"
#include "geometry/self_intersection.h"
#include "host/job.h"
#include "host/registry.h"
#include "pipeline/motion_source.h"
#include "pipeline/try_on_run.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

extern "C" const toile_entry toile_plugin_entry_xpbd_cloth, toile_plugin_entry_bullet_cloth;

namespace {

using namespace toile;

constexpr double kFramesPerSecond = 30.0;

struct Options {
    std::string plugin = "toile.xpbd_cloth", body = "adult", motion;
    std::vector<std::string> garments;
    std::uint64_t frames = 120;
    bool each = false;   // a line per frame
    bool measure = true; // contact, which is slow
};

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> out;
    std::istringstream in(list);
    for (std::string name; std::getline(in, name, ',');)
        out.push_back(name);
    return out;
}

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--each" || word == "--speed") {
            options.each = options.each || word == "--each";
            options.measure = options.measure && word != "--speed";
            continue;
        }
        if (i + 1 >= argc) throw Error(word + ": needs a value, or is unknown");
        const std::string value = argv[++i];
        if (word == "--plugin") {
            options.plugin = value;
        } else if (word == "--body") {
            options.body = value;
        } else if (word == "--motion") {
            options.motion = value;
        } else if (word == "--garment") {
            options.garments = split(value);
        } else if (word == "--frames") {
            options.frames = std::stoull(value);
        } else {
            throw Error(word + ": unknown; see the head of garment_motion_bench.cpp");
        }
    }
    if (options.motion.empty() || options.garments.empty())
        throw Error("give --garment and --motion");
    return options;
}

std::shared_ptr<const pipeline::BoundaryBody> load_body(const std::string& id, std::uint64_t rev) {
    return std::make_shared<const pipeline::BoundaryBody>(
        std::make_shared<const body::BodyModel>(body::load_body_model(body::find_avatar(id))), rev);
}

/// "tee", or "tee+trousers" worn together
std::vector<std::shared_ptr<const pipeline::BoundaryGarment>>
load_outfit(const std::string& ids, const pipeline::BoundaryBody& body) {
    std::vector<std::shared_ptr<const pipeline::BoundaryGarment>> out;
    std::istringstream in(ids);
    for (std::string id; std::getline(in, id, '+');) {
        auto package = garment::load_package(garment::find_garment(id));
        const std::size_t size =
            package->sizes.size() > 1
                ? garment::choose_size(*package, body.model().measurements).index
                : 0;
        const garment::GarmentSize& chosen = package->sizes[size];
        const std::string& made_on =
            chosen.entry.made_on.empty() ? package->manifest.made_on : chosen.entry.made_on;
        auto made = made_on.empty() ? nullptr : load_body(made_on, 100 + out.size());
        out.push_back(std::make_shared<const pipeline::BoundaryGarment>(std::move(package), chosen,
                                                                        std::move(made)));
    }
    return out;
}

host::Manifest manifest_of(const toile_entry& entry) {
    const toile_descriptor* descriptor = entry.describe(0);
    host::Manifest out;
    out.id = descriptor->id;
    out.version = descriptor->version;
    out.abi_major = entry.abi_major;
    out.abi_minor = entry.abi_minor;
    out.provides = {TOILE_CLOTH};
    out.priority = 100;
    return out;
}

/// What is worst in any frame.
struct Worst {
    std::size_t vertices = 0;
    double deep = 0.0, deep_sum = 0.0, deepest_mm = 0.0, visible = 0.0;
    double strain_rms = 0.0, strain_max = 0.0;
    double cut = 0.0, cut_sum = 0.0; // fraction of triangles, each garment by itself

    explicit Worst(const pipeline::DressedPerson& person) {
        for (const pipeline::WornGarment& worn : person.garments()) {
            const garment::GarmentSize& size = worn.garment().size();
            const geometry::TriangleMesh& mesh = size.simulation;
            strains_.emplace_back(mesh.triangles, size.material_coords, mesh.positions.size());
            surfaces_.push_back({worn.bound, worn.triangles()});
            vertices += mesh.positions.size();
        }
        metrics_.emplace(person.body().model().rest.positions, person.body().model().rest.triangles,
                         surfaces_);
    }

    void add(const pipeline::DressedPerson& person, std::uint64_t frame, const Options& options) {
        double area = 0.0;
        double squares = 0.0;
        double largest = 0.0;
        surfaces_.clear();
        for (std::size_t g = 0; g < strains_.size(); ++g) {
            const pipeline::WornGarment& worn = person.garments()[g];
            surfaces_.push_back({worn.positions, worn.triangles()});
            strains_[g].measure(worn.positions);
            const garment::StrainFigures found = strains_[g].figures();
            area += found.rest_area;
            squares += found.rest_area * found.rms * found.rms;
            largest = std::max(largest, found.max);
        }
        const double rms = std::sqrt(squares / area);
        strain_rms = std::max(strain_rms, rms);
        strain_max = std::max(strain_max, largest);
        garment::ContactFigures now;
        if (options.measure) now = metrics_->measure(person.posed().positions, surfaces_);
        const double cuts_now = options.measure ? cut_fraction() : 0.0;
        cut = std::max(cut, cuts_now);
        cut_sum += cuts_now;
        deep = std::max(deep, now.deep_fraction());
        deep_sum += now.deep_fraction();
        deepest_mm = std::max(deepest_mm, 1e3 * now.deepest_m);
        visible = std::max(visible, now.visible_fraction());
        if (options.each)
            std::cout << frame << " deep " << now.deep_fraction() << " deepest_mm "
                      << 1e3 * now.deepest_m << " visible " << now.visible_fraction() << " strain "
                      << rms << " " << largest << " cut " << cuts_now << std::endl;
    }

  private:
    [[nodiscard]] double cut_fraction() const {
        std::size_t cut_triangles = 0;
        std::size_t triangles = 0;
        for (const garment::ClothSurface& surface : surfaces_) {
            const auto flags = geometry::self_intersecting(surface.positions, surface.triangles);
            cut_triangles += std::count(flags.begin(), flags.end(), std::uint8_t{1});
            triangles += flags.size();
        }
        return double(cut_triangles) / double(std::max<std::size_t>(triangles, 1));
    }

    std::vector<garment::ClothStrain> strains_;
    std::vector<garment::ClothSurface> surfaces_;
    std::optional<garment::ContactMetrics> metrics_;
};

nlohmann::ordered_json run(const Options& options, const std::string& outfit) {
    host::Services services(1);
    host::Registry registry(services, {.environment = false});
    const bool bullet = options.plugin == "toile.bullet_cloth";
    const toile_entry& entry =
        bullet ? toile_plugin_entry_bullet_cloth : toile_plugin_entry_xpbd_cloth;
    registry.add(entry, manifest_of(entry));
    const auto body = load_body(options.body, 1);
    pipeline::DressingOptions dressing;
    dressing.limits = host::sized<toile_limits>();
    dressing.limits.max_people = 1;
    dressing.limits.max_vertices = 200'000;
    dressing.limits.max_triangles = 400'000;
    dressing.limits.thread_count = 1;
    host::Job job;
    pipeline::DressedPerson person(registry, services, body, load_outfit(outfit, *body), dressing,
                                   job);
    const body::Skeleton& skeleton = body->model().skeleton;
    const body::BodyVolumes volumes =
        body::measure_volumes(skeleton, body->model().rest.positions, body->model().parts);
    pipeline::MotionSource source(body::load_motion(options.motion, skeleton, &volumes), skeleton,
                                  kFramesPerSecond);
    pipeline::RunOptions run_options;
    run_options.most_frames = options.frames;
    pipeline::TryOnRun run(source, person, run_options);

    Worst worst(person);
    std::uint64_t frame = 0;
    for (; run.next(); ++frame)
        worst.add(person, frame, options);
    const auto report = run.report();
    return {{"plugin", options.plugin},
            {"garment", outfit},
            {"frames", frame},
            {"vertices", worst.vertices},
            {"deep_fraction_max", worst.deep},
            {"deep_fraction_mean", worst.deep_sum / double(std::max<std::uint64_t>(frame, 1))},
            {"deepest_mm", worst.deepest_mm},
            {"visible_fraction_max", worst.visible},
            {"cut_fraction_max", worst.cut},
            {"cut_fraction_mean", worst.cut_sum / double(std::max<std::uint64_t>(frame, 1))},
            {"strain_rms_max", worst.strain_rms},
            {"strain_max", worst.strain_max},
            {"cloth_ms_median", report.stages.at("cloth").median_ms},
            {"cloth_ms_p95", report.stages.at("cloth").p95_ms},
            {"digest", report.positions_digest}};
}

} // namespace

int main(int argc, char** argv) {
    try {
        const Options options = parse(argc, argv);
        for (const std::string& outfit : options.garments)
            std::cout << run(options, outfit).dump() << std::endl;
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "garment_motion_bench: " << error.what() << '\n';
        return 1;
    }
}
