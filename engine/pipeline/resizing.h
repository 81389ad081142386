// Calls of a resizer plugin.
#pragma once

#include "abi/resizer.h"
#include "geometry/mesh.h"
#include "host/instance.h"
#include "host/registry.h"

namespace toile::pipeline {

/// Borrowed; `topology`: equal for equal triangles.
[[nodiscard]] toile_mesh mesh_view(const geometry::TriangleMesh& mesh, std::uint64_t topology);

/// The resizer that serves by default.
class Resizing {
  public:
    /// \throw Error when there is none [main]
    Resizing(host::Registry& registry, host::Services& services, const toile_limits& limits);

    /// The subject's vertices when its region gets the target's proportions. `strips` 0: the
    /// plugin's default. \throw Error with the plugin's reason [worker]
    [[nodiscard]] std::vector<Vec3f> to_target(const geometry::TriangleMesh& subject,
                                               const geometry::TriangleMesh& target,
                                               std::uint32_t strips, host::Job& job);
    /// The subject's vertices when the body beneath it changes. [worker]
    [[nodiscard]] std::vector<Vec3f> with_body(const geometry::TriangleMesh& subject,
                                               const geometry::TriangleMesh& before,
                                               const geometry::TriangleMesh& after, host::Job& job);

  private:
    std::vector<Vec3f> run(const toile_resize_request& request, std::size_t count, host::Job& job);

    host::Instance instance_;
};

} // namespace toile::pipeline
