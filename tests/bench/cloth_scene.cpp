#include "bench/cloth_scene.h"

#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace toile::bench {
namespace {

float smoothstep(double t) {
    const double c = std::clamp(t, 0.0, 1.0);
    return static_cast<float>(c * c * (3.0 - 2.0 * c));
}

std::vector<std::array<std::uint32_t, 2>> edges_of(const SceneMesh& mesh) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            edges.push_back({a, b});
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

std::vector<Vec3f> normals_of(const SceneMesh& mesh, const std::vector<Vec3f>& positions) {
    std::vector<Vec3f> normals(positions.size());
    geometry::vertex_normals(positions, mesh.triangles, normals);
    return normals;
}

/// Does the side a-b pass through the triangle?
bool pierces(const Vec3f& a, const Vec3f& b, const std::array<Vec3f, 3>& t) {
    const Vec3f along = b - a;
    const Vec3f e1 = t[1] - t[0];
    const Vec3f e2 = t[2] - t[0];
    const Vec3f h = along.cross(e2);
    const float det = e1.dot(h);
    if (std::abs(det) < 1e-14f) {
        return false;
    }
    const Vec3f s = (a - t[0]) / det;
    const float u = s.dot(h);
    const Vec3f q = s.cross(e1);
    const float v = along.dot(q);
    const float at = e2.dot(q);
    return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && at >= 0.0f && at <= 1.0f;
}

} // namespace

SceneMesh read_scene_mesh(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) {
        throw std::runtime_error(file.string() + ": cannot be read");
    }
    SceneMesh mesh;
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            Vec3f p;
            words >> p.x() >> p.y() >> p.z();
            mesh.positions.push_back(p);
        } else if (word == "f") {
            std::vector<std::uint32_t> face;
            while (words >> word) {
                face.push_back(static_cast<std::uint32_t>(std::stoul(word)) - 1);
            }
            for (std::size_t k = 1; k + 1 < face.size(); ++k) {
                mesh.triangles.push_back({face[0], face[k], face[k + 1]});
            }
        }
    }
    return mesh;
}

void write_scene_mesh(const std::filesystem::path& file, const SceneMesh& mesh) {
    std::ofstream out(file);
    for (const Vec3f& p : mesh.positions) {
        out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
    for (const Triangle& t : mesh.triangles) {
        out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
}

SceneMesh subdivided(const SceneMesh& mesh) {
    SceneMesh fine{mesh.positions, {}};
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middle;
    for (const auto& edge : edges_of(mesh)) {
        middle[edge] = static_cast<std::uint32_t>(fine.positions.size());
        fine.positions.emplace_back(0.5f * (mesh.positions[edge[0]] + mesh.positions[edge[1]]));
    }
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
        return middle.at({std::min(a, b), std::max(a, b)});
    };
    for (const Triangle& t : mesh.triangles) {
        const Triangle m{between(t[0], t[1]), between(t[1], t[2]), between(t[2], t[0])};
        fine.triangles.insert(fine.triangles.end(),
                              {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, m});
    }
    return fine;
}

SceneMesh doubled(const SceneMesh& mesh, float apart) {
    SceneMesh both = mesh;
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const std::vector<Vec3f> normals = normals_of(mesh, mesh.positions);
    for (std::size_t v = 0; v < count; ++v) {
        both.positions.emplace_back(mesh.positions[v] + apart * normals[v]);
    }
    for (const Triangle& t : mesh.triangles) {
        both.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    }
    return both;
}

ClothScene::ClothScene(const std::filesystem::path& folder, const std::string& level)
    : body(read_scene_mesh(folder / "body.obj")),
      cloth(
          read_scene_mesh(folder / (level.starts_with("3k") ? "cloth_3k.obj" : "cloth_10k.obj"))) {
    if (level == "30k") {
        cloth = subdivided(cloth);
    } else if (level == "3k+3k") {
        cloth = doubled(cloth, 0.008f);
        layers = 2;
    }
    std::ifstream in(folder / "arm_weights_LR.txt");
    arm.resize(body.positions.size());
    for (auto& row : arm) {
        in >> row[0] >> row[1];
    }
    if (!in) {
        throw std::runtime_error("arm_weights_LR.txt: has fewer rows than the body has vertices");
    }
    const geometry::NearestSurface surface(body.positions, body.triangles);
    for (const Vec3f& p : cloth.positions) {
        const geometry::SurfacePoint at = surface.nearest(p);
        std::array<float, 2> row{};
        for (int k = 0; k < 3; ++k) {
            const auto& corner = arm[body.triangles[at.triangle][static_cast<std::size_t>(k)]];
            row[0] += at.barycentric[k] * corner[0];
            row[1] += at.barycentric[k] * corner[1];
        }
        cloth_arm.push_back(row);
    }
}

void ClothScene::pose(const std::vector<Vec3f>& rest, const std::vector<std::array<float, 2>>& arm,
                      double time_s, std::vector<Vec3f>& posed) {
    const Vec3f joint[2] = {{0.1677125f, 0.52458f, 0.014605f}, {-0.1677125f, 0.52458f, 0.014605f}};
    const float angle =
        0.25f * std::numbers::pi_v<float> * (smoothstep(time_s - 0.5) - smoothstep(time_s - 1.5));
    const Eigen::AngleAxisf turn[2] = {{angle, Vec3f::UnitZ()}, {-angle, Vec3f::UnitZ()}};
    posed = rest;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec3f moved = turn[side] * (rest[v] - joint[side]) + joint[side];
            posed[v] += arm[v][side] * (moved - rest[v]);
        }
    }
}

