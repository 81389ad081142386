// Longest distances over several edges: what keeps few solver passes from looking like rubber.
#pragma once

#include "core/types.h"

#include <span>
#include <vector>

namespace toile::cloth {

/// A straight way over the material: a mesh edge, or across one between the opposite corners.
struct MaterialPath {
    std::uint32_t a, b;
    float length; ///< m
};

/// Two vertices that the cloth between them never lets further apart.
struct LengthLimit {
    std::uint32_t a, b;
    float longest; ///< m, along the material
};

/// From every vertex up to four limits of about `reach` metres in directions far from each other;
/// sorted by vertices, each pair once.
[[nodiscard]] std::vector<LengthLimit>
make_length_limits(std::size_t vertex_count, std::span<const MaterialPath> paths, float reach);

} // namespace toile::cloth
