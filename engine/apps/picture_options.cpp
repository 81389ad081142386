#include "apps/picture_options.h"

#include "apps/contact_sheet.h"

#include <tuple>

namespace toile::apps {

void PictureOptions::add_to(CLI::App& command) {
    command.add_option("--picture", size, "Size of each picture in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    command.add_option("--quality", quality, "high: smoother edges and shadows; fast: quicker")
        ->check(CLI::IsMember({"high", "fast"}))
        ->capture_default_str();
    command.add_option("--colourway", colourway, "Colourway of the garments that have it")
        ->type_name("NAME");
}

render::RendererOptions PictureOptions::renderer() const {
    render::RendererOptions out;
    std::tie(out.width, out.height) = size_from_text(size);
    out.quality = quality == "high" ? render::Quality::high : render::Quality::fast;
    return out;
}

} // namespace toile::apps
