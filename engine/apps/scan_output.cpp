#include "apps/scan_output.h"

#include "apps/contact_sheet.h"
#include "assets/files.h"
#include "core/error.h"
#include "geometry/decimate.h"
#include "geometry/nearest_surface.h"
#include "pipeline/rigging.h"
#include "render/import.h"
#include "render/views.h"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <iostream>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
using assets::ColoredMesh;

void check_folder(const fs::path& file, const char* option) {
    if (file.empty() || !file.has_parent_path()) return;
    std::error_code code;
    if (!fs::is_directory(file.parent_path(), code))
        throw UsageError("scan " + std::string(option) + " '" + file.string() + "': the folder " +
                         file.parent_path().string() + " does not exist");
}

/// At most `triangles`, and how far the full surface is from it.
ColoredMesh coarser(const ColoredMesh& full, std::size_t triangles,
                    nlohmann::ordered_json& report) {
    ColoredMesh out = assets::decimated(full, triangles);
    const geometry::NearestSurface surface(out.mesh.positions, out.mesh.triangles);
    std::vector<float> errors;
    for (const Vec3f& p : full.mesh.positions)
        errors.push_back(surface.nearest(p).distance);
    std::sort(errors.begin(), errors.end());
    double mean = 0.0;
    for (const float e : errors)
        mean += e / static_cast<double>(errors.size());
    report["decimation"] = {{"from_triangles", full.mesh.triangles.size()},
                            {"triangles", out.mesh.triangles.size()},
                            {"error_mean_m", mean},
                            {"error_p95_m", errors[errors.size() * 95 / 100]},
                            {"error_max_m", errors.back()}};
    return out;
}

/// Each mesh's views, side by side.
void save_picture(const std::vector<ColoredMesh>& meshes, const char* views, const fs::path& file) {
    constexpr int kWidth = 400, kHeight = 640;
    const std::unique_ptr<render::Context> context = render::make_offscreen_context();
    render::RendererOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.quality = render::Quality::high;
    render::Renderer renderer(*context, options);
    std::vector<imaging::Image> pictures;
    for (const ColoredMesh& mesh : meshes) {
        const auto added = render::add_scene(renderer, assets::scene_of(mesh, "scan"),
                                             render::mannequin_material());
        render::Scene scene;
        scene.instances = added.instances;
        const Vec3f middle = 0.5f * (added.bounds.low + added.bounds.high),
                    half = 0.5f * (added.bounds.high - added.bounds.low);
        for (render::Instance& instance : scene.instances)
            instance.world_from_mesh.translation =
                -Vec3f(middle.x(), added.bounds.low.y(), middle.z());
        for (const render::View& view : render::views_from_names(views)) {
            scene.camera =
                render::frame_view(view, Vec3f(-half.x(), 0.0f, -half.z()),
                                   Vec3f(half.x(), 2.0f * half.y(), half.z()), kWidth, kHeight);
            scene.lighting = render::studio_lighting(scene.camera);
            renderer.draw(scene);
            pictures.push_back(renderer.read());
        }
    }
    imaging::save_image(side_by_side(pictures), file);
}

/// The scan in so many moments of the motion, first as it stands.
std::vector<ColoredMesh> moments(const ColoredMesh& scan, const pipeline::RiggedScan& rig,
                                 const body::Motion& motion) {
    constexpr int kMoments = 3;
    std::vector<ColoredMesh> out{scan};
    for (int k = 1; k <= kMoments; ++k) {
        const double time_s = motion.duration() * k / (kMoments + 1);
        ColoredMesh posed = scan;
        posed.mesh.positions = pipeline::posed(scan.mesh, rig, body::sample(motion, time_s));
        geometry::vertex_normals(posed.mesh.positions, posed.mesh.triangles, posed.mesh.normals);
        out.push_back(std::move(posed));
    }
    return out;
}

pipeline::RiggedScan rigged(const ColoredMesh& scan, host::Registry& registry,
                            host::Services& services, const toile_limits& limits) {
    host::Job job({}, &host::interrupt_flag());
    pipeline::BodyFit fit(registry, services, limits);
    fit.feed_scan(scan.mesh, job, scan.colors);
    return pipeline::rig_scan(scan.mesh, fit.fit({}, job));
}

void print(const nlohmann::ordered_json& report) {
    for (const auto& [key, value] : report.items())
        std::cout << "  " << key << " " << value.dump() << "\n";
}

} // namespace

void add_scan_output(CLI::App& command, ScanOutput& output) {
    command.add_option("--out", output.file, "Gets the surface: .ply, .glb or .obj")
        ->type_name("FILE")
        ->required();
    command.add_option("--report", output.report, "Gets how it went, as JSON")->type_name("FILE");
    command.add_option("--picture", output.picture, "Draws the surface from three sides")
        ->type_name("FILE");
    command
        .add_option("--triangles", output.triangles, "Makes the surface coarser: at most so many")
        ->check(CLI::Range(std::size_t{200}, std::size_t{4'000'000}));
    command.add_flag("--rig", output.rig,
                     "Gives the .glb a skeleton and skin weights, through a body fitted to it");
    command
        .add_option("--motion", output.motion,
                    "With --rig: a .bvh, .jsonl or .json motion, as an animation in the .glb; the "
                    "picture then shows moments of it")
        ->type_name("FILE");
}

void check(const ScanOutput& output) {
    const std::string kind = output.file.extension().string();
    if (kind != ".glb" && kind != ".ply" && kind != ".obj")
        throw UsageError("scan --out '" + output.file.string() +
                         "': name a .ply, .glb or .obj file");
    if (output.rig && kind != ".glb")
        throw UsageError("scan --rig: only a .glb holds a skeleton; --out '" +
                         output.file.string() + "' is none");
    if (!output.motion.empty() && !output.rig) throw UsageError("scan --motion: needs --rig");
    if (!output.motion.empty() && !fs::exists(output.motion))
        throw UsageError("scan --motion '" + output.motion.string() + "': no such file");
    check_folder(output.file, "--out");
    check_folder(output.report, "--report");
    check_folder(output.picture, "--picture");
}

void save(pipeline::ScannedSurface scanned, const ScanOutput& output, host::Registry& registry,
          host::Services& services, const toile_limits& limits) {
    ColoredMesh& surface = scanned.surface;
    if (output.triangles > 0 && output.triangles < surface.mesh.triangles.size())
        surface = coarser(surface, output.triangles, scanned.report);
    scanned.report["vertices"] = surface.mesh.positions.size();
    scanned.report["triangles"] = surface.mesh.triangles.size();
    std::vector<ColoredMesh> shown;
    if (output.rig) {
        const pipeline::RiggedScan rig = rigged(surface, registry, services, limits);
        scanned.report["rig"] = rig.report;
        std::optional<body::Motion> motion;
        if (!output.motion.empty()) {
            motion = body::load_motion(output.motion, rig.skeleton, &rig.volumes);
            shown = moments(surface, rig, *motion);
        }
        assets::save_scene(pipeline::rigged_scene(surface, rig, motion ? &*motion : nullptr),
                           output.file);
    } else {
        assets::save_scene(assets::scene_of(surface, "scan"), output.file);
    }
    if (!output.report.empty()) {
        std::ofstream out(output.report);
        out << scanned.report.dump(2) << "\n";
        if (!out) throw FileError(output.report.string(), "cannot be written");
    }
    if (!output.picture.empty()) {
        if (shown.empty())
            save_picture({surface}, "front,left,back", output.picture);
        else
            save_picture(shown, "three_quarter_left", output.picture);
    }
    print(scanned.report);
}

} // namespace toile::apps
