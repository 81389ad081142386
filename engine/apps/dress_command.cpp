// toile dress: a customer in what a mannequin wears, from two scans.
#include "apps/commands.h"
#include "apps/dressed_picture.h"
#include "apps/plugin_limits.h"
#include "assets/files.h"
#include "core/error.h"
#include "core/json.h"
#include "pipeline/mannequin_dressing.h"

#include <cctype>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <unistd.h>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct DressCommand {
    fs::path mannequin, customer, out, report, picture, garment;
    std::string fit = "abdomen";
    std::uint32_t strips = 0;
};

assets::ColoredMesh load(const fs::path& file, const char* option) {
    assets::ColoredMesh out = assets::load_colored_mesh(file);
    if (out.mesh.triangles.empty())
        throw Error(std::string(option) + " " + file.string() +
                    ": a cloud of points without triangles: make a surface of it first");
    return out;
}

void save_report(const nlohmann::ordered_json& report, const fs::path& file) {
    std::ofstream out(file);
    out << report.dump(2) << "\n";
    if (!out) throw FileError(file.string(), "cannot be written");
}

void print(const nlohmann::ordered_json& report) {
    std::cout << std::fixed << std::setprecision(1);
    for (const char* who : {"mannequin", "customer"}) {
        std::cout << who << ":";
        for (const auto& [name, value] : report.at(who).at("measurements").items())
            std::cout << " " << name << " " << 100.0 * value.get<double>() << " cm";
        std::cout << "\n";
    }
    const auto& garment = report.at("garment");
    if (garment.contains("room_change_m"))
        std::cout << "garment: room to the body changes by "
                  << 1000.0 * garment.at("room_change_m").at("median").get<double>()
                  << " mm (median), "
                  << 1000.0 * garment.at("room_change_m").at("p95").get<double>() << " mm (p95)\n";
    std::cout << report.at("seconds").at("all").get<double>() << " s\n";
}

/// The folder's name, as an id may be written.
std::string package_id(const fs::path& folder) {
    std::string out;
    for (const char c : (folder.has_filename() ? folder : folder.parent_path()).filename().string())
        out += std::isalnum(static_cast<unsigned char>(c)) != 0
                   ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                   : '-';
    if (out.empty() || std::isalpha(static_cast<unsigned char>(out.front())) == 0)
        out = "garment-" + out;
    return out.substr(0, 60);
}

void dress(const DressCommand& command, const GlobalOptions& global) {
    const std::string kind = command.out.extension().string();
    if (kind != ".glb" && kind != ".ply" && kind != ".obj")
        throw UsageError("dress --out '" + command.out.string() +
                         "': name a .glb, .ply or .obj file");
    const assets::ColoredMesh mannequin = load(command.mannequin, "--mannequin");
    const assets::ColoredMesh customer = load(command.customer, "--customer");
    host::catch_interrupts();
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    host::Job job({}, &host::interrupt_flag());
    pipeline::MannequinDressingRequest request;
    request.whole_body = command.fit == "body";
    request.strips = command.strips;
    const toile_limits limits = limits_of(global, services, kScannedPerson);
    pipeline::MannequinDressing dressed = pipeline::dress_from_mannequin(
        registry, services, limits, mannequin, customer, request, job);
    if (!command.garment.empty())
        garment::write_package(pipeline::take_off_garment(registry, services, limits, dressed,
                                                          package_id(command.garment), job),
                               command.garment);
    assets::save_scene(assets::scene_of(dressed.look, "dressed"), command.out);
    if (!command.report.empty()) save_report(dressed.report, command.report);
    if (!command.picture.empty()) save_dressed_picture(dressed, command.picture);
    print(dressed.report);
    std::cout << "wrote " << command.out.string() << "\n";
}

} // namespace

void add_dress_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command =
        app.add_subcommand("dress", "Puts what a scanned mannequin wears on a scanned customer");
    const auto options = std::make_shared<DressCommand>();
    command->add_option("--mannequin", options->mannequin, "Scan of a dressed mannequin, coloured")
        ->type_name("SCAN")
        ->required();
    command->add_option("--customer", options->customer, "Scan of a person")
        ->type_name("SCAN")
        ->required();
    command
        ->add_option("--fit", options->fit,
                     "abdomen: the mannequin with the customer's abdomen and head; body: the whole "
                     "customer")
        ->check(CLI::IsMember({"abdomen", "body"}))
        ->capture_default_str();
    command->add_option("--strips", options->strips, "Of the abdomen (40)")
        ->check(CLI::Range(1u, 1000u));
    command->add_option("--out", options->out, "Gets the dressed customer: .glb, .ply or .obj")
        ->type_name("FILE")
        ->required();
    command->add_option("--report", options->report, "Gets what was found and how long it took")
        ->type_name("FILE");
    command
        ->add_option("--garment-out", options->garment,
                     "Gets the garment by itself, as a package for tryon and mirror")
        ->type_name("DIR");
    command
        ->add_option("--picture", options->picture,
                     "Draws mannequin, customer and result side by side")
        ->type_name("FILE");
    command->footer(
        "Example: toile dress --mannequin shop-dress.ply --customer anna.ply --fit body "
        "--out anna-in-dress.glb --picture anna-in-dress.png");
    command->callback([options, &global] { dress(*options, global); });
}

} // namespace toile::apps
