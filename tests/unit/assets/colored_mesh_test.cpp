// Colours of vertices survive files; textures and materials become them.
#include "assets/colored_mesh.h"

#include "assets/files.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::assets {
namespace {

ColoredMesh painted_ball() {
    ColoredMesh out{test::sphere(0.5f, 2), {}};
    for (std::size_t v = 0; v < out.mesh.positions.size(); ++v)
        out.colors.push_back({static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(3 * v),
                              static_cast<std::uint8_t>(255 - v), 255});
    return out;
}

TEST(ColoredMesh, EveryColourSurvivesPlyAndGlb) {
    const test::TemporaryFolder folder;
    const ColoredMesh ball = painted_ball();
    for (const char* name : {"ball.ply", "ball.glb"}) {
        save_scene(scene_of(ball, "ball"), folder / name);
        const ColoredMesh back = load_colored_mesh(folder / name);
        EXPECT_EQ(back.colors, ball.colors) << name;
        EXPECT_EQ(back.mesh.positions, ball.mesh.positions) << name;
    }
}

TEST(ColoredMesh, ATextureIsReadBetweenItsTexels) {
    imaging::Image image;
    image.width = 2;
    image.height = 1;
    image.pixels = {0, 100, 200, 255, 200, 100, 0, 255};
    EXPECT_EQ(texture_color(image, Vec2f(0.25f, 0.5f)), (Rgba8{0, 100, 200, 255}));
    EXPECT_EQ(texture_color(image, Vec2f(0.5f, 0.5f)), (Rgba8{100, 100, 100, 255}));
    EXPECT_EQ(texture_color(image, Vec2f(1.75f, -3.5f)), (Rgba8{200, 100, 0, 255}));
}

TEST(ColoredMesh, WithoutColourNoneIsMadeUp) {
    const test::TemporaryFolder folder;
    save_scene(scene_of({test::sphere(0.5f, 1), {}}, "ball"), folder / "ball.ply");
    EXPECT_TRUE(load_colored_mesh(folder / "ball.ply").colors.empty());
}

TEST(ColoredMesh, AColourForEachVertexOrNone) {
    const test::TemporaryFolder folder;
    ColoredMesh ball = painted_ball();
    ball.colors.pop_back();
    EXPECT_ERROR(save_scene(scene_of(ball, "ball"), folder / "ball.glb"), "colour");
}

} // namespace
} // namespace toile::assets
