#include "core/error.h"
#include "unit/render/scenes.h"

#include <cmath>
#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace toile::render {
namespace {

using test::camera_at;
using test::hash;
using test::only_key;
using test::pixel;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RendererTest : public testing::Test {
  protected:
    RendererTest() : context_(make_offscreen_context()), renderer_(*context_, {96, 96}) {}

    Instance add(const test::MeshData& mesh, const Material& material) {
        Instance i;
        i.mesh = renderer_.add_mesh(mesh.description());
        i.material = renderer_.add_material(material);
        return i;
    }
    imaging::Image draw(const Scene& scene) {
        renderer_.draw(scene);
        return renderer_.read();
    }
    // A ball before a plain backdrop.
    Scene ball(const Vec3f& centre = Vec3f(0, 1, 0)) {
        Scene scene;
        scene.camera = camera_at(centre, 2.0f);
        scene.background = {.kind = Background::Kind::color, .color = Vec3f::Zero()};
        scene.instances = {add(test::sphere(centre, 0.3f), {})};
        return scene;
    }

    std::unique_ptr<Context> context_;
    Renderer renderer_;
};

double brightness(const imaging::Image& image, int x0, int y0, int x1, int y1) {
    double sum = 0.0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x)
            sum += pixel(image, x, y)[1];
    }
    return sum / ((x1 - x0) * (y1 - y0));
}

TEST_F(RendererTest, FlatColoursSurviveExactly) {
    Scene scene;
    for (int value = 0; value < 256; value += 5) {
        const double s = value / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        scene.background = {.kind = Background::Kind::color,
                            .color = Vec3f::Constant(static_cast<float>(linear))};
        const imaging::Image image = draw(scene);
        EXPECT_EQ(pixel(image, 40, 50), (std::array{value, value, value}));
    }
}

TEST_F(RendererTest, CameraPictureSurvivesExactlyTheRightWayUp) {
    imaging::Image picture{96, 96, std::vector<std::uint8_t>(96u * 96u * 4u, 255)};
    for (std::size_t i = 0; i < 96u * 96u; ++i) {
        picture.pixels[4 * i] = static_cast<std::uint8_t>(i % 251);
        picture.pixels[4 * i + 1] = static_cast<std::uint8_t>(i / 96);
        picture.pixels[4 * i + 2] = static_cast<std::uint8_t>(255 - i % 96);
    }
    Scene scene;
    scene.background.kind = Background::Kind::camera;
    scene.background.picture = renderer_.add_texture(picture, false);
    EXPECT_EQ(draw(scene).pixels, picture.pixels);
}

TEST_F(RendererTest, SamePictureTwiceAndInAnotherContext) {
    Scene scene = ball();
    scene.background = {};
    const std::uint64_t first = hash(draw(scene));
    EXPECT_EQ(hash(draw(scene)), first);
    // Silhouettes once held NaN that some contexts turned black: no dark pixel on a white ball.
    const imaging::Image image = renderer_.read();
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        ASSERT_GT(image.pixels[i], 60);
    const auto other = make_offscreen_context();
    Renderer renderer(*other, {96, 96});
    scene.instances[0].mesh = renderer.add_mesh(test::sphere(Vec3f(0, 1, 0), 0.3f).description());
    scene.instances[0].material = renderer.add_material({});
    renderer.draw(scene);
    EXPECT_EQ(hash(renderer.read()), first);
    scene.instances[0].world_from_mesh.translation.x() = 0.01f;
    renderer.draw(scene);
    EXPECT_NE(hash(renderer.read()), first) << "the hash does not see a ball move by 1 cm";
}

