#include "render/screen.h"

#include "core/error.h"
#include "render/canvas_impl.h"
#include "render/gl_objects.h"
#include "render/shaders.h"
#include "render/targets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace toile::render {
namespace {

GlObject make_picture(const GladGLContext& gl, int width, int height, const void* pixels) {
    GlObject texture(gl, GlObject::Kind::texture);
    bind_texture(gl, Unit::base_color_texture, texture.id());
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    check_gl(gl, "a picture for the screen");
    return texture;
}

} // namespace

Rect shown_part(int width, int height, const Placement& placement) {
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    const float enlarged =
        std::max(placement.to.width / w, placement.to.height / h) * std::max(placement.scale, 1.0f);
    Rect out;
    out.width = placement.to.width / enlarged;
    out.height = placement.to.height / enlarged;
    out.x = std::clamp(0.5f * (w - out.width) + placement.offset.x() * w, 0.0f, w - out.width);
    out.y = std::clamp(0.5f * (h - out.height) + placement.offset.y() * h, 0.0f, h - out.height);
    return out;
}

class Screen::Impl {
  public:
    Impl(Context& context, int width, int height);

    void draw_list(const ImDrawList& list);

    Context& context_;
    const GladGLContext& gl_;
    int width_;
    int height_;
    GlObject color_;
    GlObject framebuffer_;
    Program program_;
    GlObject vertices_;
    GlObject indices_;
    GlObject array_;
    std::vector<GlObject> pictures_;
    GlObject letters_;
    const void* lettered_ = nullptr; ///< the canvas whose letters these are
};

Screen::Impl::Impl(Context& context, int width, int height)
    : context_(context), gl_((context.make_current(), context.gl())), width_(width),
      height_(height), color_(make_target(gl_, GL_RGBA8, width, height, 1, "screen")),
      framebuffer_(gl_, GlObject::Kind::framebuffer),
      program_(gl_, "canvas", {"#version 330 core\n", shaders::k_canvas_vertex},
               {"#version 330 core\n", shaders::k_canvas_fragment}),
      vertices_(gl_, GlObject::Kind::buffer), indices_(gl_, GlObject::Kind::buffer),
      array_(gl_, GlObject::Kind::vertex_array) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
    check_framebuffer(gl_, "screen");
    gl_.BindVertexArray(array_.id());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
    const auto place = [](std::size_t bytes) {
        return reinterpret_cast<const void*>(bytes); // NOLINT(performance-no-int-to-ptr)
    };
    constexpr GLsizei kStride = sizeof(ImDrawVert);
    for (GLuint i = 0; i < 3; ++i)
        gl_.EnableVertexAttribArray(i);
    gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, place(offsetof(ImDrawVert, pos)));
    gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, place(offsetof(ImDrawVert, uv)));
    gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                            place(offsetof(ImDrawVert, col)));
    check_gl(gl_, "screen");
}

void Screen::Impl::draw_list(const ImDrawList& list) {
    gl_.BindVertexArray(array_.id());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
                   GL_STREAM_DRAW);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                   GL_STREAM_DRAW);
    constexpr GLenum kIndex = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.ElemCount == 0) continue;
        const auto name = reinterpret_cast<std::uintptr_t>(command.TextureId);
        const GLuint texture = name == 0                  ? letters_.id()
                               : name <= pictures_.size() ? pictures_[name - 1].id()
                                                          : 0;
        bind_texture(gl_, Unit::base_color_texture, texture);
        gl_.DrawElementsBaseVertex(
            GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), kIndex,
            reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)), // NOLINT
            static_cast<GLint>(command.VtxOffset));
    }
}

Screen::Screen(Context& context, int width, int height)
    : impl_(std::make_unique<Impl>(context, width, height)) {}

Screen::~Screen() {
    impl_->context_.make_current();
}

int Screen::width() const {
    return impl_->width_;
}

int Screen::height() const {
    return impl_->height_;
}

PictureId Screen::add_picture(const imaging::Image& image) {
    if (image.empty()) throw Error("a picture for the screen is empty");
    impl_->context_.make_current();
    GlObject made = make_picture(impl_->gl_, image.width, image.height, image.pixels.data());
    auto& pictures = impl_->pictures_;
    auto free = std::find_if(pictures.begin(), pictures.end(),
                             [](const GlObject& p) { return p.id() == 0; });
    if (free == pictures.end()) {
        pictures.push_back(std::move(made));
        free = pictures.end() - 1;
    } else {
        *free = std::move(made);
    }
    return static_cast<PictureId>(free - pictures.begin() + 1);
}

