// Takes a mesh of unknown size from a plugin and checks it.
#pragma once

#include "abi/base.h"
#include "core/types.h"

#include <optional>
#include <string>
#include <vector>

namespace toile::host {

/// Normals, colours and corner coordinates are empty when the plugin left them untouched.
struct SunkMesh {
    std::vector<std::array<float, 3>> positions;     ///< (nv)
    std::vector<std::array<float, 3>> normals;       ///< (nv) or empty
    std::vector<std::array<std::uint8_t, 4>> colors; ///< (nv) sRGB or empty
    std::vector<Triangle> triangles;                 ///< (nf), indices < nv
    std::vector<std::array<float, 2>> corner_coords; ///< (3 nf) or empty
};

/// One mesh; lives until the call that it is handed to returns.
class MeshSink {
  public:
    MeshSink(std::uint32_t max_vertices, std::uint32_t max_triangles);
    MeshSink(const MeshSink&) = delete;
    MeshSink& operator=(const MeshSink&) = delete;

    [[nodiscard]] toile_mesh_sink* handle() noexcept { return &sink_; }
    /// As begun and not yet taken; 0 before.
    [[nodiscard]] std::size_t vertex_count() const noexcept { return mesh_.positions.size(); }
    /// What was committed and is whole: finite, indices in range. \throw Error saying what is not
    [[nodiscard]] SunkMesh take();

  private:
    toile_status begin(std::uint32_t nv, std::uint32_t nf, toile_mesh_buffers* out);
    toile_status commit();

    toile_mesh_sink sink_{};
    std::uint32_t max_vertices_;
    std::uint32_t max_triangles_;
    bool begun_ = false;
    bool committed_ = false;
    std::string wrong_;
    SunkMesh mesh_;
};

} // namespace toile::host