TEST_F(RendererTest, LambertsLawUnderOneLight) {
    // A white square under one light from straight ahead shines with its full albedo.
    Material grey;
    grey.base_color = {0.4f, 0.4f, 0.4f, 1.0f};
    grey.roughness = 1.0f;
    Scene scene;
    scene.camera = camera_at(Vec3f(0, 1, 0), 2.0f);
    scene.background = {.kind = Background::Kind::color, .color = Vec3f::Zero()};
    scene.lighting = only_key(Vec3f(0, 0, 1));
    scene.instances = {add(test::square(Vec3f(0, 1, 0), 2.0f), grey)};
    const auto linear = [](int value) { return std::pow((value / 255.0 + 0.055) / 1.055, 2.4); };
    const double straight = linear(pixel(draw(scene), 48, 48)[1]);
    EXPECT_NEAR(straight, 0.4, 0.04); // a little more: the surface's faint gloss
    scene.lighting = only_key(Vec3f(0, std::sin(1.0f), std::cos(1.0f)));
    const double aslant = linear(pixel(draw(scene), 48, 48)[1]);
    EXPECT_NEAR(aslant / straight, std::cos(1.0), 0.05);
    scene.lighting.key_color = Vec3f::Zero();
    EXPECT_EQ(pixel(draw(scene), 48, 48), (std::array{0, 0, 0})) << "light out of nothing";
}

TEST_F(RendererTest, NewTextureCoordinatesShowAnotherPlaceOfTheTexture) {
    // Dark on the left half of the texture, bright on the right.
    imaging::Image halves{16, 4, {}};
    for (int i = 0; i < 16 * 4; ++i) {
        const std::uint8_t value = i % 16 < 8 ? 30 : 220;
        halves.pixels.insert(halves.pixels.end(), {value, value, value, 255});
    }
    const test::MeshData square = test::square(Vec3f(0, 1, 0), 1.0f);
    const std::vector<Vec2f> dark(4, Vec2f(0.25f, 0.5f)), bright(4, Vec2f(0.75f, 0.5f));
    MeshDescription description = square.description();
    description.texcoords = dark;
    Material material;
    material.base_color_texture = renderer_.add_texture(halves, false);
    Scene scene;
    scene.camera = camera_at(Vec3f(0, 1, 0), 2.0f);
    scene.lighting = only_key(Vec3f(0, 0, 1));
    Instance instance;
    instance.mesh = renderer_.add_mesh(description);
    instance.material = renderer_.add_material(material);
    scene.instances = {instance};
    const int before = pixel(draw(scene), 48, 48)[1];
    EXPECT_EQ(renderer_.update_texcoords(instance.mesh, bright), Status::ok);
    EXPECT_GT(pixel(draw(scene), 48, 48)[1], before + 100);
    EXPECT_EQ(renderer_.update_texcoords(instance.mesh, dark), Status::ok);
    EXPECT_EQ(pixel(draw(scene), 48, 48)[1], before);

    std::vector<Vec2f> broken = bright;
    broken[2].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(renderer_.update_texcoords(instance.mesh, broken), Status::not_finite);
    EXPECT_EQ(renderer_.update_texcoords(instance.mesh, std::span(bright).first(3)),
              Status::wrong_count);
    EXPECT_EQ(renderer_.update_texcoords(MeshId::none, bright), Status::unknown);
    const MeshId plain = renderer_.add_mesh(square.description());
    EXPECT_EQ(renderer_.update_texcoords(plain, bright), Status::wrong_count) << "it has none";
}

TEST_F(RendererTest, TheSideTowardsTheLightIsBright) {
    Scene scene = ball();
    scene.lighting = only_key(Vec3f(-1, 0, 0.3f));
    const imaging::Image image = draw(scene);
    EXPECT_GT(brightness(image, 30, 40, 40, 56), 2.0 * brightness(image, 56, 40, 66, 56));
    scene.lighting = only_key(Vec3f(0, 1, 0.3f));
    const imaging::Image above = draw(scene);
    EXPECT_GT(brightness(above, 40, 30, 56, 40), 2.0 * brightness(above, 40, 56, 56, 66));
}

