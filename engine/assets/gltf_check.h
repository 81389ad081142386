// What must hold of a glTF file before a parser may touch it.
#pragma once

#include "assets/budget.h"

#include <cstdint>
#include <span>

namespace toile::assets {

/// Refuses a .glb or .gltf whose container or JSON is broken, whose buffers claim more than the
/// limits, whose buffer views leave their buffers, or that requires an extension we do not have.
/// \throw FileError
void check_gltf(std::span<const std::uint8_t> bytes, bool binary, const Budget& budget);

} // namespace toile::assets
