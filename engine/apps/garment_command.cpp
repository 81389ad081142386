// toile garment list | check | new | draft | alter | thumbnail | pack
#include "apps/commands.h"
#include "apps/garment_alter_command.h"
#include "apps/garment_block_command.h"
#include "apps/garment_draft_command.h"
#include "apps/garment_thumbnail_command.h"
#include "body/body_model.h"
#include "core/error.h"
#include "garment/import.h"
#include "garment/package.h"
#include "garment/size_chart.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

geometry::TriangleMesh body_of(const std::string& avatar) {
    return body::load_body_model(body::find_avatar(avatar)).rest;
}

garment::PackageLimits limits() {
    garment::PackageLimits out;
    out.body_of = body_of;
    return out;
}

std::string size_names(const garment::Manifest& manifest) {
    std::string names;
    for (const auto& size : manifest.sizes)
        names += (names.empty() ? "" : " ") + size.name;
    return names;
}

void list(bool as_json) {
    Json all = Json::array();
    bool failed = false;
    for (const std::string& id : garment::list_garments()) {
        const fs::path source = garment::find_garment(id);
        try {
            const auto package = garment::load_package(source, limits());
            const garment::Manifest& m = package->manifest;
            if (as_json) {
                Json sizes = Json::array();
                for (const auto& size : m.sizes)
                    sizes.push_back(size.name);
                all.push_back({{"id", m.id},
                               {"version", m.version},
                               {"name", m.name},
                               {"kind", m.kind},
                               {"layer", m.layer},
                               {"sizes", sizes},
                               {"maker", m.maker},
                               {"licence", m.licence},
                               {"made_on", m.made_on},
                               {"thumbnail", m.thumbnail},
                               {"vertices", package->sizes.front().simulation.positions.size()},
                               {"source", source.string()}});
            } else {
                std::printf("%-20s %-10s %-12s %-16s %s\n", m.id.c_str(), m.version.c_str(),
                            m.kind.c_str(), size_names(m).c_str(), m.name.c_str());
            }
        } catch (const Error& e) {
            failed = true;
            if (as_json)
                all.push_back({{"id", id}, {"source", source.string()}, {"fault", e.what()}});
            else
                std::printf("%-20s unusable: %s\n", id.c_str(), e.what());
        }
    }
    if (as_json) std::printf("%s\n", all.dump(2).c_str());
    if (failed) throw Error("a garment is unusable: `toile garment check ID` says why");
}

void check(const std::string& what, bool as_json) {
    std::vector<std::string> notes;
    garment::Faults faults;
    try {
        faults = garment::check_package(garment::find_garment(what), limits(), &notes);
    } catch (const garment::PackageError& e) {
        faults.push_back({e.code(), e.what()});
    }
    if (as_json) {
        Json report = {{"package", what}, {"faults", Json::array()}, {"notes", notes}};
        for (const auto& fault : faults)
            report["faults"].push_back(
                {{"code", garment::fault_name(fault.code)}, {"text", fault.text}});
        std::printf("%s\n", report.dump(2).c_str());
    } else {
        for (const auto& fault : faults)
            std::printf("%s: %s\n", std::string(garment::fault_name(fault.code)).c_str(),
                        fault.text.c_str());
        for (const std::string& note : notes)
            std::printf("note: %s\n", note.c_str());
        if (faults.empty()) std::printf("%s: sound\n", what.c_str());
    }
    if (!faults.empty())
        throw Error(what + ": " + std::to_string(faults.size()) +
                    (faults.size() == 1 ? " fault" : " faults") +
                    ", the first: " + faults.front().text);
}

/// What `new` was asked for.
struct NewOptions {
    fs::path mesh, chart;
    fs::path out;
    std::string unit;
    garment::ImportOptions import;
    BlockOptions block;
};

/// The row of the mesh's size; the others have no mesh.
void take_chart(const fs::path& file, garment::ImportOptions& import) {
    std::string others;
    bool found = false;
    for (const auto& [name, row] : garment::read_size_chart(file)) {
        if (name == import.size_name) {
            import.chart = row;
            found = true;
        } else {
            others += (others.empty() ? "" : ", ") + name;
        }
    }
    if (!found)
        throw UsageError("garment new --size " + import.size_name + ": " + file.string() +
                         " has only " + others);
    if (!others.empty())
        std::printf("the mesh is size %s; of the chart's %s there is none\n",
                    import.size_name.c_str(), others.c_str());
}