TEST_F(RendererTest, ShadowFallsAwayFromTheLight) {
    Scene scene = ball(Vec3f(0, 0.35f, 0));
    scene.background = {};
    scene.camera.world_from_camera.rotation = Quatf(Eigen::AngleAxisf(-0.6f, Vec3f::UnitX()));
    scene.camera.world_from_camera.translation = Vec3f(0, 1.6f, 1.9f);
    scene.camera.left = scene.camera.bottom = -0.5f;
    scene.camera.right = scene.camera.top = 0.5f;
    for (const float side : {-1.0f, 1.0f}) {
        scene.lighting = only_key(Vec3f(side, 1.2f, 0));
        const imaging::Image image = draw(scene);
        const double left = brightness(image, 14, 50, 30, 66);
        const double right = brightness(image, 66, 50, 82, 66);
        EXPECT_GT(side < 0 ? left - right : right - left, 8.0) << "light from " << side;
    }
    scene.instances[0].casts_shadow = false;
    const imaging::Image without = draw(scene);
    EXPECT_NEAR(brightness(without, 14, 50, 30, 66), brightness(without, 66, 50, 82, 66), 3.0);
}

TEST_F(RendererTest, OneSidedMeshesVanishFromBehind) {
    Scene scene;
    scene.background = {.kind = Background::Kind::color, .color = Vec3f::Zero()};
    scene.camera = camera_at(Vec3f(0, 1, 0), 2.0f);
    scene.lighting.ground = scene.lighting.sky = Vec3f::Ones();
    scene.instances = {add(test::square(Vec3f(0, 1, 0), 0.2f), {})};
    EXPECT_GT(pixel(draw(scene), 48, 48)[0], 100);
    scene.instances[0].world_from_mesh.rotation =
        Quatf(Eigen::AngleAxisf(test::kTau / 2, Vec3f::UnitY()));
    EXPECT_EQ(pixel(draw(scene), 48, 48), (std::array{0, 0, 0}));
    Material both;
    both.double_sided = true;
    scene.instances[0].material = renderer_.add_material(both);
    EXPECT_GT(pixel(draw(scene), 48, 48)[0], 100);
}

TEST_F(RendererTest, RealThingsInFrontHideExactly) {
    // Red camera picture; its left half is 1 m away, its right half unknown, its top row 3 m.
    imaging::Image picture{96, 96, std::vector<std::uint8_t>(96u * 96u * 4u, 255)};
    for (std::size_t i = 0; i < 96u * 96u; ++i) {
        picture.pixels[4 * i + 1] = picture.pixels[4 * i + 2] = 0;
    }
    imaging::DepthImage depth{96, 96, std::vector<float>(96u * 96u)};
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            const float known = y < 20 ? 3.0f : 1.0f;
            depth.metres[static_cast<std::size_t>(y * 96 + x)] =
                x < 48 ? known : std::numeric_limits<float>::quiet_NaN();
        }
    }
    Scene scene;
    scene.camera = camera_at(Vec3f(0, 1, 0), 2.0f);
    scene.lighting.sky = Vec3f::Constant(0.5f);
    scene.background.kind = Background::Kind::camera;
    scene.background.picture = renderer_.add_texture(picture, false);
    scene.background.depth = renderer_.add_depth(depth);
    scene.background.soft_edges = false;
    scene.instances = {add(test::square(Vec3f(0, 1, 0), 2.0f), {})};
    imaging::Image image = draw(scene);
    const std::array red = {255, 0, 0};
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            EXPECT_EQ(pixel(image, x, y) == red, x < 48 && y >= 20) << x << ' ' << y;
        }
    }
    // Nearer than the tolerance is not hidden.
    for (float& metres : depth.metres)
        metres = 1.97f;
    EXPECT_EQ(renderer_.update_depth(scene.background.depth, depth), Status::ok);
    EXPECT_NE(pixel(draw(scene), 20, 60), red);
    scene.background.depth_tolerance = 0.02f;
    EXPECT_EQ(pixel(draw(scene), 20, 60), red);
}

