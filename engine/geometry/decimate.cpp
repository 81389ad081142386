#include "geometry/decimate.h"

#include "core/error.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

namespace toile::geometry {
namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
    HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

Mesh build(const TriangleMesh& mesh) {
    Mesh out;
    for (const auto& p : mesh.positions)
        out.add_vertex(
            {static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z())});
    for (const auto& t : mesh.triangles)
        if (!out.add_face(out.vertex_handle(t[0]), out.vertex_handle(t[1]), out.vertex_handle(t[2]))
                 .is_valid())
            throw Error("a mesh to be decimated is not manifold");
    out.update_normals();
    return out;
}

} // namespace

Decimation decimate(const TriangleMesh& mesh, std::size_t vertex_count) {
    Mesh work = build(mesh);
    using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;
    Decimater decimater(work);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.module(quadric).unset_max_err();
    decimater.module(flipping).set_max_normal_deviation(90.0);
    if (!decimater.initialize()) throw Error("decimation cannot start");
    decimater.decimate_to(vertex_count);

    Decimation out;
    std::vector<std::uint32_t> place(mesh.positions.size());
    for (std::uint32_t v = 0; v < place.size(); ++v)
        if (!work.status(work.vertex_handle(v)).deleted()) {
            place[v] = static_cast<std::uint32_t>(out.vertices.size());
            out.vertices.push_back(v);
        }
    for (const auto face : work.faces()) { // skips deleted ones
        if (work.status(face).deleted()) continue;
        Triangle t{};
        std::size_t k = 0;
        for (const auto v : work.fv_range(face))
            t[k++] = place[static_cast<std::size_t>(v.idx())];
        out.triangles.push_back(t);
    }
    return out;
}

} // namespace toile::geometry
