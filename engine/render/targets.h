// The framebuffers of one picture size. Private to this folder.
#pragma once

#include "render/gl_objects.h"

namespace toile::render {

struct Framebuffer {
    GlObject object;
    GlObject color;  ///< may be none
    GlObject second; ///< second colour, may be none
    GlObject depth;  ///< may be none
    int width = 0;
    int height = 0;

    void bind(const GladGLContext& gl) const {
        gl.BindFramebuffer(GL_FRAMEBUFFER, object.id());
        gl.Viewport(0, 0, width, height);
    }
};

inline constexpr int kSamples = 4;

/// Everything whose size follows the picture's.
struct Targets {
    Framebuffer drawn;      ///< colour and material, normal, depth; multisampled
    Framebuffer surface;    ///< normal, depth in metres, kind; half resolution of `drawn`
    Framebuffer visibility; ///< shadow and ambient occlusion, same size
    Framebuffer blurred;
    Framebuffer final; ///< 8-bit sRGB, and the kind of each pixel

    /// `supersampling` 1 or 2. \throw Error
    Targets(const GladGLContext& gl, int width, int height, int supersampling);
};

/// Depth only. \throw Error
[[nodiscard]] Framebuffer make_shadow_map(const GladGLContext& gl, int side);

} // namespace toile::render
