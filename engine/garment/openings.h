// What a retailer's mesh is made of: its pieces, where they lie, their openings, what holds them.
#pragma once

#include "body/body_model.h"
#include "garment/manifest.h"
#include "geometry/mesh.h"

#include <string>
#include <vector>

namespace toile::garment {

/// A border of the cloth, once around.
struct Opening {
    std::vector<std::uint32_t> vertices; ///< in order
    double length_m = 0.0;
    body::Part around = body::Part::invalid; ///< most of its vertices lie beside
};

/// What hangs together.
struct Piece {
    std::vector<std::uint32_t> vertices; ///< rising
    std::vector<body::Part> parts;       ///< that at least a twentieth of it lies beside, rising
    double gap_m = 0.0;                  ///< mean distance from the skin
    double stiff = 0.0; ///< share beside the head above the neck, or beside feet: hats and shoes
    bool on_shoulders = false;
    std::vector<Opening> openings; ///< longest first
};

/// By edges; the largest first. `body` at rest, with the garment on it. \throw Error for a body
/// without part labels
[[nodiscard]] std::vector<Piece> find_pieces(const geometry::TriangleMesh& garment,
                                             const body::BodyModel& body);

/// Proposed pins: hats and shoes as a whole; the upper border of what does not reach the
/// shoulders, with the rings below it less and less.
[[nodiscard]] std::vector<PinGroup> propose_pins(const geometry::TriangleMesh& garment,
                                                 const std::vector<Piece>& pieces);

/// Pieces, openings and what lies over what, a line each, in plain words.
[[nodiscard]] std::vector<std::string> tell_pieces(const std::vector<Piece>& pieces);

} // namespace toile::garment
