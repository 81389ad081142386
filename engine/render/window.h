// A window that shows what a Renderer drew.
#pragma once

#include "render/context.h"
#include "render/renderer.h"

#include <memory>
#include <string>

namespace toile::render {

struct WindowOptions {
    std::string title = "Toile";
    int width = 720; ///< pixels of the window's framebuffer
    int height = 1280;
    bool fullscreen = false; ///< on the main monitor, in its own resolution
    bool visible = true;
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
    /// As if the user had closed it.
    void close();

    /// Of the framebuffer, pixels; changes when the user resizes the window.
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    /// \throw Error
    void resize(int width, int height);

    /// Shows the renderer's last picture, as large as fits. \throw Error
    void show(Renderer& renderer);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace toile::render
