// What a customer's display shows: pictures of Renderers placed on it, and a canvas above them.
#pragma once

#include "render/canvas.h"
#include "render/context.h"
#include "render/renderer.h"

#include <memory>

namespace toile::render {

/// Where a renderer's picture goes.
struct Placement {
    Rect to;                      ///< pixels of the screen; filled, the picture is cropped evenly
    bool mirrored = false;        ///< left and right exchanged, as in a mirror
    float scale = 1.0f;           ///< 1 and more: enlarged about the picture's middle
    Vec2f offset = Vec2f::Zero(); ///< shares of the picture that its middle is moved by
};

/// Part of a picture of this size that fills `placement.to`: pixels from its top left corner.
[[nodiscard]] Rect shown_part(int width, int height, const Placement& placement);

/// A framebuffer of the display's size. Everything on the context's thread; `show` to `present`
/// do not allocate once the canvas has been as long before.
class Screen {
  public:
    /// `context` must outlive this. \throw Error
    Screen(Context& context, int width, int height);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;

    /// For Canvas::picture; freed with the screen. \throw Error
    [[nodiscard]] PictureId add_picture(const imaging::Image& image);
    void remove_picture(PictureId picture);

    void clear(Ink ink);
    void show(Renderer& renderer, const Placement& placement);
    void draw(Canvas& canvas);

    /// Copies the screen out.
    void read(imaging::Image& image);
    /// Puts the screen into a window's framebuffer of this many pixels, as large as fits.
    void present(int window_width, int window_height);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace toile::render
