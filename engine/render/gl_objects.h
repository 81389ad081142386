// OpenGL objects that free themselves, and the checks after what may fail. Private to this folder.
#pragma once

#include "core/types.h"
#include "render/context.h"

#include <glad/gl.h>
#include <initializer_list>
#include <string>
#include <utility>

namespace toile::render {

/// Texture units; every sampler of the shaders has the name of its unit.
enum class Unit : GLuint {
    base_color_texture,
    normal_texture,
    visibility_texture,
    camera_picture,
    camera_depth,
    contact_map,
    surface_depth,
    surface_normal,
    shadow_map,
    drawn_surface,
    drawn_normal,
    drawn_depth,
};

/// Owns one name made by glGen*. Frees it in the context it came from, which must be current.
class GlObject {
  public:
    enum class Kind { invalid, buffer, vertex_array, texture, framebuffer, renderbuffer };

    GlObject() = default;
    GlObject(const GladGLContext& gl, Kind kind);
    ~GlObject() { reset(); }
    GlObject(GlObject&& other) noexcept { *this = std::move(other); }
    GlObject& operator=(GlObject&& other) noexcept;
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;

    [[nodiscard]] GLuint id() const { return id_; }
    void reset() noexcept;

  private:
    const GladGLContext* gl_ = nullptr;
    Kind kind_ = Kind::invalid;
    GLuint id_ = 0;
};

/// A linked program. Uniforms are set by name; an unused one is ignored, as OpenGL does.
class Program {
  public:
    /// Sources are put one after the other. \throw Error with the compiler's log
    Program(const GladGLContext& gl, const std::string& name,
            std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void use() const { gl_.UseProgram(id_); }
    [[nodiscard]] GLint location(const char* name) const {
        return gl_.GetUniformLocation(id_, name);
    }

  private:
    const GladGLContext& gl_;
    GLuint id_ = 0;
};

void bind_texture(const GladGLContext& gl, Unit unit, GLuint texture,
                  GLenum target = GL_TEXTURE_2D) noexcept;

/// \throw Error "WHAT: out of graphics memory" and the like when OpenGL has a pending error
void check_gl(const GladGLContext& gl, const std::string& what);

/// Forgets pending errors, so that the next check sees only its own.
void clear_gl_errors(const GladGLContext& gl) noexcept;

/// \throw Error when the bound framebuffer cannot be drawn to
void check_framebuffer(const GladGLContext& gl, const std::string& what);

/// A texture without mipmaps, nearest, clamped. `samples` > 1: multisampled. \throw Error
[[nodiscard]] GlObject make_target(const GladGLContext& gl, GLenum format, int width, int height,
                                   int samples, const std::string& what);

} // namespace toile::render
