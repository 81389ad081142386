// A baked texture shows the fine surface's colours at every place of the coarse one.
#include "assets/baked_texture.h"

#include "assets/files.h"
#include "geometry/nearest_surface.h"
#include "geometry/projected_charts.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <thread>

namespace toile::assets {
namespace {

constexpr int kSide = 512, kGap = 4;

/// Stripes that the coarse ball's own vertices are far too few for.
Rgba8 stripes(const Vec3f& p) {
    const auto wave = [](float x) {
        return static_cast<std::uint8_t>(128.0f + 100.0f * std::sin(40.0f * x));
    };
    return {wave(p.x()), wave(p.y()), wave(p.z()), 255};
}

struct Ball {
    ColoredMesh fine{test::sphere(0.5f, 7), {}};
    geometry::TriangleMesh coarse = test::sphere(0.5f, 4);
    geometry::ProjectedAtlas atlas =
        geometry::make_projected_atlas(coarse.positions, coarse.triangles, {kSide, kGap});

    Ball() {
        for (const Vec3f& p : fine.mesh.positions)
            fine.colors.push_back(stripes(p));
    }
    [[nodiscard]] imaging::Image baked(const RowLoop& rows = serial_rows) const {
        return bake_colors(fine, coarse, atlas.layout, kSide, kGap / 2, rows);
    }
};

TEST(BakedTexture, EveryPlaceHasTheColourOfTheFineSurface) {
    const Ball ball;
    const imaging::Image image = ball.baked();
    const geometry::SeamedLayout& layout = ball.atlas.layout;
    // Corners and sides too: there the seams are.
    const std::array<Vec3f, 4> places{Vec3f(1, 0, 0), Vec3f(0.5f, 0.5f, 0), Vec3f(0.3f, 0.3f, 0.4f),
                                      Vec3f(0, 0.9f, 0.1f)};
    std::vector<int> off;
    for (std::size_t f = 0; f < layout.triangles.size(); ++f)
        for (const Vec3f& w : places) {
            Vec2f uv = Vec2f::Zero();
            Vec3f p = Vec3f::Zero();
            for (std::size_t k = 0; k < 3; ++k) {
                const float weight = w[static_cast<Eigen::Index>(k)];
                uv += weight * layout.texcoords[layout.triangles[f][k]];
                p += weight * ball.coarse.positions[ball.coarse.triangles[f][k]];
            }
            const Rgba8 seen = texture_color(image, uv), wanted = stripes(0.5f * p.normalized());
            for (std::size_t c = 0; c < 3; ++c)
                off.push_back(std::abs(static_cast<int>(seen[c]) - static_cast<int>(wanted[c])));
        }
    std::sort(off.begin(), off.end());
    EXPECT_LE(off[off.size() * 95 / 100], 4);
    EXPECT_LE(off.back(), 20);
}

TEST(BakedTexture, NoTexelShowsTwoTriangles) {
    const Ball ball;
    const std::vector<int> shown = atlas_triangles(ball.atlas.layout, kSide, 0);
    const std::vector<int> dilated = atlas_triangles(ball.atlas.layout, kSide, kGap / 2);
    std::size_t covered = 0, gutter = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        covered += shown[i] != kNone ? 1 : 0;
        gutter += shown[i] == kNone && dilated[i] != kNone ? 1 : 0;
        if (shown[i] != kNone) EXPECT_EQ(dilated[i], shown[i]);
    }
    double area = 0.0;
    for (const Triangle& t : ball.atlas.layout.triangles) {
        const auto& uv = ball.atlas.layout.texcoords;
        const Vec2f a = uv[t[1]] - uv[t[0]], b = uv[t[2]] - uv[t[0]];
        area += 0.5 * std::abs(static_cast<double>(a.x() * b.y() - a.y() * b.x()));
    }
    EXPECT_NEAR(static_cast<double>(covered), area * kSide * kSide, 0.02 * area * kSide * kSide);
    EXPECT_GT(gutter, 1000u);
}

TEST(BakedTexture, ManyThreadsGiveTheSameBytes) {
    const Ball ball;
    const RowLoop threaded = [](std::uint32_t count, std::uint32_t grain,
                                const std::function<void(std::uint32_t, std::uint32_t)>& body) {
        std::vector<std::jthread> pool;
        for (std::uint32_t begin = 0; begin < count; begin += grain)
            pool.emplace_back(body, begin, std::min(count, begin + grain));
    };
    EXPECT_EQ(ball.baked().pixels, ball.baked(threaded).pixels);
}

TEST(BakedTexture, BothSidesOfSomethingThinKeepTheirColours) {
    // A sheet of 2 mm: black in front, white behind. The coarse one stands 1.2 mm behind the front.
    ColoredMesh fine{test::box(Vec3f(0, 0, 0), Vec3f(0.4f, 0.4f, 0.002f)), {}};
    for (const Vec3f& p : fine.mesh.positions)
        fine.colors.push_back(p.z() > 0.001f ? Rgba8{0, 0, 0, 255} : Rgba8{255, 255, 255, 255});
    geometry::TriangleMesh coarse;
    for (const auto& [x, y] : {std::pair{0.1f, 0.1f}, {0.3f, 0.1f}, {0.3f, 0.3f}, {0.1f, 0.3f}})
        coarse.positions.emplace_back(x, y, 0.0008f);
    coarse.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto atlas = geometry::make_projected_atlas(coarse.positions, coarse.triangles, {64, 2});
    const imaging::Image image = bake_colors(fine, coarse, atlas.layout, 64, 1);
    EXPECT_EQ(texture_color(image, Vec2f(0.5f, 0.5f)), (Rgba8{0, 0, 0, 255}));
}

TEST(BakedTexture, TravelsInGlbAndBesideObj) {
    const test::TemporaryFolder folder;
    const Ball ball;
    Scene scene = scene_of({ball.coarse, {}}, "ball");
    put_on(scene, ball.atlas.layout, {"stripes", ball.baked(), false});
    save_scene(scene, folder / "ball.glb");
    save_scene(scene, folder / "ball.obj", {.materials_beside = true});
    EXPECT_TRUE(std::filesystem::exists(folder / "ball.mtl"));
    EXPECT_TRUE(std::filesystem::exists(folder / "stripes.png"));
    for (const char* name : {"ball.glb", "ball.obj"}) {
        const Scene back = load_scene(folder / name);
        ASSERT_EQ(back.textures.size(), 1u) << name;
        EXPECT_EQ(back.textures[0].image.pixels, scene.textures[0].image.pixels) << name;
        const ColoredMesh colored = colored_mesh_of(back);
        std::size_t far = 0;
        for (std::size_t v = 0; v < colored.colors.size(); ++v)
            for (std::size_t c = 0; c < 3; ++c)
                far += std::abs(static_cast<int>(colored.colors[v][c]) -
                                static_cast<int>(stripes(colored.mesh.positions[v])[c])) > 12
                           ? 1
                           : 0;
        EXPECT_LT(far, colored.colors.size() / 50) << name;
    }
    save_scene(scene, folder / "bare.obj");
    EXPECT_FALSE(std::filesystem::exists(folder / "bare.mtl"));
}

TEST(BakedTexture, WhatDoesNotFitIsRefused) {
    Ball ball;
    Scene scene = scene_of({test::sphere(0.5f, 1), {}}, "ball");
    EXPECT_ERROR(put_on(scene, ball.atlas.layout, {}), "its atlas is not of");
    ball.fine.colors.clear();
    EXPECT_ERROR((void)ball.baked(), "has no colours");
}

} // namespace
} // namespace toile::assets
