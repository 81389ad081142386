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
    /// A graphics processor that was reset or went away: what was made here works no more, all of
    /// it must be made again on another context. Never true where the driver does not tell.
    [[nodiscard]] bool lost() const;
    /// As if it had been lost; for tests of faults.
    void lose() { lost_ = true; }
    /// "OpenGL 3.3, llvmpipe (...)".
    [[nodiscard]] std::string describe() const;

  protected:
    Context();
    using Function = void (*)();
    using Loader = Function (*)(const char* name);
    /// Call once, current. \throw Error
    void load(Loader loader);

  private:
    using ResetStatus = unsigned int (*)();
    std::unique_ptr<GladGLContext> gl_;
    ResetStatus reset_status_ = nullptr; ///< of robust contexts
    bool lost_ = false;
};

/// Without any window system, on the CPU (OSMesa). \throw Error
[[nodiscard]] std::unique_ptr<Context> make_offscreen_context();

} // namespace toile::render
