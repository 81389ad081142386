// Takes what a scanner made and checks it.
#pragma once

#include "abi/scanner.h"
#include "host/mesh_sink.h"

namespace toile::host {

struct SunkScan {
    SunkMesh mesh;
    std::uint32_t texture_width = 0, texture_height = 0;
    std::vector<std::uint8_t> texture;                ///< (width * height * 4) sRGB, or empty
    std::vector<std::array<std::uint16_t, 4>> joints; ///< (nv), or empty: no skin
    std::vector<std::array<float, 4>> weights;        ///< (nv), rows sum to 1
    std::string report;                               ///< JSON, or empty
};

/// One scan; lives until the call that it is handed to returns.
class ScanSink {
  public:
    ScanSink(std::uint32_t max_vertices, std::uint32_t max_triangles);
    ScanSink(const ScanSink&) = delete;
    ScanSink& operator=(const ScanSink&) = delete;

    [[nodiscard]] toile_scan_sink* handle() noexcept { return &sink_; }
    /// What was committed and is whole. \throw Error saying what is not
    [[nodiscard]] SunkScan take();

  private:
    toile_status texture(std::uint32_t width, std::uint32_t height, toile_view_mut* out);
    toile_status skin(toile_view_mut* joints, toile_view_mut* weights);
    toile_status report(const char* json);

    toile_scan_sink sink_{};
    MeshSink mesh_;
    SunkScan scan_;
};

} // namespace toile::host
