// A scanner's surface and report into the host's sinks.
#pragma once

#include "abi/scanner.h"
#include "geometry/mesh.h"
#include "sdk/failure.h"
#include "sdk/views.h"

#include <algorithm>
#include <string>

namespace toile::boundary {

/// \throw sdk::Failure when a sink refuses
inline void give(const geometry::TriangleMesh& mesh,
                 std::span<const std::array<std::uint8_t, 4>> colors, const std::string& report,
                 toile_scan_sink& sink) {
    const auto check = [](toile_status status) {
        if (status < 0) throw sdk::Failure(status, "the sink refused the surface");
    };
    toile_mesh_buffers out{};
    out.size = sizeof(out);
    check(sink.mesh->begin(sink.mesh, static_cast<std::uint32_t>(mesh.positions.size()),
                           static_cast<std::uint32_t>(mesh.triangles.size()), &out));
    const auto positions = sdk::span_of<sdk::Float3>(out.positions, "sink.positions");
    const auto normals = sdk::span_of<sdk::Float3>(out.normals, "sink.normals");
    for (std::size_t v = 0; v < positions.size(); ++v) {
        std::copy_n(mesh.positions[v].data(), 3, positions[v].data());
        std::copy_n(mesh.normals[v].data(), 3, normals[v].data());
    }
    const auto out_colors = sdk::span_of<sdk::Byte4>(out.colors, "sink.colors");
    std::copy(colors.begin(), colors.end(), out_colors.begin());
    const auto corners = sdk::span_of<sdk::Triangle>(out.triangles, "sink.triangles");
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), corners.begin());
    check(sink.mesh->commit(sink.mesh));
    if (sink.report != nullptr) check(sink.report(&sink, report.c_str()));
}

} // namespace toile::boundary
