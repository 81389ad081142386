// Finds the unit, the axes and the place of a mesh that somebody else made, by laying it on a body.
#pragma once

#include "geometry/mesh.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace toile::garment {

enum class Unit : std::uint8_t { invalid, metres, decimetres, centimetres, millimetres, inches };

[[nodiscard]] double metres_per(Unit unit);
/// "centimetres"
[[nodiscard]] std::string_view unit_name(Unit unit);
/// From m, dm, cm, mm, in; nothing for other words.
[[nodiscard]] std::optional<Unit> unit_from_text(std::string_view text);

struct Placement {
    Unit unit = Unit::metres;
    bool z_up = false;
    bool faces_back = false;
    Vec3f shift = Vec3f::Zero(); ///< metres, after scaling and turning
    double mean_distance = 0.0;  ///< metres between garment and skin
    double inside = 0.0;         ///< share of vertices inside the body

    [[nodiscard]] Eigen::Affine3f transform() const;
};

/// Tries units (or the one given), both up axes and both facings, and slides the garment along the
/// body until it sits best. What already sits is left where it is.
[[nodiscard]] Placement place_on_body(std::span<const Vec3f> positions,
                                      const geometry::TriangleMesh& body, std::optional<Unit> unit);

/// Without a body: the unit that makes the mesh as large as a garment.
[[nodiscard]] Placement place_freely(std::span<const Vec3f> positions, std::optional<Unit> unit);

} // namespace toile::garment
