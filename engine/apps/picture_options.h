// Options of every command that draws a dressed person.
#pragma once

#include "render/renderer.h"

#include <CLI/CLI.hpp>
#include <string>

namespace toile::apps {

struct PictureOptions {
    std::string size = "720x960";
    std::string quality = "high";
    std::string colourway;

    void add_to(CLI::App& command);
    /// \throw UsageError
    [[nodiscard]] render::RendererOptions renderer() const;
};

} // namespace toile::apps
