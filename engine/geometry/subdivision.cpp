#include "geometry/subdivision.h"

#include <map>

namespace toile::geometry {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge(std::uint32_t a, std::uint32_t b) {
    return a < b ? Edge{a, b} : Edge{b, a};
}

} // namespace

Subdivision catmull_clark(std::size_t vertex_count,
                          std::span<const std::array<std::uint32_t, 4>> quads) {
    struct EdgeFaces {
        std::uint32_t vertex = 0;
        std::vector<std::uint32_t> faces;
    };
    std::map<Edge, EdgeFaces> edges;
    std::vector<std::vector<std::uint32_t>> vertex_faces(vertex_count);
    std::vector<std::vector<Edge>> vertex_edges(vertex_count);
    for (std::uint32_t f = 0; f < quads.size(); ++f)
        for (std::size_t k = 0; k < 4; ++k) {
            vertex_faces[quads[f][k]].push_back(f);
            edges[edge(quads[f][k], quads[f][(k + 1) % 4])].faces.push_back(f);
        }
    auto next = static_cast<std::uint32_t>(vertex_count);
    std::vector<bool> border(vertex_count);
    for (auto& [e, data] : edges) {
        data.vertex = next++;
        vertex_edges[e.first].push_back(e);
        vertex_edges[e.second].push_back(e);
        if (data.faces.size() < 2) border[e.first] = border[e.second] = true;
    }

    std::vector<Eigen::Triplet<float>> entries;
    const auto add = [&](std::uint32_t row, std::uint32_t column, float weight) {
        entries.emplace_back(static_cast<int>(row), static_cast<int>(column), weight);
    };
    const auto add_face = [&](std::uint32_t row, std::uint32_t f, float weight) {
        for (const auto v : quads[f])
            add(row, v, 0.25f * weight);
    };
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto n = static_cast<float>(vertex_edges[v].size());
        if (border[v] || vertex_edges[v].empty()) {
            add(v, v, 1.0f);
            continue;
        }
        add(v, v, (n - 3.0f) / n); // (Q + 2 R + (n - 3) P) / n
        for (const auto f : vertex_faces[v])
            add_face(v, f, 1.0f / (n * n));
        for (const auto& e : vertex_edges[v]) {
            add(v, e.first, 1.0f / (n * n));
            add(v, e.second, 1.0f / (n * n));
        }
    }
    for (const auto& [e, data] : edges) {
        const bool inner = data.faces.size() == 2;
        add(data.vertex, e.first, inner ? 0.25f : 0.5f);
        add(data.vertex, e.second, inner ? 0.25f : 0.5f);
        if (inner)
            for (const auto f : data.faces)
                add_face(data.vertex, f, 0.25f);
    }
    Subdivision out;
    for (std::uint32_t f = 0; f < quads.size(); ++f) {
        const std::uint32_t centre = next++;
        add_face(centre, f, 1.0f);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto v = quads[f][k];
            const auto after = edges.at(edge(v, quads[f][(k + 1) % 4])).vertex;
            const auto before = edges.at(edge(v, quads[f][(k + 3) % 4])).vertex;
            out.triangles.push_back({v, after, centre});
            out.triangles.push_back({v, centre, before});
        }
    }
    out.weights.resize(static_cast<int>(next), static_cast<int>(vertex_count));
    out.weights.setFromTriplets(entries.begin(), entries.end());
    return out;
}

std::vector<Vec3f> refine(const Subdivision& subdivision, std::span<const Vec3f> positions) {
    std::vector<Vec3f> out(static_cast<std::size_t>(subdivision.weights.rows()), Vec3f::Zero());
    for (int row = 0; row < subdivision.weights.outerSize(); ++row)
        for (Eigen::SparseMatrix<float, Eigen::RowMajor>::InnerIterator it(subdivision.weights,
                                                                           row);
             it; ++it)
            out[static_cast<std::size_t>(row)] +=
                it.value() * positions[static_cast<std::size_t>(it.col())];
    return out;
}

} // namespace toile::geometry
