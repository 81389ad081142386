#include "render/window.h"

#include "core/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <glad/gl.h>
#include <utility>

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
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
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
    explicit Impl(const WindowOptions& options)
        : window_(make_window(options)), escape_closes_(options.escape_closes) {
        try {
            context_ = std::make_unique<WindowContext>(window_);
        } catch (...) {
            glfwDestroyWindow(window_);
            throw;
        }
        glfwSwapInterval(0); // the frame loop keeps its own time
        glfwSetWindowUserPointer(window_, this);
        glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
            if (action == GLFW_PRESS) self(w).press(key);
        });
        glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
            if (button == GLFW_MOUSE_BUTTON_LEFT && action == GLFW_PRESS) self(w).tap();
        });
        if (options.hide_cursor) glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
    }
    ~Impl() {
        context_.reset();
        glfwDestroyWindow(window_);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    static Impl& self(GLFWwindow* window) {
        return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
    }

    void press(int key) {
        using Key = WindowInput::Key;
        if (key == GLFW_KEY_ESCAPE && escape_closes_) glfwSetWindowShouldClose(window_, GLFW_TRUE);
        WindowInput::Press press;
        if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)) {
            const bool digit = key <= GLFW_KEY_9;
            press = {Key::letter,
                     static_cast<char>(digit ? '0' + key - GLFW_KEY_0 : 'a' + key - GLFW_KEY_A)};
        } else {
            press.key = key == GLFW_KEY_LEFT                                ? Key::left
                        : key == GLFW_KEY_RIGHT                             ? Key::right
                        : key == GLFW_KEY_UP                                ? Key::up
                        : key == GLFW_KEY_DOWN                              ? Key::down
                        : key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER ? Key::enter
                        : key == GLFW_KEY_ESCAPE                            ? Key::escape
                        : key == GLFW_KEY_SPACE                             ? Key::space
                                                                            : Key::invalid;
        }
        if (press.key != Key::invalid) input_.keys.push_back(press);
    }

    void tap() {
        double x = 0.0;
        double y = 0.0;
        glfwGetCursorPos(window_, &x, &y);
        int window_width = 0;
        int window_height = 0;
        int width = 0;
        int height = 0;
        glfwGetWindowSize(window_, &window_width, &window_height);
        glfwGetFramebufferSize(window_, &width, &height);
        if (window_width < 1 || window_height < 1) return;
        input_.taps.emplace_back(static_cast<float>(x * width / window_width),
                                 static_cast<float>(y * height / window_height));
    }

    GlfwLibrary library_;
    GLFWwindow* window_;
    bool escape_closes_;
    WindowInput input_;
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

WindowInput Window::take_input() {
    return std::exchange(impl_->input_, {});
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

void Window::show(Screen& screen) {
    if (width() < 1 || height() < 1) return;
    screen.present(width(), height());
    glfwSwapBuffers(impl_->window_);
}

bool Window::lost() const {
    const auto status =
        reinterpret_cast<GLenum (*)()>(glfwGetProcAddress("glGetGraphicsResetStatusARB"));
    return status != nullptr && glfwExtensionSupported("GL_ARB_robustness") == GLFW_TRUE &&
           status() != GL_NO_ERROR;
}

} // namespace toile::render