TEST_F(RendererTest, OccludersHideWithoutBeingSeen) {
    Scene scene = ball();
    scene.background.color = Vec3f(0, 0, 1);
    scene.instances.push_back(add(test::square(Vec3f(-1, 1, 0.5f), 1.0f), {}));
    scene.instances[1].draw = Instance::Draw::occluder;
    const imaging::Image image = draw(scene);
    EXPECT_EQ(pixel(image, 40, 48), (std::array{0, 0, 255}));
    EXPECT_NE(pixel(image, 56, 48), (std::array{0, 0, 255}));
}

TEST_F(RendererTest, UpdatesMoveTheMesh) {
    Scene scene = ball();
    const std::uint64_t before = hash(draw(scene));
    const MeshId mesh = scene.instances[0].mesh;
    EXPECT_EQ(renderer_.update_mesh(mesh, test::sphere(Vec3f(0.2f, 1, 0), 0.3f).positions),
              Status::ok);
    EXPECT_NE(hash(draw(scene)), before);
    EXPECT_EQ(renderer_.update_mesh(mesh, test::sphere(Vec3f(0, 1, 0), 0.3f).positions),
              Status::ok);
    EXPECT_EQ(hash(draw(scene)), before);
}

TEST_F(RendererTest, RefusesBadMeshes) {
    test::MeshData mesh = test::sphere(Vec3f(0, 1, 0), 0.3f);
    const MeshId id = renderer_.add_mesh(mesh.description());
    mesh.positions[7].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(renderer_.update_mesh(id, mesh.positions), Status::not_finite);
    EXPECT_THAT([&] { static_cast<void>(renderer_.add_mesh(mesh.description())); },
                ThrowsMessage<Error>(HasSubstr("position is not finite")));
    mesh.positions.pop_back();
    EXPECT_EQ(renderer_.update_mesh(id, mesh.positions), Status::wrong_count);
    EXPECT_EQ(renderer_.update_mesh(static_cast<MeshId>(99), mesh.positions), Status::unknown);
    mesh = test::square(Vec3f::Zero(), 1.0f);
    mesh.triangles[1][2] = 4;
    EXPECT_THAT([&] { static_cast<void>(renderer_.add_mesh(mesh.description())); },
                ThrowsMessage<Error>(HasSubstr("triangle 1")));
    renderer_.remove_mesh(id);
    EXPECT_EQ(renderer_.update_mesh(id, mesh.positions), Status::unknown);
}

TEST_F(RendererTest, RefusesBadScenes) {
    Scene scene = ball();
    scene.camera.left = scene.camera.right;
    EXPECT_THAT([&] { renderer_.draw(scene); }, ThrowsMessage<Error>(HasSubstr("camera")));
    scene = ball();
    scene.instances[0].mesh = static_cast<MeshId>(77);
    EXPECT_THAT([&] { renderer_.draw(scene); }, ThrowsMessage<Error>(HasSubstr("instance")));
    scene = ball();
    scene.background.kind = Background::Kind::camera;
    EXPECT_THAT([&] { renderer_.draw(scene); }, ThrowsMessage<Error>(HasSubstr("background")));
    EXPECT_THAT(
        [&] {
            static_cast<void>(renderer_.add_texture({4, 4, {}}, false));
        },
        ThrowsMessage<Error>(HasSubstr("4 x 4")));
}

TEST_F(RendererTest, SizesChangeAndBadOnesAreRefused) {
    const Scene scene = ball();
    const std::uint64_t before = hash(draw(scene));
    renderer_.resize(33, 57);
    EXPECT_EQ(draw(scene).pixels.size(), 33u * 57u * 4u);
    EXPECT_THAT([&] { renderer_.resize(0, 10); }, ThrowsMessage<Error>(HasSubstr("0 x 10")));
    EXPECT_THROW(renderer_.resize(10, 9000), Error);
    EXPECT_EQ(renderer_.width(), 33);
    EXPECT_EQ(draw(scene).width, 33);
    renderer_.resize(96, 96);
    EXPECT_EQ(hash(draw(scene)), before);
    EXPECT_THROW(Renderer(*context_, {0, 0}), Error);
}

