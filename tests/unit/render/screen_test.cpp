// Pictures and shapes on a display's framebuffer.
#include "core/error.h"
#include "render/screen.h"

#include <gtest/gtest.h>

namespace toile::test {
namespace {

using namespace render;

std::array<int, 3> at(const imaging::Image& image, int x, int y) {
    const std::uint8_t* p =
        image.pixels.data() + 4 * (static_cast<std::size_t>(y) * image.width + x);
    return {p[0], p[1], p[2]};
}

constexpr std::array<int, 3> kRed{255, 0, 0};
constexpr std::array<int, 3> kBlue{0, 0, 255};

/// Left half red, right half blue, as a camera's picture.
imaging::Image two_halves(int width, int height) {
    imaging::Image out{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool left = x < width / 2;
            out.pixels.insert(out.pixels.end(), {static_cast<std::uint8_t>(left ? 255 : 0), 0,
                                                 static_cast<std::uint8_t>(left ? 0 : 255), 255});
        }
    return out;
}

TEST(Screen, AMirrorExchangesLeftAndRight) {
    const auto context = make_offscreen_context();
    Renderer renderer(*context, {64, 48, Quality::fast});
    Scene scene;
    scene.background.kind = Background::Kind::camera;
    scene.background.picture = renderer.add_texture(two_halves(64, 48), false);
    renderer.draw(scene);
    Screen screen(*context, 128, 96);
    imaging::Image seen;
    for (const bool mirrored : {false, true}) {
        screen.clear({});
        screen.show(renderer, {{0, 0, 128, 96}, mirrored, 1.0f, Vec2f::Zero()});
        screen.read(seen);
        EXPECT_EQ(at(seen, 10, 50), mirrored ? kBlue : kRed);
        EXPECT_EQ(at(seen, 118, 50), mirrored ? kRed : kBlue);
    }
}

TEST(Screen, APictureIsCroppedEvenlyAndNeverStretched) {
    const Rect tall = shown_part(640, 480, {{0, 0, 540, 960}, true, 1.0f, Vec2f::Zero()});
    EXPECT_FLOAT_EQ(tall.height, 480.0f);
    EXPECT_FLOAT_EQ(tall.width, 270.0f);
    EXPECT_FLOAT_EQ(tall.x, 185.0f);
    const Rect nearer = shown_part(640, 480, {{0, 0, 640, 480}, true, 2.0f, Vec2f(0.9f, 0.0f)});
    EXPECT_FLOAT_EQ(nearer.width, 320.0f);
    EXPECT_FLOAT_EQ(nearer.x, 320.0f) << "never beside the picture";
    EXPECT_FLOAT_EQ(nearer.y, 120.0f);
}

TEST(Screen, ShapesLieWhereTheyAreDrawnAndTheRestStays) {
    const auto context = make_offscreen_context();
    Screen screen(*context, 100, 80);
    Canvas canvas;
    canvas.begin(100, 80);
    canvas.fill({10, 20, 30, 10}, {255, 0, 0, 255});
    const PictureId picture = screen.add_picture(two_halves(8, 8));
    canvas.picture(picture, {60, 20, 20, 20});
    screen.clear({0, 0, 255, 255});
    screen.draw(canvas);
    imaging::Image seen;
    screen.read(seen);
    EXPECT_EQ(at(seen, 11, 21), kRed);
    EXPECT_EQ(at(seen, 38, 28), kRed);
    EXPECT_EQ(at(seen, 8, 25), kBlue);
    EXPECT_EQ(at(seen, 42, 25), kBlue);
    EXPECT_EQ(at(seen, 20, 32), kBlue);
    EXPECT_EQ(at(seen, 63, 30), kRed);
    EXPECT_EQ(at(seen, 77, 30), kBlue);
}

TEST(Canvas, LinesOfAParagraphAreNoWiderThanAsked) {
    Canvas canvas;
    canvas.begin(400, 400);
    const TextStyle style{20.0f, {}, Align::start, false};
    const std::string_view words = "Stand on the mark and raise your hand";
    const float one = canvas.paragraph({0, 0}, 1e6f, words, style);
    const float two =
        canvas.paragraph({0, 0}, 0.6f * canvas.text_width(words, style), words, style);
    EXPECT_FLOAT_EQ(two, 2.0f * one);
    EXPECT_LE(canvas.text_width(
                  words, {canvas.fitting_size(words, style, 100.0f), {}, Align::start, false}),
              101.0f);
    EXPECT_GT(canvas.text_width("Größe", style), canvas.text_width("Gre", style));
}

TEST(Canvas, AMissingFontIsNamed) {
    try {
        Canvas canvas({"/no/such/font.ttf", "/no/such/font.ttf", {10.0f, 20.0f}});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("/no/such/font.ttf"), std::string::npos);
    }
}

} // namespace
} // namespace toile::test
