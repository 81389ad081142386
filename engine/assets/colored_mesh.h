// A scan as one surface with a colour at each vertex, whatever its file keeps colours as.
#pragma once

#include "assets/scene.h"

#include <filesystem>

namespace toile::assets {

using Rgba8 = std::array<std::uint8_t, 4>;

/// Metres as the file says; not welded, not checked for holes.
struct ColoredMesh {
    geometry::TriangleMesh mesh; ///< normals only when all parts of the file have them
    std::vector<Rgba8> colors;   ///< (nv) sRGB; empty when the file says nothing of colour
};

/// All meshes where their nodes stand: vertex colours, textures and plain materials as colours of
/// vertices. A cloud has no triangles.
[[nodiscard]] ColoredMesh colored_mesh_of(const Scene& scene);

/// \throw FileError naming the file, also when it holds no points
[[nodiscard]] ColoredMesh load_colored_mesh(const std::filesystem::path& file);

/// One node, one mesh, drawn from both sides when it has colours.
[[nodiscard]] Scene scene_of(const ColoredMesh& mesh, const std::string& name);

/// At most so many triangles, with colours and normals; the same mesh when it has no more.
[[nodiscard]] ColoredMesh decimated(const ColoredMesh& mesh, std::size_t triangles);

/// Colour of a texture at a place, between its texels; repeats beyond [0, 1].
[[nodiscard]] Rgba8 texture_color(const imaging::Image& image, const Vec2f& at);

} // namespace toile::assets
