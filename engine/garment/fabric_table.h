// Fabrics by name, with where their figures come from.
#pragma once

#include "garment/manifest.h"

namespace toile::garment {

struct NamedFabric {
    std::string_view key; ///< "jersey"
    Fabric fabric;
    std::string_view source;
};

/// jersey, rib, stretch, poplin, linen, silk, denim, twill, wool, fleece; docs/garments.md has them
/// as a table.
[[nodiscard]] std::span<const NamedFabric> fabric_table();
/// \throw Error listing the names
[[nodiscard]] const NamedFabric& find_fabric(std::string_view key);

} // namespace toile::garment
