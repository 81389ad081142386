// Where a mirror is drawn: a window, or nowhere. Made anew when the graphics context is lost.
#pragma once

#include "apps/kiosk/config.h"
#include "apps/kiosk/live_picture.h"
#include "render/screen.h"
#include "render/window.h"

#include <memory>
#include <vector>

namespace toile::apps::kiosk {

/// Context, screen and live picture together, in the order that they depend on each other.
class Display {
  public:
    /// \throw Error without a display or OpenGL
    Display(const KioskConfig& config, bool headless);
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    [[nodiscard]] render::Screen& screen() { return *screen_; }
    [[nodiscard]] LivePicture& picture() { return *picture_; }
    [[nodiscard]] render::Canvas& canvas() { return *canvas_; }

    /// False once the window was closed.
    [[nodiscard]] bool poll();
    /// Keys, and taps in pixels of the screen.
    [[nodiscard]] render::WindowInput take_input();
    void show();

    /// Nothing can be drawn any more: make another one.
    [[nodiscard]] bool lost() const;
    /// As if it were; for tests of faults.
    void lose();

  private:
    std::unique_ptr<render::Window> window_;
    std::unique_ptr<render::Context> offscreen_;
    std::unique_ptr<render::Screen> screen_;
    std::unique_ptr<render::Canvas> canvas_;
    std::unique_ptr<LivePicture> picture_;
    bool lost_ = false;
};

} // namespace toile::apps::kiosk
