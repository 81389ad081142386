#include "render/gl_objects.h"

#include "core/error.h"

#include <array>
#include <vector>

namespace toile::render {

GlObject::GlObject(const GladGLContext& gl, Kind kind) : gl_(&gl), kind_(kind) {
    switch (kind) {
    case Kind::buffer:
        gl.GenBuffers(1, &id_);
        break;
    case Kind::vertex_array:
        gl.GenVertexArrays(1, &id_);
        break;
    case Kind::texture:
        gl.GenTextures(1, &id_);
        break;
    case Kind::framebuffer:
        gl.GenFramebuffers(1, &id_);
        break;
    case Kind::renderbuffer:
        gl.GenRenderbuffers(1, &id_);
        break;
    case Kind::invalid:
        break;
    }
}

GlObject& GlObject::operator=(GlObject&& other) noexcept {
    if (this != &other) {
        reset();
        gl_ = other.gl_;
        kind_ = other.kind_;
        id_ = std::exchange(other.id_, 0u);
    }
    return *this;
}

void GlObject::reset() noexcept {
    if (id_ == 0) return;
    switch (kind_) {
    case Kind::buffer:
        gl_->DeleteBuffers(1, &id_);
        break;
    case Kind::vertex_array:
        gl_->DeleteVertexArrays(1, &id_);
        break;
    case Kind::texture:
        gl_->DeleteTextures(1, &id_);
        break;
    case Kind::framebuffer:
        gl_->DeleteFramebuffers(1, &id_);
        break;
    case Kind::renderbuffer:
        gl_->DeleteRenderbuffers(1, &id_);
        break;
    case Kind::invalid:
        break;
    }
    id_ = 0;
}

namespace {

// In the order of Unit.
constexpr std::array kSamplers = {"base_color_texture", "normal_texture", "visibility_texture",
                                  "camera_picture",     "camera_depth",   "contact_map",
                                  "surface_depth",      "surface_normal", "shadow_map",
                                  "drawn_surface",      "drawn_normal",   "drawn_depth"};

// Uniform blocks by binding point.
constexpr std::array kBlocks = {"Frame", "Materials"};

GLuint compile(const GladGLContext& gl, GLenum stage, const std::string& name,
               std::initializer_list<const char*> sources) {
    const GLuint shader = gl.CreateShader(stage);
    gl.ShaderSource(shader, static_cast<GLsizei>(sources.size()), sources.begin(), nullptr);
    gl.CompileShader(shader);
    GLint done = GL_FALSE;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done == GL_TRUE) return shader;
    std::vector<char> text(2000, '\0');
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(text.size() - 1), nullptr, text.data());
    gl.DeleteShader(shader);
    throw Error("shader " + name + " does not compile: " + text.data());
}

} // namespace

Program::Program(const GladGLContext& gl, const std::string& name,
                 std::initializer_list<const char*> vertex,
                 std::initializer_list<const char*> fragment)
    : gl_(gl) {
    const GLuint first = compile(gl, GL_VERTEX_SHADER, name + " (vertex)", vertex);
    GLuint second = 0;
    try {
        second = compile(gl, GL_FRAGMENT_SHADER, name + " (fragment)", fragment);
    } catch (...) {
        gl.DeleteShader(first);
        throw;
    }
    id_ = gl.CreateProgram();
    gl.AttachShader(id_, first);
    gl.AttachShader(id_, second);
    gl.LinkProgram(id_);
    gl.DeleteShader(first);
    gl.DeleteShader(second);
    GLint done = GL_FALSE;
    gl.GetProgramiv(id_, GL_LINK_STATUS, &done);
    if (done != GL_TRUE) {
        std::vector<char> text(2000, '\0');
        gl.GetProgramInfoLog(id_, static_cast<GLsizei>(text.size() - 1), nullptr, text.data());
        gl.DeleteProgram(id_);
        throw Error("shader " + name + " does not link: " + text.data());
    }
    GLuint binding = 0;
    for (const char* const name_of_block : kBlocks) {
        const GLuint block = gl.GetUniformBlockIndex(id_, name_of_block);
        if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(id_, block, binding);
        ++binding;
    }
    gl.UseProgram(id_);
    GLint unit = 0;
    for (const char* const sampler : kSamplers)
        gl.Uniform1i(location(sampler), unit++);
}

Program::~Program() {
    gl_.DeleteProgram(id_);
}

void bind_texture(const GladGLContext& gl, Unit unit, GLuint texture, GLenum target) noexcept {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLuint>(unit));
    gl.BindTexture(target, texture);
}

void check_gl(const GladGLContext& gl, const std::string& what) {
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR) return;
    clear_gl_errors(gl);
    if (error == GL_OUT_OF_MEMORY) throw Error(what + ": out of graphics memory");
    throw Error(what + ": OpenGL error " + std::to_string(error));
}

void clear_gl_errors(const GladGLContext& gl) noexcept {
    // A lost context reports errors for ever; a handful is all that can be pending.
    for (int i = 0; i < 16 && gl.GetError() != GL_NO_ERROR; ++i) {
    }
}

void check_framebuffer(const GladGLContext& gl, const std::string& what) {
    const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
    check_gl(gl, what);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(what + ": the graphics driver refuses the framebuffer (status " +
                    std::to_string(status) + ")");
    }
}

GlObject make_target(const GladGLContext& gl, GLenum format, int width, int height, int samples,
                     const std::string& what) {
    clear_gl_errors(gl);
    GlObject texture(gl, GlObject::Kind::texture);
    if (samples > 1) {
        gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture.id());
        gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height,
                                 GL_TRUE);
    } else {
        const bool depth = format == GL_DEPTH_COMPONENT32F || format == GL_DEPTH_COMPONENT24;
        gl.BindTexture(GL_TEXTURE_2D, texture.id());
        gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0,
                      depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, nullptr);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    check_gl(gl, what);
    return texture;
}

} // namespace toile::render
