// toile fit: one person's body from a scan or from cameras' pictures.
#include "apps/commands.h"
#include "apps/fitted_body.h"
#include "assets/files.h"
#include "body/body_file.h"
#include "core/error.h"
#include "core/log.h"
#include "pipeline/body_fit.h"

#include <iomanip>
#include <iostream>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct FitCommand {
    FitInput input;
    fs::path out, mesh;
};

void save_surface(const geometry::TriangleMesh& surface, const fs::path& file) {
    assets::Primitive primitive;
    primitive.positions = surface.positions;
    primitive.normals = surface.normals;
    primitive.triangles = surface.triangles;
    assets::Scene scene;
    scene.meshes.push_back({"body", {std::move(primitive)}, {}});
    assets::Node node;
    node.name = "body";
    node.mesh = 0;
    scene.nodes.push_back(node);
    assets::save_scene(scene, file);
}

void print(const pipeline::FittedBody& body) {
    std::cout << std::fixed << std::setprecision(1);
    for (const char* name : {"stature", "bust_girth", "waist_girth", "hip_girth", "thigh_girth",
                             "inside_leg_length", "arm_length"})
        if (const auto at = body.measurements.find(name); at != body.measurements.end())
            std::cout << "  " << std::left << std::setw(20) << name << std::right << std::setw(7)
                      << 100.0 * at->second.value_m << " cm\n";
    for (const auto& [key, value] : body.report.items())
        std::cout << "  " << key << " " << value.dump() << "\n";
}

void fit(const FitCommand& command, const GlobalOptions& global) {
    if (command.out.extension() != ".json")
        throw UsageError("fit --out '" + command.out.string() +
                         "': name a .json file; --mesh FILE writes the surface");
    const pipeline::FittedBody body = fit_body(command.input, global);
    save_body_file(body_file_of(body), command.out);
    if (!command.mesh.empty()) {
        if (body.surfaces.size() == 1)
            save_surface(body.surfaces.front(), command.mesh);
        else
            for (std::size_t i = 0; i < body.surfaces.size(); ++i)
                save_surface(body.surfaces[i],
                             command.mesh.parent_path() /
                                 (command.mesh.stem().string() + "-" + std::to_string(i) +
                                  command.mesh.extension().string()));
    }
    print(body);
    std::cout << "wrote " << command.out.string() << "\n";
}

} // namespace

void add_fit_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command =
        app.add_subcommand("fit", "Finds one person's body in a scan or in depth pictures");
    const auto options = std::make_shared<FitCommand>();
    add_fit_input(*command, options->input);
    command->add_option("--out", options->out, "Gets the body")->type_name("body.json")->required();
    command
        ->add_option("--mesh", options->mesh,
                     "Gets the surface as it was seen: .ply, .obj or .glb; of several frames "
                     "one file each")
        ->type_name("FILE");
    command->footer(
        "Example: toile fit --scan anna.ply --out anna.json --mesh anna-fitted.ply\n"
        "         toile fit --source capture:front --source capture:back --out anna.json");
    command->callback([options, &global] { fit(*options, global); });
}

} // namespace toile::apps
