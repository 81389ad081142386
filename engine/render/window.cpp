#include "render/window.h"

#include "core/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <glad/gl.h>

namespace toile::render {
namespace {

std::string last_glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "no reason given" : text;
}

// glfwInit and glfwTerminate, counted.
class GlfwLibrary {
  public:
    GlfwLibrary() {
        if (users_ == 0 && glfwInit() != GLFW_TRUE) {
            throw Error("window: " + last_glfw_error() +
                        "; without a display use --headless (is DISPLAY set?)");
        }
        ++users_;
    }
    ~GlfwLibrary() {
        if (--users_ == 0) glfwTerminate();
    }
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;

  private:
    static inline int users_ = 0;
};

class WindowContext final : public Context {
  public:
    explicit WindowContext(GLFWwindow* window) : window_(window) {
        make_current();
        load(glfwGetProcAddress);
    }
    void make_current() override {
        glfwMakeContextCurrent(window_);
        if (glfwGetCurrentContext() != window_) {
            throw Error("window: its OpenGL context cannot be made current: " + last_glfw_error());
        }
    }

  private:
    GLFWwindow* window_;
};

GLFWwindow* make_window(const WindowOptions& options) {
    if (options.width < 1 || options.height < 1) {
        throw Error("window of " + std::to_string(options.width) + " x " +
                    std::to_string(options.height) + " pixels: it has no size");
    }
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    GLFWmonitor* const monitor = options.fullscreen ? glfwGetPrimaryMonitor() : nullptr;
    int width = options.width;
    int height = options.height;
    if (const GLFWvidmode* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor)) {
        width = mode->width;
        height = mode->height;
    }
    GLFWwindow* const window =
        glfwCreateWindow(width, height, options.title.c_str(), monitor, nullptr);
    if (window == nullptr) throw Error("window: it cannot be opened: " + last_glfw_error());
    return window;
}

} // namespace

class Window::Impl {
  public:
    explicit Impl(const WindowOptions& options) : window_(make_window(options)) {
        try {
            context_ = std::make_unique<WindowContext>(window_);
        } catch (...) {
            glfwDestroyWindow(window_);
            throw;
        }
        glfwSwapInterval(0); // the frame loop keeps its own time
        glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
            if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) {
                glfwSetWindowShouldClose(w, GLFW_TRUE);
            }
        });
    }
    ~Impl() {
        context_.reset();
        glfwDestroyWindow(window_);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    GlfwLibrary library_;
    GLFWwindow* window_;
    std::unique_ptr<WindowContext> context_;
};

Window::Window(const WindowOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Window::~Window() = default;

Context& Window::context() {
    return *impl_->context_;
}

bool Window::poll() {
    glfwPollEvents();
    return glfwWindowShouldClose(impl_->window_) == GLFW_FALSE;
}

void Window::close() {
    glfwSetWindowShouldClose(impl_->window_, GLFW_TRUE);
}

int Window::width() const {
    int width = 0;
    glfwGetFramebufferSize(impl_->window_, &width, nullptr);
    return width;
}

int Window::height() const {
    int height = 0;
    glfwGetFramebufferSize(impl_->window_, nullptr, &height);
    return height;
}

void Window::resize(int width, int height) {
    if (width < 1 || height < 1) throw Error("window: it cannot be resized to nothing");
    glfwSetWindowSize(impl_->window_, width, height);
}

void Window::show(Renderer& renderer) {
    // A minimised window has no pixels to show anything in.
    if (width() < 1 || height() < 1) return;
    renderer.present(width(), height());
    glfwSwapBuffers(impl_->window_);
}

} // namespace toile::render
