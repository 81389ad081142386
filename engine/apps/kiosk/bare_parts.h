// Hands and arms that no cloth covers.
#pragma once

#include "pipeline/dressed_person.h"

#include <cstdint>
#include <vector>

namespace toile::apps::kiosk {

/// Vertices of arms and hands that the garments leave bare, on the body at rest: those
/// whose normal meets no cloth within 10 cm and that are not within 2 cm of any.
[[nodiscard]] std::vector<std::uint32_t> bare_vertices(const pipeline::DressedPerson& person);

} // namespace toile::apps::kiosk
