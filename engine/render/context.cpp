#include "render/context.h"

#include "core/error.h"

#include <glad/gl.h>

namespace toile::render {

Context::Context() : gl_(std::make_unique<GladGLContext>()) {}
Context::~Context() = default;

void Context::load(Loader loader) {
    const int version = gladLoadGLContext(gl_.get(), loader);
    if (version < GLAD_MAKE_VERSION(3, 3)) {
        throw Error("the graphics driver offers OpenGL " +
                    std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
                    std::to_string(GLAD_VERSION_MINOR(version)) + ", 3.3 is needed");
    }
}

std::string Context::describe() const {
    const auto get = [this](GLenum name) {
        const GLubyte* value = gl_->GetString(name);
        return value == nullptr ? std::string("?") : reinterpret_cast<const char*>(value);
    };
    return "OpenGL " + get(GL_VERSION) + ", " + get(GL_RENDERER);
}

} // namespace toile::render
