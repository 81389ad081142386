#include "pipeline/resizing.h"

#include "core/error.h"
#include "host/views.h"

namespace toile::pipeline {

toile_mesh mesh_view(const geometry::TriangleMesh& mesh, std::uint64_t topology) {
    auto out = host::sized<toile_mesh>();
    out.positions = host::view_of(mesh.positions);
    out.triangles = host::view_of(mesh.triangles);
    out.topology_id = topology;
    return out;
}

Resizing::Resizing(host::Registry& registry, host::Services& services, const toile_limits& limits)
    : instance_(registry.find(TOILE_RESIZER), services) {
    instance_.activate(limits);
}

std::vector<Vec3f> Resizing::to_target(const geometry::TriangleMesh& subject,
                                       const geometry::TriangleMesh& target, std::uint32_t strips,
                                       host::Job& job) {
    const toile_mesh from = mesh_view(subject, 1), to = mesh_view(target, 2);
    auto request = host::sized<toile_resize_request>();
    request.subject = &from;
    request.target = &to;
    request.strips = strips;
    return run(request, subject.positions.size(), job);
}

std::vector<Vec3f> Resizing::with_body(const geometry::TriangleMesh& subject,
                                       const geometry::TriangleMesh& before,
                                       const geometry::TriangleMesh& after, host::Job& job) {
    const toile_mesh mesh = mesh_view(subject, 1), from = mesh_view(before, 2),
                     to = mesh_view(after, 2);
    auto request = host::sized<toile_resize_request>();
    request.subject = &mesh;
    request.body_before = &from;
    request.body_after = &to;
    return run(request, subject.positions.size(), job);
}

std::vector<Vec3f> Resizing::run(const toile_resize_request& request, std::size_t count,
                                 host::Job& job) {
    std::vector<Vec3f> out(count, Vec3f::Zero());
    instance_.call("resize", [&](toile_instance* i) {
        return instance_.table<toile_resizer>().resize(i, &request, host::view_mut(out),
                                                       job.handle());
    });
    for (const Vec3f& p : out)
        if (!p.allFinite()) throw Error(instance_.id() + ": gives positions not finite");
    return out;
}

} // namespace toile::pipeline
