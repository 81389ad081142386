#include "apps/kiosk/display.h"

#include "apps/kiosk/layout.h"

#include <algorithm>

namespace toile::apps::kiosk {

Display::Display(const KioskConfig& config, bool headless) {
    if (headless) {
        offscreen_ = render::make_offscreen_context();
    } else {
        render::WindowOptions options;
        options.title = "Toile";
        options.width = config.width;
        options.height = config.height;
        options.fullscreen = config.fullscreen;
        options.hide_cursor = config.hide_cursor;
        options.escape_closes = false;
        window_ = std::make_unique<render::Window>(options);
    }
    render::Context& context = window_ ? window_->context() : *offscreen_;
    screen_ = std::make_unique<render::Screen>(context, config.width, config.height);
    const Measures sizes = measures(config.width, config.height);
    render::CanvasFonts fonts;
    fonts.sizes = {sizes.text, sizes.title};
    canvas_ = std::make_unique<render::Canvas>(fonts);
    picture_ = std::make_unique<LivePicture>(context);
}

bool Display::lost() const {
    return lost_ || (window_ && window_->lost());
}

void Display::lose() {
    lost_ = true;
}

bool Display::poll() {
    return !window_ || window_->poll();
}

render::WindowInput Display::take_input() {
    if (!window_) return {};
    render::WindowInput out = window_->take_input();
    // The screen stands in the window as large as fits, centred.
    const auto w = static_cast<float>(window_->width());
    const auto h = static_cast<float>(window_->height());
    const auto sw = static_cast<float>(screen_->width());
    const auto sh = static_cast<float>(screen_->height());
    const float scale = std::min(w / sw, h / sh);
    for (Vec2f& tap : out.taps)
        tap = (tap - 0.5f * Vec2f(w - scale * sw, h - scale * sh)) / scale;
    return out;
}

void Display::show() {
    if (window_) window_->show(*screen_);
}

} // namespace toile::apps::kiosk
