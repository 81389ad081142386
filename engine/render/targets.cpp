#include "render/targets.h"

namespace toile::render {
namespace {

constexpr GLenum kNoFormat = 0;

Framebuffer make(const GladGLContext& gl, const char* what, GLenum color, GLenum depth, int width,
                 int height, int samples) {
    const std::string name = std::string(what) + " of " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels";
    Framebuffer f;
    f.width = width;
    f.height = height;
    f.object = GlObject(gl, GlObject::Kind::framebuffer);
    const GLenum target = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
    if (color != kNoFormat) f.color = make_target(gl, color, width, height, samples, name);
    if (depth != kNoFormat) f.depth = make_target(gl, depth, width, height, samples, name);
    f.bind(gl);
    if (color != kNoFormat) {
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, target, f.color.id(), 0);
    } else {
        gl.DrawBuffer(GL_NONE);
        gl.ReadBuffer(GL_NONE);
    }
    if (depth != kNoFormat) {
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, target, f.depth.id(), 0);
    }
    check_framebuffer(gl, name);
    return f;
}

} // namespace

Targets::Targets(const GladGLContext& gl, int width, int height, int supersampling) {
    const int w = width * supersampling;
    const int h = height * supersampling;
    drawn = make(gl, "multisampled picture", GL_RGBA16F, GL_DEPTH_COMPONENT24, w, h, kSamples);
    const int half_w = (w + 1) / 2;
    const int half_h = (h + 1) / 2;
    surface = make(gl, "surface picture", GL_RGB10_A2, GL_DEPTH_COMPONENT32F, half_w, half_h, 1);
    visibility = make(gl, "visibility picture", GL_RGBA8, kNoFormat, half_w, half_h, 1);
    blurred = make(gl, "visibility picture", GL_RGBA8, kNoFormat, half_w, half_h, 1);
    final = make(gl, "final picture", GL_RGBA8, kNoFormat, width, height, 1);
}

Framebuffer make_shadow_map(const GladGLContext& gl, int side) {
    return make(gl, "shadow map", kNoFormat, GL_DEPTH_COMPONENT32F, side, side, 1);
}

} // namespace toile::render
