#include "apps/garment_thumbnail_command.h"

#include "apps/contact_sheet.h"
#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/still_look.h"
#include "core/bytes.h"
#include "core/error.h"
#include "imaging/image.h"

#include <cstdio>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kSide = 288;       // pixels
constexpr float kAround = 0.04f; // metres left free around the garment
const char* const kFile = "thumbnail.jpg";

/// The middle size: drawn on whom it was made on.
const garment::SizeEntry& middle(const garment::Manifest& manifest) {
    return manifest.sizes[manifest.sizes.size() / 2];
}

render::Box around(const pipeline::WornGarment& garment) {
    render::Box box;
    render::bounds(garment.shown, box.low, box.high);
    box.low -= Vec3f::Constant(kAround);
    box.high += Vec3f::Constant(kAround);
    return box;
}

void make_thumbnail(const std::string& id, std::string body, const GlobalOptions& global) {
    const fs::path folder = garment::find_garment(id);
    if (!fs::is_directory(folder))
        throw Error(folder.string() +
                    ": is a .zip; make the thumbnail in its folder, then pack it");
    garment::Manifest manifest = garment::load_package(folder)->manifest;
    const garment::SizeEntry& size = middle(manifest);
    if (body.empty()) body = size.made_on.empty() ? manifest.made_on : size.made_on;
    if (body.empty())
        throw UsageError("garment thumbnail: " + id +
                         " does not say what it was made on; choose "
                         "a --body");
    FittingRoom room(global, {body, {folder.string()}, size.name}, false);
    leave_to_hang(room, "rest", {});
    const auto context = render::make_offscreen_context();
    render::RendererOptions options;
    options.width = options.height = kSide;
    Look look(*context, options, room.person());
    look.update();
    look.draw(render::view_from_name("front"), around(room.person().garments().front()));
    imaging::save_image(look.renderer().read(), folder / kFile);
    manifest.thumbnail = kFile;
    write_text(folder / "garment.json", garment::write_manifest(manifest));
    std::printf("written: %s\n", (folder / kFile).string().c_str());
}

} // namespace

void add_garment_thumbnail(CLI::App& garment, const GlobalOptions& global) {
    CLI::App* command = garment.add_subcommand(
        "thumbnail", "Draw a small picture of a garment and name it in its garment.json");
    const auto id = std::make_shared<std::string>();
    const auto body = std::make_shared<std::string>();
    command->add_option("garment", *id, "A garment's folder or id")->required();
    command->add_option("--body", *body, "Who wears it; else whom its middle size was made on")
        ->type_name("AVATAR|body.json");
    command->footer("Example: toile garment thumbnail garments/dress");
    command->callback([id, body, &global] { make_thumbnail(*id, *body, global); });
}

} // namespace toile::apps