SceneMeasure::SceneMeasure(const ClothScene& scene)
    : scene_(scene), body_(scene.body.positions, scene.body.triangles),
      cloth_(scene.cloth.positions, scene.cloth.triangles), edges_(edges_of(scene.cloth)) {
    constexpr float kCovered = 0.1f; // m
    const std::vector<Vec3f> normals = normals_of(scene.body, scene.body.positions);
    for (std::uint32_t v = 0; v < normals.size(); ++v) {
        if (cloth_.first_hit(scene.body.positions[v], normals[v], 0.0f, kCovered)) {
            covered_.push_back(v);
        }
    }
}

SceneMeasure::Frame SceneMeasure::frame(const std::vector<Vec3f>& body,
                                        const std::vector<Vec3f>& cloth) {
    constexpr float kDeep = -0.001f; // m
    constexpr float kBehind = 0.02f; // m, cloth so far beneath the skin belongs to this place
    Frame out;
    for (const Vec3f& p : cloth) {
        out.finite = out.finite && p.allFinite();
    }
    if (!out.finite) {
        return out;
    }
    body_.refit(body);
    cloth_.refit(cloth);
    const auto look = [&](const Vec3f& p) {
        const float distance = body_.nearest(p).signed_distance;
        out.deep += distance < kDeep ? 1 : 0;
        out.deepest = std::max(out.deepest, -distance);
    };
    for (const Vec3f& p : cloth) {
        look(p);
    }
    for (const Triangle& t : scene_.cloth.triangles) {
        look((cloth[t[0]] + cloth[t[1]] + cloth[t[2]]) / 3.0f);
    }
    const std::vector<Vec3f> normals = normals_of(scene_.body, body);
    for (const std::uint32_t v : covered_) {
        out.through += cloth_.first_hit(body[v], -normals[v], 0.0f, kBehind) ? 1 : 0;
    }
    return out;
}

SceneMeasure::Strain SceneMeasure::strain(const std::vector<Vec3f>& cloth) const {
    Strain out;
    std::vector<double> all;
    for (const auto& [a, b] : edges_) {
        const std::vector<Vec3f>& rest = scene_.cloth.positions;
        const double longer = (cloth[a] - cloth[b]).norm() / (rest[a] - rest[b]).norm() - 1.0;
        all.push_back(longer);
        out.rms += longer * longer / static_cast<double>(edges_.size());
    }
    std::sort(all.begin(), all.end());
    out.largest = all.back();
    out.p99 = all[all.size() * 99 / 100];
    out.rms = std::sqrt(out.rms);
    return out;
}

std::size_t SceneMeasure::self_intersections(const std::vector<Vec3f>& cloth) const {
    // Triangles by the cells of a grid that their boxes touch.
    constexpr float kCell = 0.02f; // m
    const auto cell = [](const Vec3f& p) {
        return std::array<int, 3>{int(std::floor(p.x() / kCell)), int(std::floor(p.y() / kCell)),
                                  int(std::floor(p.z() / kCell))};
    };
    std::map<std::array<int, 3>, std::vector<std::uint32_t>> cells;
    std::vector<std::array<std::uint32_t, 2>> cut;
    const auto corners = [&](std::uint32_t t) {
        const Triangle& c = scene_.cloth.triangles[t];
        return std::array<Vec3f, 3>{cloth[c[0]], cloth[c[1]], cloth[c[2]]};
    };
    const auto crosses = [&](const std::array<Vec3f, 3>& s, const std::array<Vec3f, 3>& t) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (pierces(s[k], s[(k + 1) % 3], t) || pierces(t[k], t[(k + 1) % 3], s)) {
                return true;
            }
        }
        return false;
    };
    for (std::uint32_t t = 0; t < scene_.cloth.triangles.size(); ++t) {
        const std::array<Vec3f, 3> mine = corners(t);
        const auto low = cell(mine[0].cwiseMin(mine[1]).cwiseMin(mine[2]));
        const auto high = cell(mine[0].cwiseMax(mine[1]).cwiseMax(mine[2]));
        for (int x = low[0]; x <= high[0]; ++x) {
            for (int y = low[1]; y <= high[1]; ++y) {
                for (int z = low[2]; z <= high[2]; ++z) {
                    std::vector<std::uint32_t>& here = cells[{x, y, z}];
                    for (const std::uint32_t other : here) {
                        const Triangle& a = scene_.cloth.triangles[t];
                        const Triangle& b = scene_.cloth.triangles[other];
                        const bool joined = std::any_of(a.begin(), a.end(), [&](std::uint32_t v) {
                            return std::find(b.begin(), b.end(), v) != b.end();
                        });
                        if (!joined && crosses(mine, corners(other))) {
                            cut.push_back({other, t});
                        }
                    }
                    here.push_back(t);
                }
            }
        }
    }
    std::sort(cut.begin(), cut.end());
    cut.erase(std::unique(cut.begin(), cut.end()), cut.end());
    return cut.size();
}

} // namespace toile::bench
