#include "render/targets.h"

#include <array>

namespace toile::render {
namespace {

constexpr GLenum kNoFormat = 0;

struct Formats {
    GLenum color = kNoFormat;
    GLenum second = kNoFormat;
    GLenum depth = kNoFormat;
};

Framebuffer make(const GladGLContext& gl, const char* what, const Formats& formats, int width,
                 int height, int samples) {
    const std::string name = std::string(what) + " of " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels";
    Framebuffer f;
    f.width = width;
    f.height = height;
    f.object = GlObject(gl, GlObject::Kind::framebuffer);
    f.bind(gl);
    const GLenum target = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    const auto attach = [&](GlObject& texture, GLenum format, GLenum place) {
        if (format == kNoFormat) return;
        texture = make_target(gl, format, width, height, samples, name);
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, place, target, texture.id(), 0);
    };
    attach(f.color, formats.color, GL_COLOR_ATTACHMENT0);
    attach(f.second, formats.second, GL_COLOR_ATTACHMENT1);
    attach(f.depth, formats.depth, GL_DEPTH_ATTACHMENT);
    const std::array<GLenum, 2> both = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    if (formats.second != kNoFormat) {
        gl.DrawBuffers(2, both.data());
    } else if (formats.color == kNoFormat) {
        gl.DrawBuffer(GL_NONE);
        gl.ReadBuffer(GL_NONE);
    }
    check_framebuffer(gl, name);
    return f;
}

} // namespace

Targets::Targets(const GladGLContext& gl, int width, int height, int supersampling) {
    const int w = width * supersampling;
    const int h = height * supersampling;
    drawn = make(gl, "multisampled picture", {GL_RGBA8, GL_RGB10_A2, GL_DEPTH_COMPONENT32F}, w, h,
                 kSamples);
    const int half_w = (w + 1) / 2;
    const int half_h = (h + 1) / 2;
    surface = make(gl, "surface picture", {GL_RGB10_A2, GL_R32F, GL_DEPTH_COMPONENT32F}, half_w,
                   half_h, 1);
    visibility = make(gl, "visibility picture", {GL_RGBA8}, half_w, half_h, 1);
    blurred = make(gl, "visibility picture", {GL_RGBA8}, half_w, half_h, 1);
    final =
        make(gl, "final picture", {GL_RGBA8, kNoFormat, GL_DEPTH_COMPONENT32F}, width, height, 1);
    for (const Framebuffer* const f : {&visibility, &blurred}) {
        f->bind(gl);
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                                surface.depth.id(), 0);
        check_framebuffer(gl, "visibility picture");
    }
}

Framebuffer make_shadow_map(const GladGLContext& gl, int side) {
    return make(gl, "shadow map", {kNoFormat, kNoFormat, GL_DEPTH_COMPONENT32F}, side, side, 1);
}

} // namespace toile::render
