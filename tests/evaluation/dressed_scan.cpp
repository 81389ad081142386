// dressed_scan LOOK.glb OUT.ply [SPACING_M [NOISE_M]]: what a turntable scanner would make of a
// dressed body: one closed surface of what can be seen from around, with the colours of the look.
#include "assets/colored_mesh.h"
#include "assets/files.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/level_surface.h"
#include "geometry/nearest_surface.h"

#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace {

using namespace toile;

/// Level and from above, as a camera on a stand sees.
std::vector<Vec3f> directions() {
    std::vector<Vec3f> out;
    for (int i = 0; i < 16; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / 16.0;
        for (const double pitch : {0.0, 0.25, 0.6})
            out.push_back(Vec3d(std::cos(turn) * std::cos(pitch), std::sin(pitch),
                                std::sin(turn) * std::cos(pitch))
                              .cast<float>());
    }
    return out;
}

geometry::TriangleMesh box_around(const geometry::TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    for (const Vec3f& p : mesh.positions)
        box.extend(p);
    geometry::TriangleMesh out;
    for (unsigned i = 0; i < 8; ++i)
        out.positions.push_back(box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)));
    out.triangles = {{0, 7, 1}, {0, 2, 7}, {3, 4, 0}};
    return out;
}

/// Drops what no camera sees: skin beneath cloth, lower layers.
void keep_seen(geometry::TriangleMesh& mesh, const std::vector<Vec3f>& around) {
    const geometry::NearestSurface all(mesh.positions, mesh.triangles);
    std::vector<std::uint8_t> seen(mesh.triangles.size(), 0);
    parallel_for(seen.size(), [&](std::size_t i) {
        const Triangle& t = mesh.triangles[i];
        const Vec3f& a = mesh.positions[t[0]];
        const Vec3f& b = mesh.positions[t[1]];
        const Vec3f& c = mesh.positions[t[2]];
        const Vec3f out = (b - a).cross(c - a).normalized();
        for (const float side : {1.0f, -1.0f}) // cloth has two
            for (const Vec3f& way : around)
                if (side * way.dot(out) > 0.05f &&
                    !all.blocked((a + b + c) / 3.0f + side * 2e-4f * out, way))
                    seen[i] = 1;
    });
    std::vector<Triangle> kept;
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (seen[i] != 0) kept.push_back(mesh.triangles[i]);
    mesh.triangles = std::move(kept);
}

assets::ColoredMesh scanned(const assets::Scene& look, float spacing, float noise) {
    assets::ColoredMesh seen = assets::colored_mesh_of(look);
    const auto around = directions();
    const geometry::NearestSurface solid(seen.mesh.positions, seen.mesh.triangles);
    keep_seen(seen.mesh, around);
    const geometry::NearestSurface surface(seen.mesh.positions, seen.mesh.triangles);
    const auto value = [&](const Vec3f& p) {
        const auto near = surface.nearest(p);
        const float size = std::clamp(near.distance, 1e-5f, 2.0f * spacing);
        for (const Vec3f& way : around)
            if (!solid.blocked(p, way)) return size;
        return -size;
    };
    assets::ColoredMesh out;
    const auto pieces = geometry::connected_pieces(geometry::level_surface(
        box_around(seen.mesh), spacing, [&](const Vec3f&) { return 3.0f * spacing; }, value));
    for (const auto& piece : pieces)
        if (piece.triangles.size() > out.mesh.triangles.size()) out.mesh = piece;
    Random random(21);
    for (Vec3f& p : out.mesh.positions) {
        const auto near = surface.nearest(p);
        const Triangle& t = seen.mesh.triangles[near.triangle];
        Vec3f color = Vec3f::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c)
                color[static_cast<Eigen::Index>(c)] +=
                    near.barycentric[static_cast<Eigen::Index>(k)] *
                    static_cast<float>(seen.colors[t[k]][c]);
        out.colors.push_back({static_cast<std::uint8_t>(color.x()),
                              static_cast<std::uint8_t>(color.y()),
                              static_cast<std::uint8_t>(color.z()), 255});
        if (noise > 0.0f)
            for (int k = 0; k < 3; ++k)
                p[k] += noise * static_cast<float>(random.normal());
    }
    return out;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("dressed_scan LOOK.glb OUT.ply|OUT.glb [SPACING_M [NOISE_M]]\n", stderr);
        return 2;
    }
    try {
        const float spacing = argc > 3 ? std::strtof(argv[3], nullptr) : 0.007f;
        const float noise = argc > 4 ? std::strtof(argv[4], nullptr) : 0.0f;
        const auto scan = scanned(assets::load_scene(argv[1]), spacing, noise);
        assets::save_scene(assets::scene_of(scan, "scan"), argv[2]);
        std::printf("%s: %zu vertices\n", argv[2], scan.mesh.positions.size());
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dressed_scan: %s\n", e.what());
        return 1;
    }
    return 0;
}