void Screen::remove_picture(PictureId picture) {
    const auto index = static_cast<std::size_t>(picture);
    if (index == 0 || index > impl_->pictures_.size()) return;
    impl_->context_.make_current();
    impl_->pictures_[index - 1].reset();
}

void Screen::clear(Ink ink) {
    impl_->context_.make_current();
    impl_->gl_.BindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffer_.id());
    const std::array<float, 4> color = {
        static_cast<float>(ink.red) / 255.0f, static_cast<float>(ink.green) / 255.0f,
        static_cast<float>(ink.blue) / 255.0f, static_cast<float>(ink.alpha) / 255.0f};
    impl_->gl_.ClearBufferfv(GL_COLOR, 0, color.data());
}

void Screen::show(Renderer& renderer, const Placement& placement) {
    const Rect part = shown_part(renderer.width(), renderer.height(), placement);
    const auto whole = [](float v) { return static_cast<int>(std::lround(v)); };
    Renderer::Part from{whole(part.x), renderer.height() - whole(part.y + part.height),
                        whole(part.x + part.width), renderer.height() - whole(part.y)};
    const Rect& r = placement.to;
    const Renderer::Part to{whole(r.x), height() - whole(r.y + r.height), whole(r.x + r.width),
                            height() - whole(r.y)};
    if (placement.mirrored) std::swap(from.left, from.right);
    renderer.copy_to(impl_->framebuffer_.id(), from, to);
}

void Screen::draw(Canvas& canvas) {
    Canvas::Impl& shapes = canvas.impl();
    const GladGLContext& gl = impl_->gl_;
    impl_->context_.make_current();
    clear_gl_errors(gl);
    if (impl_->lettered_ != &shapes) {
        unsigned char* pixels = nullptr;
        int w = 0;
        int h = 0;
        shapes.atlas.GetTexDataAsRGBA32(&pixels, &w, &h);
        impl_->letters_ = make_picture(gl, w, h, pixels);
        impl_->lettered_ = &shapes;
    }
    gl.BindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffer_.id());
    gl.Viewport(0, 0, impl_->width_, impl_->height_);
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    impl_->program_.use();
    gl.Uniform2f(impl_->program_.location("screen_size"), static_cast<float>(canvas.width()),
                 static_cast<float>(canvas.height()));
    impl_->draw_list(shapes.list);
    gl.Disable(GL_BLEND);
    gl.Enable(GL_DEPTH_TEST);
    check_gl(gl, "drawing the screen");
}

void Screen::read(imaging::Image& image) {
    impl_->context_.make_current();
    image.width = impl_->width_;
    image.height = impl_->height_;
    const std::size_t row = static_cast<std::size_t>(image.width) * 4;
    image.pixels.resize(row * static_cast<std::size_t>(image.height));
    impl_->gl_.BindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffer_.id());
    impl_->gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    impl_->gl_.ReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE,
                          image.pixels.data());
    for (int low = 0, high = image.height - 1; low < high; ++low, --high)
        std::swap_ranges(image.pixels.begin() + static_cast<std::ptrdiff_t>(row * low),
                         image.pixels.begin() + static_cast<std::ptrdiff_t>(row * (low + 1)),
                         image.pixels.begin() + static_cast<std::ptrdiff_t>(row * high));
    check_gl(impl_->gl_, "reading the screen back");
}

void Screen::present(int window_width, int window_height) {
    impl_->context_.make_current();
    const double scale = std::min(static_cast<double>(window_width) / impl_->width_,
                                  static_cast<double>(window_height) / impl_->height_);
    const int w = std::max(1, static_cast<int>(std::lround(impl_->width_ * scale)));
    const int h = std::max(1, static_cast<int>(std::lround(impl_->height_ * scale)));
    const int x = (window_width - w) / 2;
    const int y = (window_height - h) / 2;
    const GladGLContext& gl = impl_->gl_;
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl.Viewport(0, 0, window_width, window_height);
    gl.ClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, impl_->framebuffer_.id());
    gl.BlitFramebuffer(0, 0, impl_->width_, impl_->height_, x, y, x + w, y + h, GL_COLOR_BUFFER_BIT,
                       scale == 1.0 ? GL_NEAREST : GL_LINEAR);
    check_gl(gl, "showing the screen");
}

} // namespace toile::render