TEST_F(RendererTest, WithoutMemoryTheOldSizeStays) {
    Renderer fine(*context_, {32, 32, Quality::high});
    EXPECT_THAT([&] { fine.resize(8192, 8192); }, // 4 GB a buffer, multisampled
                ThrowsMessage<Error>(HasSubstr("multisampled picture")));
    EXPECT_EQ(fine.width(), 32);
    Scene scene;
    scene.background = {.kind = Background::Kind::color, .color = Vec3f::Ones()};
    fine.draw(scene);
    EXPECT_EQ(pixel(fine.read(), 5, 5), (std::array{255, 255, 255}));
}

TEST_F(RendererTest, HighQualityAgreesWithFast) {
    Scene scene = ball();
    scene.background = {};
    const imaging::Image fast = draw(scene);
    Renderer fine(*context_, {96, 96, Quality::high});
    scene.instances[0].mesh = fine.add_mesh(test::sphere(Vec3f(0, 1, 0), 0.3f).description());
    scene.instances[0].material = fine.add_material({});
    fine.draw(scene);
    const imaging::Image high = fine.read();
    EXPECT_NEAR(brightness(fast, 0, 0, 96, 96), brightness(high, 0, 0, 96, 96), 2.0);
    // Ambient occlusion is coarser in a small fast picture.
    EXPECT_NEAR(brightness(fast, 30, 30, 66, 66), brightness(high, 30, 30, 66, 66), 6.0);
}

TEST(Views, FrameTheWholeBox) {
    const Vec3f low(-0.7f, 0, -0.2f);
    const Vec3f high(0.7f, 1.8f, 0.2f);
    for (const View& view : views_from_names("front,back,left,right,three_quarter,above")) {
        const Camera c = frame_view(view, low, high, 480, 640);
        float widest = 0.0f;
        for (int i = 0; i < 8; ++i) {
            const Vec3f corner((i & 1) != 0 ? low.x() : high.x(), (i & 2) != 0 ? low.y() : high.y(),
                               (i & 4) != 0 ? low.z() : high.z());
            const Vec3f p = c.world_from_camera.inverse() * corner;
            ASSERT_LT(p.z(), 0.0f);
            widest = std::max(
                {widest, std::abs(p.x() / p.z()) / c.right, std::abs(p.y() / p.z()) / c.top});
        }
        EXPECT_NEAR(widest, 0.86f, 0.01f) << view.name;
    }
    // The front camera stands before the face, the left one at the body's left hand.
    EXPECT_GT(
        frame_view(view_from_name("front"), low, high, 4, 4).world_from_camera.translation.z(), 1);
    EXPECT_GT(frame_view(view_from_name("left"), low, high, 4, 4).world_from_camera.translation.x(),
              1);
    EXPECT_THROW(static_cast<void>(views_from_names("front,,back")), UsageError);
}

TEST(Camera, FromIntrinsics) {
    const Camera c = camera_from_intrinsics({}, 525, 525, 319.5, 239.5, 640, 480);
    EXPECT_FLOAT_EQ(c.left, -320.0f / 525);
    EXPECT_FLOAT_EQ(c.right, 320.0f / 525);
    EXPECT_FLOAT_EQ(c.top, 240.0f / 525);
    EXPECT_FLOAT_EQ(c.bottom, -240.0f / 525);
    EXPECT_GT(camera_from_intrinsics({}, 525, 525, 300, 239.5, 640, 480).right, c.right);
}

} // namespace
} // namespace toile::render
