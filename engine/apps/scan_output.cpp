#include "apps/scan_output.h"

#include "apps/contact_sheet.h"
#include "assets/baked_texture.h"
#include "assets/files.h"
#include "core/error.h"
#include "core/log.h"
#include "geometry/decimate.h"
#include "geometry/nearest_surface.h"
#include "geometry/projected_charts.h"
#include "pipeline/rigging.h"
#include "render/import.h"
#include "render/views.h"

#include <algorithm>
#include <cmath>
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

std::string texture_name(const ScanOutput& output) {
    return output.file.stem().string() + "_texture";
}

/// A texture and how it lies on the surface.
struct Painted {
    geometry::SeamedLayout layout;
    assets::Texture texture;
};

/// The colours of `full` as a texture on `surface`, as many texels a side.
Painted painted(const ColoredMesh& full, const ColoredMesh& surface, int side,
                const std::string& name, const RowLoop& rows, nlohmann::ordered_json& report) {
    if (full.colors.empty())
        throw Error("scan --texture: the cameras gave no colours that could be drawn");
    // Gaps that shrink with the texture, and half of each filled from either side.
    const int gap = std::clamp(side / 256, 2, 8);
    geometry::ProjectedAtlas atlas =
        geometry::make_projected_atlas(surface.mesh.positions, surface.mesh.triangles, {side, gap});
    Painted out;
    out.texture = {name, assets::bake_colors(full, surface.mesh, atlas.layout, side, gap / 2, rows),
                   false};
    report["texture"] = {{"side", side},
                         {"charts", atlas.chart_count},
                         {"texel_m", atlas.side / static_cast<float>(side)}};
    out.layout = std::move(atlas.layout);
    return out;
}

assets::Scene scene_of(const ColoredMesh& mesh, const std::optional<Painted>& paint) {
    assets::Scene scene = assets::scene_of(mesh, "scan");
    if (paint) assets::put_on(scene, paint->layout, paint->texture);
    return scene;
}

/// Each scene's views, side by side.
void save_picture(const std::vector<assets::Scene>& scenes, const char* views,
                  const fs::path& file) {
    constexpr int kWidth = 400, kHeight = 640;
    const std::unique_ptr<render::Context> context = render::make_offscreen_context();
    render::RendererOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.quality = render::Quality::high;
    render::Renderer renderer(*context, options);
    std::vector<imaging::Image> pictures;
    for (const assets::Scene& shown : scenes) {
        const auto added = render::add_scene(renderer, shown, render::mannequin_material());
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

/// A surface of which much is made up should not pass for one that was seen.
void warn_of_guesses(const nlohmann::ordered_json& report) {
    constexpr double kMuch = 0.25;
    const double guessed = report.value("guessed_share", 0.0);
    if (guessed > kMuch)
        log::warning("scan: nobody saw " + std::to_string(std::lround(100.0 * guessed)) +
                     " % of the surface, it is made up: see that the camera reads all sides (dark "
                     "or shiny cloth and sunlight are not read)");
    if (report.contains("body") && report["body"].contains("reason"))
        log::warning("scan: no body could be fitted to help, so limbs that moved may be thick or "
                     "double: " +
                     report["body"]["reason"].get<std::string>());
    constexpr double kBeside = 0.02;
    const double beside = report.value("beside_share", 0.0);
    if (beside <= kBeside) return;
    const std::string what = "scan: " + std::to_string(std::lround(100.0 * beside)) +
                             " % of what was seen lies more than 4 cm beside the fitted body: ";
    log::warning(report.value("carried_left_out", false)
                     ? what + "a bag or the like, it was left out and what it hid is made up"
                     : what + "wide clothes or something carried, which may be smeared");
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
    command
        .add_option("--texture", output.texture,
                    "Colours as a texture of so many texels a side (2048 without a number), in the "
                    ".glb or beside the .obj; those of the full surface, whatever --triangles says")
        ->expected(0, 1)
        ->default_str("2048")
        ->check(CLI::Range(256, 8192))
        ->type_name("SIZE");
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
    if (output.texture != 0 && kind == ".ply")
        throw UsageError("scan --texture: a .ply holds none; --out '" + output.file.string() +
                         "' must be a .glb or .obj");
    if (output.texture != 0 && kind == ".obj" &&
        output.picture == output.file.parent_path() / (texture_name(output) + ".png"))
        throw UsageError("scan --picture '" + output.picture.string() +
                         "': the texture goes there; name another file");
    if (!output.motion.empty() && !output.rig) throw UsageError("scan --motion: needs --rig");
    if (!output.motion.empty() && !fs::exists(output.motion))
        throw UsageError("scan --motion '" + output.motion.string() + "': no such file");
    check_folder(output.file, "--out");
    check_folder(output.report, "--report");
    check_folder(output.picture, "--picture");
}

void save(pipeline::ScannedSurface scanned, const ScanOutput& output, host::Registry& registry,
          host::Services& services, const toile_limits& limits) {
    const ColoredMesh full = scanned.surface;
    ColoredMesh& surface = scanned.surface;
    if (output.triangles > 0 && output.triangles < surface.mesh.triangles.size())
        surface = coarser(surface, output.triangles, scanned.report);
    scanned.report["vertices"] = surface.mesh.positions.size();
    scanned.report["triangles"] = surface.mesh.triangles.size();
    std::optional<Painted> paint;
    if (output.texture > 0)
        paint = painted(full, surface, output.texture, texture_name(output),
                        host::rows_of(services), scanned.report);
    std::vector<assets::Scene> shown;
    if (output.rig) {
        const pipeline::RiggedScan rig = rigged(surface, registry, services, limits);
        scanned.report["rig"] = rig.report;
        std::optional<body::Motion> motion;
        if (!output.motion.empty()) {
            motion = body::load_motion(output.motion, rig.skeleton, &rig.volumes);
            for (const ColoredMesh& moment : moments(surface, rig, *motion))
                shown.push_back(scene_of(moment, paint));
        }
        assets::Scene scene = pipeline::rigged_scene(surface, rig, motion ? &*motion : nullptr);
        if (paint) assets::put_on(scene, paint->layout, paint->texture);
        assets::save_scene(scene, output.file);
    } else {
        assets::save_scene(scene_of(surface, paint), output.file, {.materials_beside = true});
    }
    if (!output.report.empty()) {
        std::ofstream out(output.report);
        out << scanned.report.dump(2) << "\n";
        if (!out) throw FileError(output.report.string(), "cannot be written");
    }
    if (!output.picture.empty()) {
        if (shown.empty())
            save_picture({scene_of(surface, paint)}, "front,left,back", output.picture);
        else
            save_picture(shown, "three_quarter_left", output.picture);
    }
    warn_of_guesses(scanned.report);
    print(scanned.report);
}

} // namespace toile::apps
