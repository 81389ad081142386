#include "apps/garment_alter_command.h"

#include "apps/fitting_room.h"
#include "body/body_file.h"
#include "core/error.h"
#include "core/log.h"
#include "garment/alter.h"

#include <cstdio>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct AlterCommand {
    std::string garment, body, size = "auto", id, name;
    fs::path out;
};

// The garment plugin carries the garment; what the clothes do later is not asked here.
void alter_garment(const AlterCommand& command, const GlobalOptions& global,
                   const garment::PackageLimits& limits) {
    std::error_code code;
    if (fs::exists(command.out / "garment.json", code))
        throw Error(command.out.string() + ": holds a garment.json already; choose another --out");
    FittingRoom room(global, {command.body, {command.garment}, command.size}, false);
    const pipeline::WornGarment& worn = room.person().garments().front();
    const garment::GarmentPackage& package = worn.garment().package();
    const body::BodyModel& body = room.body().model();
    garment::AlterOptions options;
    options.id = command.id.empty() ? package.manifest.id + "-altered" : command.id;
    options.name = command.name;
    options.measurements = body.measurements;
    if (!body::is_body_file(command.body)) options.made_on = body.id;
    const garment::Alteration altered =
        garment::alter(package, worn.garment().size(), worn.bound, options);
    garment::write_package(altered.package, command.out);
    for (const std::string& choice : room.choices())
        log::info(choice);
    std::printf("cloth against the old pattern: %+.1f %% along the weft, %+.1f %% along the warp "
                "(%+.1f to %+.1f %% anywhere)\n",
                100.0 * (altered.mean_weft - 1.0), 100.0 * (altered.mean_warp - 1.0),
                100.0 * (altered.least - 1.0), 100.0 * (altered.most - 1.0));
    for (const auto& fault : garment::check_package(command.out, limits))
        std::printf("still to mend: %s\n", fault.text.c_str());
    std::printf("written: %s\n", (command.out / "garment.json").string().c_str());
}

} // namespace

void add_garment_alter(CLI::App& garment, const GlobalOptions& global,
                       std::function<garment::PackageLimits()> limits) {
    CLI::App* command = garment.add_subcommand(
        "alter", "Make a garment anew for one person: the same design, with the same room");
    auto options = std::make_shared<AlterCommand>();
    command->add_option("garment", options->garment, "A garment's id, folder or .zip")->required();
    command->add_option("--body", options->body, "Whom it shall fit")
        ->type_name("AVATAR|body.json")
        ->required();
    command->add_option("--size", options->size, "Size to begin with; auto: by the size chart")
        ->capture_default_str();
    command->add_option("--id", options->id,
                        "Id of the new garment; else the old one's + -altered");
    command->add_option("--name", options->name, "For people");
    command->add_option("--out", options->out, "Folder to write")->required()->type_name("DIR");
    command->footer("Example: toile garment alter dress --body anna.json --out annas-dress");
    command->callback([options, &global, limits = std::move(limits)] {
        alter_garment(*options, global, limits());
    });
}

} // namespace toile::apps
