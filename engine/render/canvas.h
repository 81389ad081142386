// Flat shapes and words to lay over a picture: a list of triangles, made without OpenGL.
#pragma once

#include "core/types.h"
#include "imaging/image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace toile::render {

/// sRGB and opacity, 0 to 255.
struct Ink {
    std::uint8_t red = 255;
    std::uint8_t green = 255;
    std::uint8_t blue = 255;
    std::uint8_t alpha = 255;
};

/// Pixels from the top left corner.
struct Rect {
    float x = 0.0f;
    float y = 0.0f;
    float width = 0.0f;
    float height = 0.0f;

    [[nodiscard]] Vec2f centre() const { return {x + 0.5f * width, y + 0.5f * height}; }
    [[nodiscard]] bool contains(const Vec2f& p) const {
        return p.x() >= x && p.y() >= y && p.x() < x + width && p.y() < y + height;
    }
    /// Smaller by this much on each side.
    [[nodiscard]] Rect inset(float by) const {
        return {x + by, y + by, width - 2.0f * by, height - 2.0f * by};
    }
};

/// Where a word stands to its point: begins, is centred, or ends there.
enum class Align { invalid, start, middle, end };

struct TextStyle {
    float size = 32.0f; ///< pixels, from the lowest to the highest stroke and a little more
    Ink ink;
    Align align = Align::start;
    bool bold = false;
};

/// A picture that a Screen keeps; 0 is none.
enum class PictureId : std::uint32_t { none = 0 };

struct CanvasFonts {
    std::filesystem::path regular = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    std::filesystem::path bold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
    std::array<float, 2> sizes{32.0f, 64.0f}; ///< pixels in which letters are drawn sharp
};

/// Dear ImGui's list of shapes, without its windows. Latin letters only; another one is drawn as
/// a question mark. Equal calls give equal triangles.
class Canvas {
  public:
    /// \throw Error naming the font that cannot be read
    explicit Canvas(const CanvasFonts& fonts = {});
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// Forgets everything drawn; the picture's size in pixels.
    void begin(int width, int height);
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;

    void fill(const Rect& rect, Ink ink, float corner_radius = 0.0f);
    void outline(const Rect& rect, Ink ink, float thickness, float corner_radius = 0.0f);
    /// From `top` to `bottom`, without round corners.
    void shade(const Rect& rect, Ink top, Ink bottom);
    void line(std::span<const Vec2f> points, Ink ink, float thickness);
    void disc(const Vec2f& centre, float radius, Ink ink);
    /// Share of a circle, clockwise from the top; 1 is all of it.
    void ring(const Vec2f& centre, float radius, float share, Ink ink, float thickness);
    void triangle(const Vec2f& a, const Vec2f& b, const Vec2f& c, Ink ink);
    void picture(PictureId picture, const Rect& rect);

    /// `at`: start, middle or end of the line, at its top.
    void text(const Vec2f& at, std::string_view words, const TextStyle& style);
    /// Broken between words into lines of at most `width` pixels; the height that they take.
    float paragraph(const Vec2f& at, float width, std::string_view words, const TextStyle& style);
    /// The height alone.
    [[nodiscard]] float paragraph_height(float width, std::string_view words,
                                         const TextStyle& style) const;
    /// Pixels that a line takes.
    [[nodiscard]] float text_width(std::string_view words, const TextStyle& style) const;
    /// Largest size up to the style's in which a line is no wider than `width`.
    [[nodiscard]] float fitting_size(std::string_view words, const TextStyle& style,
                                     float width) const;

    class Impl; ///< for Screen
    [[nodiscard]] Impl& impl() { return *impl_; }

  private:
    struct Line {
        std::size_t end;  ///< of the words that fit
        std::size_t next; ///< where the next line begins
    };
    [[nodiscard]] Line line_end(std::string_view words, std::size_t begin, float width,
                                const TextStyle& style) const;

    std::unique_ptr<Impl> impl_;
};

} // namespace toile::render
