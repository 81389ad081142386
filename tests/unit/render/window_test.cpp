// Needs a display: `xvfb-run -s "-fbdir DIR"`. What the display shows is read from the file that
// Xvfb keeps its screen in (X11's XWD format), DIR/Xvfb_screen0, named by TOILE_TEST_SCREEN.
#include "core/error.h"
#include "render/window.h"
#include "unit/render/scenes.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <thread>

namespace toile::render {
namespace {

Scene studio_ball(Renderer& renderer) {
    Scene scene;
    scene.camera = test::camera_at(Vec3f(0, 0.5f, 0), 2.0f);
    Instance ball;
    ball.mesh = renderer.add_mesh(test::sphere(Vec3f(0, 0.3f, 0), 0.3f).description());
    ball.material = renderer.add_material({});
    scene.instances = {ball};
    return scene;
}

std::unique_ptr<Window> open_window(int width, int height) {
    WindowOptions options;
    options.width = width;
    options.height = height;
    return std::make_unique<Window>(options);
}

// The screen's top left corner of the given size; empty when there is no such file.
imaging::Image screenshot(int width, int height) {
    const char* const path = std::getenv("TOILE_TEST_SCREEN");
    if (path == nullptr) return {};
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    const auto word = [&](std::size_t i) { // big-endian
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            value = value << 8 | static_cast<std::uint8_t>(bytes.at(4 * i + k));
        }
        return static_cast<std::size_t>(value);
    };
    const std::size_t first = word(0) + word(19) * 12; // header, colour map
    const std::size_t stride = word(12);
    EXPECT_EQ(word(11), 32u) << "bits a pixel";
    imaging::Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t at =
                first + static_cast<std::size_t>(y) * stride + static_cast<std::size_t>(x) * 4;
            for (const std::size_t channel : {2u, 1u, 0u}) { // little-endian xRGB
                image.pixels.push_back(static_cast<std::uint8_t>(bytes.at(at + channel)));
            }
            image.pixels.push_back(255);
        }
    }
    return image;
}

// What the screen shows once it shows `expected`, or after two seconds.
imaging::Image screenshot_like(const imaging::Image& expected) {
    imaging::Image shown;
    for (int i = 0; i < 40; ++i) {
        shown = screenshot(expected.width, expected.height);
        if (shown.pixels == expected.pixels) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return shown;
}

#define SKIP_WITHOUT_DISPLAY()                                                                     \
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run"

TEST(Window, WithoutDisplaySaysSo) {
    if (std::getenv("DISPLAY") != nullptr) GTEST_SKIP() << "there is a display";
    try {
        const auto window = open_window(100, 100);
        FAIL() << "a window without a display";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("DISPLAY"), std::string::npos) << e.what();
    }
}

TEST(Window, ShowsTheSameBytesAsOffscreen) {
    SKIP_WITHOUT_DISPLAY();
    const auto offscreen = make_offscreen_context();
    Renderer reference(*offscreen, {160, 120});
    reference.draw(studio_ball(reference));
    const imaging::Image expected = reference.read();

    const auto window = open_window(160, 120);
    Renderer renderer(window->context(), {160, 120});
    renderer.draw(studio_ball(renderer));
    EXPECT_EQ(renderer.read().pixels, expected.pixels);
    window->show(renderer);
    EXPECT_TRUE(window->poll());
    if (screenshot(1, 1).empty()) GTEST_SKIP() << "TOILE_TEST_SCREEN names no screen to read";
    EXPECT_TRUE(screenshot_like(expected).pixels == expected.pixels)
        << "the screen shows other pixels than the framebuffer holds";
}

TEST(Window, ResizesAndLetterboxes) {
    SKIP_WITHOUT_DISPLAY();
    if (screenshot(1, 1).empty()) GTEST_SKIP() << "TOILE_TEST_SCREEN names no screen to read";
    const auto window = open_window(160, 120);
    Renderer renderer(window->context(), {80, 120});
    renderer.draw(studio_ball(renderer));
    const imaging::Image narrow = renderer.read();
    imaging::Image expected{160, 120, std::vector<std::uint8_t>(160u * 120u * 4u, 0)};
    for (std::size_t y = 0; y < 120; ++y) {
        for (std::size_t x = 0; x < 160; ++x) {
            for (std::size_t k = 0; k < 4; ++k) {
                const bool inside = x >= 40 && x < 120;
                expected.pixels[(y * 160 + x) * 4 + k] =
                    k == 3   ? 255
                    : inside ? narrow.pixels[(y * 80 + x - 40) * 4 + k]
                             : 0;
            }
        }
    }
    window->show(renderer);
    EXPECT_TRUE(screenshot_like(expected).pixels == expected.pixels);

    window->resize(240, 100);
    for (int i = 0; i < 100 && window->width() != 240; ++i) {
        static_cast<void>(window->poll());
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_EQ(window->width(), 240);
    EXPECT_EQ(window->height(), 100);
    renderer.resize(240, 100);
    renderer.draw(studio_ball(renderer));
    window->show(renderer);
    const imaging::Image wide = renderer.read();
    EXPECT_TRUE(screenshot_like(wide).pixels == wide.pixels);
}

TEST(Window, Closes) {
    SKIP_WITHOUT_DISPLAY();
    const auto window = open_window(64, 64);
    EXPECT_TRUE(window->poll());
    window->close();
    EXPECT_FALSE(window->poll());
}

} // namespace
} // namespace toile::render
