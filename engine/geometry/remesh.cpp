#include "geometry/remesh.h"

#include "core/error.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>

namespace toile::geometry {
namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3f;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

constexpr float kLongest = 4.0f / 3.0f; // of the wanted length, as in the paper
constexpr float kShortest = 4.0f / 5.0f;
constexpr float kLeastNormalDot = 0.3f; // a flip or collapse may not fold the surface further
constexpr float kRelaxation = 0.6f;

Vec3f to_vec(const OpenMesh::Vec3f& p) {
    return {p[0], p[1], p[2]};
}
OpenMesh::Vec3f to_point(const Vec3f& p) {
    return {p.x(), p.y(), p.z()};
}

class Remesher {
  public:
    Remesher(const TriangleMesh& mesh, const RemeshOptions& options) : options_(options) {
        std::vector<Mesh::VertexHandle> handles;
        for (const auto& p : mesh.positions)
            handles.push_back(mesh_.add_vertex(to_point(p)));
        for (const auto& t : mesh.triangles)
            if (!mesh_.add_face(handles[t[0]], handles[t[1]], handles[t[2]]).is_valid())
                throw Error("remeshing needs a manifold mesh");
    }

    TriangleMesh run() {
        for (int i = 0; i < options_.iterations; ++i) {
            split_long();
            collapse_short();
            flip_to_regular();
            relax();
        }
        split_chords();
        relax();
        return result();
    }

  private:
    [[nodiscard]] Vec3f at(Mesh::VertexHandle v) const { return to_vec(mesh_.point(v)); }
    [[nodiscard]] float wanted(const Vec3f& a, const Vec3f& b) const {
        return options_.edge_length(0.5f * (a + b));
    }

    void split(Mesh::EdgeHandle e) {
        const auto h = mesh_.halfedge_handle(e, 0);
        const bool border = mesh_.is_boundary(e);
        Vec3f middle = 0.5f * (at(mesh_.from_vertex_handle(h)) + at(mesh_.to_vertex_handle(h)));
        if (border && options_.border_on_x0) middle.x() = 0.0f;
        mesh_.split(e, mesh_.add_vertex(to_point(middle)));
    }

    void split_long() {
        for (std::size_t pass = 0, count = 1; pass < 4 && count > 0; ++pass) {
            count = 0;
            const auto edges = mesh_.n_edges();
            for (unsigned i = 0; i < edges; ++i) {
                const auto e = mesh_.edge_handle(i);
                const auto h = mesh_.halfedge_handle(e, 0);
                const Vec3f a = at(mesh_.from_vertex_handle(h)), b = at(mesh_.to_vertex_handle(h));
                if ((a - b).norm() <= kLongest * wanted(a, b)) continue;
                split(e);
                ++count;
            }
        }
    }

    /// Whether moving `from` onto `to` keeps every other triangle of `from` unfolded and short.
    [[nodiscard]] bool collapse_is_fair(Mesh::HalfedgeHandle h) const {
        const auto from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
        const Vec3f target = at(to);
        for (const auto v : mesh_.vv_range(from))
            if (v != to && (at(v) - target).norm() > kLongest * wanted(at(v), target)) return false;
        for (const auto f : mesh_.vf_range(from)) {
            std::array<Vec3f, 3> p, q;
            std::size_t k = 0;
            bool dies = false;
            for (const auto v : mesh_.fv_range(f)) {
                dies = dies || v == to;
                p[k] = at(v);
                q[k++] = v == from ? target : at(v);
            }
            if (dies) continue;
            const Vec3f before = (p[1] - p[0]).cross(p[2] - p[0]);
            const Vec3f after = (q[1] - q[0]).cross(q[2] - q[0]);
            // Slivers of the raw surface have no normal worth keeping.
            if (after.norm() < 1e-12f || before.dot(after) < 0.0f) return false;
            if (before.norm() > 1e-8f &&
                before.normalized().dot(after.normalized()) < kLeastNormalDot)
                return false;
        }
        return true;
    }

    bool try_collapse(Mesh::HalfedgeHandle h) {
        const auto from = mesh_.from_vertex_handle(h), to = mesh_.to_vertex_handle(h);
        if (mesh_.is_boundary(from) &&
            !(mesh_.is_boundary(to) && mesh_.is_boundary(mesh_.edge_handle(h))))
            return false;
        if (!mesh_.is_collapse_ok(h) || !collapse_is_fair(h)) return false;
        mesh_.collapse(h);
        return true;
    }

    void collapse_short() {
        for (std::size_t pass = 0, count = 1; pass < 6 && count > 0; ++pass) {
            count = 0;
            const auto edges = mesh_.n_edges();
            for (unsigned i = 0; i < edges; ++i) {
                const auto e = mesh_.edge_handle(i);
                if (mesh_.status(e).deleted()) continue;
                const auto h = mesh_.halfedge_handle(e, 0);
                const Vec3f a = at(mesh_.from_vertex_handle(h)), b = at(mesh_.to_vertex_handle(h));
                if ((a - b).norm() >= kShortest * wanted(a, b)) continue;
                if (try_collapse(h) || try_collapse(mesh_.opposite_halfedge_handle(h))) ++count;
            }
        }
        mesh_.garbage_collection();
    }

