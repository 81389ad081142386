#include "render/canvas.h"

#include "core/error.h"
#include "render/canvas_impl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::render {
namespace {

// Latin, dashes, quotes, dots, euro.
constexpr std::array<ImWchar, 7> kLetters = {0x0020, 0x00ff, 0x2010, 0x2027, 0x20ac, 0x20ac, 0};
constexpr float kLineDistance = 1.28f;

ImU32 packed(Ink ink) {
    return IM_COL32(ink.red, ink.green, ink.blue, ink.alpha);
}

ImVec2 vec(const Vec2f& p) {
    return {p.x(), p.y()};
}

ImVec2 low(const Rect& r) {
    return {r.x, r.y};
}

ImVec2 high(const Rect& r) {
    return {r.x + r.width, r.y + r.height};
}

ImFont* load_font(ImFontAtlas& atlas, const std::filesystem::path& file, float size) {
    std::error_code code;
    ImFont* const font =
        std::filesystem::is_regular_file(file, code)
            ? atlas.AddFontFromFileTTF(file.c_str(), size, nullptr, kLetters.data())
            : nullptr;
    if (font == nullptr)
        throw Error(file.string() +
                    ": this font cannot be read; install the package fonts-dejavu-core");
    return font;
}

} // namespace

Canvas::Impl::Impl(const CanvasFonts& fonts) : list(&shared) {
    for (std::size_t i = 0; i < fonts.sizes.size(); ++i) {
        regular[i] = load_font(atlas, fonts.regular, fonts.sizes[i]);
        bold[i] = load_font(atlas, fonts.bold, fonts.sizes[i]);
    }
    atlas.Build();
    shared.Font = regular[0];
    shared.FontSize = regular[0]->FontSize;
    shared.TexUvWhitePixel = atlas.TexUvWhitePixel;
    shared.TexUvLines = atlas.TexUvLines;
    shared.CurveTessellationTol = 1.0f;
    shared.SetCircleTessellationMaxError(0.2f);
    shared.InitialFlags = ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedFill;
}

const ImFont* Canvas::Impl::font(const TextStyle& style) const {
    const FontSizes& fonts = style.bold ? bold : regular;
    return style.size <= 1.2f * fonts[0]->FontSize ? fonts[0] : fonts[1];
}

Canvas::Canvas(const CanvasFonts& fonts) : impl_(std::make_unique<Impl>(fonts)) {}
Canvas::~Canvas() = default;

void Canvas::begin(int width, int height) {
    impl_->width = width;
    impl_->height = height;
    impl_->shared.ClipRectFullscreen = {0.0f, 0.0f, static_cast<float>(width),
                                        static_cast<float>(height)};
    impl_->list._ResetForNewFrame();
    impl_->list.PushClipRectFullScreen();
    impl_->list.PushTextureID(impl_->atlas.TexID);
}

int Canvas::width() const {
    return impl_->width;
}

int Canvas::height() const {
    return impl_->height;
}

void Canvas::fill(const Rect& rect, Ink ink, float corner_radius) {
    impl_->list.AddRectFilled(low(rect), high(rect), packed(ink), corner_radius);
}

void Canvas::outline(const Rect& rect, Ink ink, float thickness, float corner_radius) {
    impl_->list.AddRect(low(rect), high(rect), packed(ink), corner_radius, 0, thickness);
}

void Canvas::shade(const Rect& rect, Ink top, Ink bottom) {
    const ImU32 t = packed(top);
    const ImU32 b = packed(bottom);
    impl_->list.AddRectFilledMultiColor(low(rect), high(rect), t, t, b, b);
}

void Canvas::line(std::span<const Vec2f> points, Ink ink, float thickness) {
    for (const Vec2f& p : points)
        impl_->list.PathLineTo(vec(p));
    impl_->list.PathStroke(packed(ink), 0, thickness);
}

void Canvas::disc(const Vec2f& centre, float radius, Ink ink) {
    impl_->list.AddCircleFilled(vec(centre), radius, packed(ink));
}

void Canvas::ring(const Vec2f& centre, float radius, float share, Ink ink, float thickness) {
    if (share >= 0.999f) {
        impl_->list.AddCircle(vec(centre), radius, packed(ink), 0, thickness);
        return;
    }
    if (share <= 0.0f) return;
    constexpr float kPi = std::numbers::pi_v<float>;
    impl_->list.PathArcTo(vec(centre), radius, -0.5f * kPi, (2.0f * share - 0.5f) * kPi, 64);
    impl_->list.PathStroke(packed(ink), 0, thickness);
}

void Canvas::triangle(const Vec2f& a, const Vec2f& b, const Vec2f& c, Ink ink) {
    impl_->list.AddTriangleFilled(vec(a), vec(b), vec(c), packed(ink));
}

void Canvas::picture(PictureId picture, const Rect& rect) {
    // The texture's name in a pointer is how Dear ImGui carries it.
    auto* const name = reinterpret_cast<ImTextureID>( // NOLINT(performance-no-int-to-ptr)
        static_cast<std::uintptr_t>(picture));
    impl_->list.AddImage(name, low(rect), high(rect));
}

float Canvas::text_width(std::string_view words, const TextStyle& style) const {
    const char* const first = words.data();
    return impl_->font(style)->CalcTextSizeA(style.size, 1e9f, 0.0f, first, first + words.size()).x;
}

float Canvas::fitting_size(std::string_view words, const TextStyle& style, float width) const {
    const float needed = text_width(words, style);
    return needed <= width ? style.size : std::floor(style.size * width / needed);
}

void Canvas::text(const Vec2f& at, std::string_view words, const TextStyle& style) {
    const float share = style.align == Align::middle ? 0.5f
                        : style.align == Align::end  ? 1.0f
                                                     : 0.0f;
    const Vec2f start(std::round(at.x() - share * text_width(words, style)), std::round(at.y()));
    const char* const first = words.data();
    impl_->list.AddText(impl_->font(style), style.size, vec(start), packed(style.ink), first,
                        first + words.size());
}

float Canvas::paragraph_height(float width, std::string_view words, const TextStyle& style) const {
    float height = 0.0f;
    for (std::size_t begin = 0; begin < words.size();) {
        begin = line_end(words, begin, width, style).next;
        height += kLineDistance * style.size;
    }
    return height;
}

Canvas::Line Canvas::line_end(std::string_view words, std::size_t begin, float width,
                              const TextStyle& style) const {
    Line out{words.size(), words.size()};
    for (std::size_t i = begin; i <= words.size(); ++i) {
        if (i < words.size() && words[i] != ' ' && words[i] != '\n') continue;
        const bool fits = text_width(words.substr(begin, i - begin), style) <= width;
        if (!fits && out.end != words.size()) break;
        out = {i, std::min(words.size(), i + 1)};
        if (!fits || (i < words.size() && words[i] == '\n')) break;
    }
    return out;
}

float Canvas::paragraph(const Vec2f& at, float width, std::string_view words,
                        const TextStyle& style) {
    Vec2f place = at;
    for (std::size_t begin = 0; begin < words.size();) {
        const Line line = line_end(words, begin, width, style);
        text(place, words.substr(begin, line.end - begin), style);
        place.y() += kLineDistance * style.size;
        begin = line.next;
    }
    return place.y() - at.y();
}

} // namespace toile::render