void make_new(NewOptions& options) {
    if (!options.block.block.empty()) {
        options.block.out = options.out;
        options.block.id = options.import.id;
        make_block_package(options.block, limits());
        return;
    }
    if (options.mesh.empty() || options.import.id.empty())
        throw UsageError("garment new: --mesh and --id are required, or --block");
    if (!options.unit.empty()) {
        options.import.unit = garment::unit_from_text(options.unit);
        if (!options.import.unit)
            throw UsageError("--unit is one of m, dm, cm, mm, in; not '" + options.unit + "'");
    }
    std::error_code code;
    if (fs::exists(options.out / "garment.json", code))
        throw Error(options.out.string() + ": holds a garment.json already; choose another --out");
    if (!options.chart.empty()) take_chart(options.chart, options.import);
    std::optional<body::BodyModel> body;
    if (!options.import.made_on.empty())
        body = body::load_body_model(body::find_avatar(options.import.made_on));
    const auto import =
        garment::import_garment(options.mesh, options.import, body ? &*body : nullptr);
    garment::write_package(import.package, options.out);
    for (const std::string& finding : import.findings)
        std::printf("%s\n", finding.c_str());
    const auto faults = garment::check_package(options.out, limits());
    for (const auto& fault : faults)
        std::printf("still to mend: %s\n", fault.text.c_str());
    std::printf("written: %s\n", (options.out / "garment.json").string().c_str());
}

void add_list(CLI::App& garment) {
    auto* const command = garment.add_subcommand("list", "List the garments that there are");
    const auto json = std::make_shared<bool>(false);
    command->add_flag("--json", *json, "As JSON on standard output");
    command->footer("Example: toile garment list --json");
    command->callback([json] { list(*json); });
}

void add_check(CLI::App& garment) {
    auto* const command =
        garment.add_subcommand("check", "Say everything that is wrong with a garment package");
    const auto what = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    command->add_option("package", *what, "A folder, a .zip, or a garment's id")->required();
    command->add_flag("--json", *json, "As JSON on standard output");
    command->footer("Example: toile garment check garments/t-shirt");
    command->callback([what, json] { check(*what, *json); });
}

void add_new(CLI::App& garment) {
    auto* const command = garment.add_subcommand(
        "new", "Start a garment package from a mesh, or make one of our basic blocks");
    const auto options = std::make_shared<NewOptions>();
    auto* const mesh = command->add_option("--mesh", options->mesh, "A .glb, .fbx or .obj");
    command->add_option("--block", options->block.block, "A basic block instead: t-shirt, skirt")
        ->excludes(mesh);
    command
        ->add_option("--sizes", options->block.sizes,
                     "Sizes of the block, smallest first, each with the avatar it is cut for")
        ->capture_default_str();
    command
        ->add_option("--girth-ease", options->block.girth_ease_m,
                     "How much wider than the body the block is: metres around the chest of a "
                     "t-shirt, around the hip of a skirt")
        ->check(CLI::Range(-0.1, 0.5));
    command->add_option("--id", options->import.id, "Id of the new garment: t-shirt");
    command->add_option("--out", options->out, "Folder to write")->required()->type_name("DIR");
    command->add_option("--made-on", options->import.made_on,
                        "Avatar that the mesh was made on, or to lay it on");
    command->add_option("--unit", options->unit, "Unit of the mesh: m, dm, cm, mm, in")
        ->default_str("judged by its size");
    command->add_option("--kind", options->import.kind, "t-shirt, skirt, dress, trousers, ...")
        ->capture_default_str();
    command->add_option("--size", options->import.size_name, "Name of the one size that it has")
        ->capture_default_str();
    command
        ->add_option("--chart", options->chart,
                     "Size chart, whose row --size is taken: a table with the columns size, bust, "
                     "waist, hip ..., of numbers (92) or ranges (88-96), cm or m")
        ->check(CLI::ExistingFile)
        ->excludes("--block")
        ->type_name("FILE.csv");
    command->add_option("--layer", options->import.layer, "0: next to the skin")
        ->check(CLI::Range(0, 15))
        ->capture_default_str();
    command->add_option("--name", options->import.name, "For people");
    command->add_option("--maker", options->import.maker, "Who made it")->capture_default_str();
    command->add_option("--licence", options->import.licence, "Its licence")->capture_default_str();
    command->footer("Example: toile garment new --mesh suit.fbx --id suit --made-on man --out "
                    "garments/suit\n"
                    "         toile garment new --mesh suit.fbx --id suit --kind suit --size L "
                    "--chart sizes.csv --made-on man --out garments/suit\n"
                    "         toile garment new --block t-shirt --out garments/t-shirt");
    command->callback([options] { make_new(*options); });
}

void add_pack(CLI::App& garment) {
    auto* const command = garment.add_subcommand("pack", "Pack a garment package into a .zip");
    const auto folder = std::make_shared<fs::path>();
    const auto out = std::make_shared<fs::path>();
    command->add_option("package", *folder, "Its folder")->required()->type_name("DIR");
    command->add_option("--out", *out, "The .zip to write")->required()->type_name("FILE.zip");
    command->footer("Example: toile garment pack garments/t-shirt --out t-shirt.zip");
    command->callback([folder, out] { garment::pack_package(*folder, *out); });
}

} // namespace

void add_garment_commands(CLI::App& app, const GlobalOptions& options) {
    auto* const garment = app.add_subcommand("garment", "Garment packages: list, check, make");
    garment->require_subcommand(1);
    add_list(*garment);
    add_check(*garment);
    add_new(*garment);
    add_garment_draft(*garment, limits);
    add_garment_alter(*garment, options, limits);
    add_garment_thumbnail(*garment, options);
    add_pack(*garment);
}

} // namespace toile::apps
