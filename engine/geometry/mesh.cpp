#include "geometry/mesh.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace toile::geometry {

void vertex_normals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                    std::span<Vec3f> normals) noexcept {
    std::fill(normals.begin(), normals.end(), Vec3f::Zero());
    for (const Triangle& t : triangles) {
        const Vec3f& a = positions[t[0]];
        const Vec3f n = (positions[t[1]] - a).cross(positions[t[2]] - a);
        for (const std::uint32_t v : t)
            normals[v] += n;
    }
    for (Vec3f& n : normals) {
        const float length = n.norm();
        n = length > 0.0f ? Vec3f(n / length) : Vec3f(Vec3f::Zero());
    }
}

double surface_area(const TriangleMesh& mesh) {
    double doubled = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0]].cast<double>();
        const Vec3d b = mesh.positions[t[1]].cast<double>();
        const Vec3d c = mesh.positions[t[2]].cast<double>();
        doubled += (b - a).cross(c - a).norm();
    }
    return 0.5 * doubled;
}

double volume(const TriangleMesh& mesh) {
    double sextupled = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0]].cast<double>();
        const Vec3d b = mesh.positions[t[1]].cast<double>();
        const Vec3d c = mesh.positions[t[2]].cast<double>();
        sextupled += a.dot(b.cross(c));
    }
    return sextupled / 6.0;
}

VertexAdjacency vertex_adjacency(std::size_t vertex_count, std::span<const Triangle> triangles) {
    // Both directions of every side, sorted and without repeats.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    pairs.reserve(6 * triangles.size());
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            pairs.emplace_back(t[k], t[(k + 1) % 3]);
            pairs.emplace_back(t[(k + 1) % 3], t[k]);
        }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

    VertexAdjacency adjacency;
    adjacency.first.assign(vertex_count + 1, 0);
    adjacency.neighbours.reserve(pairs.size());
    for (const auto& [from, to] : pairs) {
        ++adjacency.first[from + 1];
        adjacency.neighbours.push_back(to);
    }
    std::partial_sum(adjacency.first.begin(), adjacency.first.end(), adjacency.first.begin());
    return adjacency;
}

VertexAdjacency vertex_triangles(std::size_t vertex_count, std::span<const Triangle> triangles) {
    VertexAdjacency adjacency;
    adjacency.first.assign(vertex_count + 1, 0);
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t)
            ++adjacency.first[v + 1];
    std::partial_sum(adjacency.first.begin(), adjacency.first.end(), adjacency.first.begin());
    adjacency.neighbours.resize(3 * triangles.size());
    std::vector<std::uint32_t> next(adjacency.first.begin(), adjacency.first.end() - 1);
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (const std::uint32_t v : triangles[i])
            adjacency.neighbours[next[v]++] = i;
    return adjacency;
}

TriangleMesh weld(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                  std::span<const Vec2f> texcoords, SeamedLayout& layout) {
    // Equal positions stand together after sorting by their bits; the lowest index leads.
    const auto bits = [&positions](std::uint32_t i) {
        const Vec3f p = positions[i] + Vec3f::Zero(); // -0 becomes 0
        return std::array<std::uint32_t, 3>{std::bit_cast<std::uint32_t>(p.x()),
                                            std::bit_cast<std::uint32_t>(p.y()),
                                            std::bit_cast<std::uint32_t>(p.z())};
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&bits](std::uint32_t a, std::uint32_t b) {
        const auto ka = bits(a);
        const auto kb = bits(b);
        return ka != kb ? ka < kb : a < b;
    });
    std::vector<std::uint32_t> leader(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && bits(order[i]) == bits(order[i - 1]);
        leader[order[i]] = same ? leader[order[i - 1]] : order[i];
    }

    // Welded vertices are numbered in the order of their leaders.
    TriangleMesh mesh;
    layout.welded.resize(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (leader[i] == i) {
            layout.welded[i] = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(positions[i]);
        } else {
            layout.welded[i] = layout.welded[leader[i]];
        }
    }
    mesh.triangles.reserve(triangles.size());
    for (const Triangle& t : triangles)
        mesh.triangles.push_back({layout.welded[t[0]], layout.welded[t[1]], layout.welded[t[2]]});
    layout.texcoords.assign(texcoords.begin(), texcoords.end());
    layout.triangles.assign(triangles.begin(), triangles.end());
    return mesh;
}

} // namespace toile::geometry
