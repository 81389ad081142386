// An OpenGL 3.3 core context, wherever it comes from. Belongs to the thread that made it.
#pragma once

#include <memory>
#include <string>

struct GladGLContext;

namespace toile::render {

class Context {
  public:
    virtual ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Before each use when a thread has several contexts. \throw Error
    virtual void make_current() = 0;

    /// The context's own table of entry points.
    [[nodiscard]] const GladGLContext& gl() const { return *gl_; }
    /// "OpenGL 3.3, llvmpipe (...)".
    [[nodiscard]] std::string describe() const;

  protected:
    Context();
    using Function = void (*)();
    using Loader = Function (*)(const char* name);
    /// Call once, current. \throw Error
    void load(Loader loader);

  private:
    std::unique_ptr<GladGLContext> gl_;
};

/// Without any window system, on the CPU (OSMesa). \throw Error
[[nodiscard]] std::unique_ptr<Context> make_offscreen_context();

} // namespace toile::render
