// Tells cloth from skin on a coloured scan of a dressed body.
#pragma once

#include "geometry/mesh.h"

#include <array>
#include <span>

namespace toile::garment {

/// What is known of the scan beside its surface.
struct CoverInput {
    const geometry::TriangleMesh* scan = nullptr;        ///< metres, with normals
    std::span<const std::array<std::uint8_t, 4>> colors; ///< (nv) sRGB, or none
    const geometry::TriangleMesh* body = nullptr;        ///< the body in it, as it stands
    std::span<const std::uint8_t>
        body_bare; ///< (nb) 1: certainly skin (the face), gives its colour
};

struct ClothCover {
    std::vector<float> cloth;    ///< (nv) 1 cloth, 0 skin; 0.5 is the seam between, smooth
    std::vector<float> gaps;     ///< (nv) distance from the body, metres, negative within
    std::array<float, 3> skin{}; ///< its colour, linear light
    bool by_color = false;       ///< colours told; else distance alone did
};

/// By colour: what differs from the face's. By distance: what stands off the body, whatever its
/// colour. Small islands of either are given to what surrounds them.
[[nodiscard]] ClothCover find_cover(const CoverInput& input);

} // namespace toile::garment
