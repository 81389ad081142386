// What a block is besides its pattern: fabric, colours, drawn parts, pins.
#pragma once

#include "garment/block_drafts.h"
#include "garment/block_drape.h"
#include "garment/block_fabric.h"
#include "garment/block_render.h"
#include "garment/manifest.h"

namespace toile::garment::block {

/// One material of the drawn garment.
struct DesignPart {
    std::string name; ///< "body"
    Weave weave = Weave::invalid;
    std::vector<std::string> panel_prefixes; ///< panels whose names start so; "" takes the rest
    double turn_in_m = 0.012;                ///< see RenderPart
};

struct Colourway {
    std::string name;
    Vec3f srgb = Vec3f::Zero();
};

struct Design {
    std::string id, name, kind;
    double edge_m = 0.0155; ///< of the simulation mesh
    /// Its pattern for a body, that much wider than the body (none: as wide as is usual).
    std::function<Pattern(const BodyProbe&, std::optional<double> girth_ease_m)> draft;
    std::optional<double> girth_ease_m; ///< metres beyond chest or hip
    Fabric fabric;
    double ease_m = 0.006;
    EaseIntent ease_class; ///< empty: not said
    std::uint32_t layer = 0;
    DrapeOptions drape;
    std::vector<DesignPart> parts;
    std::vector<Colourway> colours;
    std::string held_prefix;           ///< panels held to the body, "" for none
    std::vector<float> held_strengths; ///< of those panels, then of rings of vertices below them
    std::vector<std::string> chart;    ///< measurements of the size chart; the first must grow
    std::vector<body::Part> body_mask;
};

/// \throw Error listing the designs
[[nodiscard]] const Design& find_design(const std::string& id);

} // namespace toile::garment::block
