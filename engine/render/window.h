// A window that shows what a Renderer drew.
#pragma once

#include "render/context.h"
#include "render/renderer.h"
#include "render/screen.h"

#include <memory>
#include <string>
#include <vector>

namespace toile::render {

struct WindowOptions {
    std::string title = "Toile";
    int width = 720; ///< pixels of the window's framebuffer
    int height = 1280;
    bool fullscreen = false; ///< on the main monitor, in its own resolution
    bool visible = true;
    bool hide_cursor = false;
    bool escape_closes = true;
};

/// What a keyboard, a mouse or a touch screen did since the last look.
struct WindowInput {
    enum class Key { invalid, left, right, up, down, enter, escape, space, letter };
    struct Press {
        Key key = Key::invalid;
        char letter = 0; ///< 'a' to 'z', '0' to '9'
    };
    std::vector<Press> keys;
    std::vector<Vec2f> taps; ///< pixels of the framebuffer from its top left corner
};

/// Main thread only. One window a process is enough for a mirror; several are allowed.
class Window {
  public:
    /// \throw Error without a display, or without OpenGL 3.3
    explicit Window(const WindowOptions& options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// To make Renderers with; lives as long as the window.
    [[nodiscard]] Context& context();

    /// Handles input. False once the window was closed or Escape was pressed.
    [[nodiscard]] bool poll();
    /// Keys and taps since the last call. A touch comes as a tap where the system makes it the
    /// first mouse button, as X11 does.
    [[nodiscard]] WindowInput take_input();
    /// As if the user had closed it.
    void close();

    /// Of the framebuffer, pixels; changes when the user resizes the window.
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// \throw Error
    void resize(int width, int height);

    /// Shows the renderer's last picture, as large as fits. \throw Error
    void show(Renderer& renderer);
    void show(Screen& screen);

    /// A graphics processor that was reset or went away: nothing that was made on this context
    /// works any more. Never true where the driver does not tell.
    [[nodiscard]] bool lost() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace toile::render