    [[nodiscard]] int valence_error(Mesh::VertexHandle v, int change) const {
        const int ideal = mesh_.is_boundary(v) ? 4 : 6;
        const int d = static_cast<int>(mesh_.valence(v)) + change - ideal;
        return d * d;
    }

    void flip_to_regular() {
        for (unsigned i = 0; i < mesh_.n_edges(); ++i) {
            const auto e = mesh_.edge_handle(i);
            if (mesh_.is_boundary(e)) continue;
            const auto h = mesh_.halfedge_handle(e, 0), o = mesh_.opposite_halfedge_handle(h);
            const auto a = mesh_.from_vertex_handle(h), b = mesh_.to_vertex_handle(h);
            const auto c = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
            const auto d = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(o));
            if (mesh_.is_boundary(c) && mesh_.is_boundary(d)) continue;
            const int before = valence_error(a, 0) + valence_error(b, 0) + valence_error(c, 0) +
                               valence_error(d, 0);
            const int after = valence_error(a, -1) + valence_error(b, -1) + valence_error(c, 1) +
                              valence_error(d, 1);
            if (after >= before || !mesh_.is_flip_ok(e)) continue;
            const Vec3f n0 = (at(b) - at(a)).cross(at(c) - at(a)).normalized();
            const Vec3f n1 = (at(a) - at(b)).cross(at(d) - at(b)).normalized();
            const Vec3f m0 = (at(d) - at(c)).cross(at(b) - at(c)).normalized();
            const Vec3f m1 = (at(c) - at(d)).cross(at(a) - at(d)).normalized();
            const Vec3f n = (n0 + n1).normalized();
            if (-m0.dot(n) < kLeastNormalDot && m0.dot(n) < kLeastNormalDot) continue;
            if (m0.dot(m1) < kLeastNormalDot || std::abs(m0.dot(n)) < kLeastNormalDot) continue;
            mesh_.flip(e);
        }
    }

    void relax() {
        std::vector<Vec3f> moved(mesh_.n_vertices());
        for (const auto v : mesh_.vertices()) {
            const Vec3f p = at(v);
            Vec3f sum = Vec3f::Zero(), normal = Vec3f::Zero();
            float count = 0.0f;
            const bool border = mesh_.is_boundary(v);
            for (const auto w : mesh_.vv_range(v)) {
                if (border && !mesh_.is_boundary(w)) continue;
                sum += at(w);
                count += 1.0f;
            }
            for (const auto f : mesh_.vf_range(v))
                normal += to_vec(mesh_.calc_normal(f));
            normal.normalize();
            const Vec3f d = sum / count - p;
            moved[static_cast<std::size_t>(v.idx())] =
                p + kRelaxation * (d - (border ? 0.0f : d.dot(normal)) * normal);
        }
        for (const auto v : mesh_.vertices()) {
            Vec3f p = options_.project(moved[static_cast<std::size_t>(v.idx())]);
            if (options_.border_on_x0) {
                if (mesh_.is_boundary(v))
                    p.x() = 0.0f;
                else
                    p.x() = std::max(p.x(), 0.05f * options_.edge_length(p));
            }
            mesh_.set_point(v, to_point(p));
        }
    }

    /// Splits inner edges between border vertices: mirrored, they would coincide.
    void split_chords() {
        const auto edges = mesh_.n_edges();
        for (unsigned i = 0; i < edges; ++i) {
            const auto e = mesh_.edge_handle(i);
            const auto h = mesh_.halfedge_handle(e, 0);
            if (!mesh_.is_boundary(e) && mesh_.is_boundary(mesh_.from_vertex_handle(h)) &&
                mesh_.is_boundary(mesh_.to_vertex_handle(h)))
                split(e);
        }
    }

    [[nodiscard]] TriangleMesh result() const {
        TriangleMesh out;
        for (const auto v : mesh_.vertices())
            out.positions.push_back(at(v));
        for (const auto f : mesh_.faces()) {
            Triangle t{};
            std::size_t k = 0;
            for (const auto v : mesh_.fv_range(f))
                t[k++] = static_cast<std::uint32_t>(v.idx());
            out.triangles.push_back(t);
        }
        return out;
    }

    const RemeshOptions& options_;
    Mesh mesh_;
};

} // namespace

TriangleMesh remesh(const TriangleMesh& mesh, const RemeshOptions& options) {
    return Remesher(mesh, options).run();
}

TriangleMesh mirror_and_weld(const TriangleMesh& half, std::vector<std::uint32_t>& mirror_of) {
    TriangleMesh out = half;
    const auto n = half.positions.size();
    mirror_of.resize(n);
    for (std::uint32_t v = 0; v < n; ++v) {
        const Vec3f& p = half.positions[v];
        if (p.x() == 0.0f) {
            mirror_of[v] = v;
            continue;
        }
        mirror_of[v] = static_cast<std::uint32_t>(out.positions.size());
        mirror_of.push_back(v);
        out.positions.emplace_back(-p.x(), p.y(), p.z());
    }
    for (const auto& t : half.triangles)
        out.triangles.push_back({mirror_of[t[0]], mirror_of[t[2]], mirror_of[t[1]]});
    return out;
}

} // namespace toile::geometry
