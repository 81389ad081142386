#include "core/error.h"
#include "render/context.h"

#include <GL/osmesa.h>
#include <array>

namespace toile::render {
namespace {

constexpr int kSide = 16; // OSMesa wants a buffer of its own; we draw into framebuffer objects

class OffscreenContext final : public Context {
  public:
    OffscreenContext() {
        constexpr std::array<int, 13> attributes = {OSMESA_FORMAT,
                                                    OSMESA_RGBA,
                                                    OSMESA_DEPTH_BITS,
                                                    0,
                                                    OSMESA_PROFILE,
                                                    OSMESA_CORE_PROFILE,
                                                    OSMESA_CONTEXT_MAJOR_VERSION,
                                                    3,
                                                    OSMESA_CONTEXT_MINOR_VERSION,
                                                    3,
                                                    0,
                                                    0,
                                                    0};
        context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        if (context_ == nullptr) {
            throw Error("offscreen drawing: OSMesa gives no OpenGL 3.3 core context; is Mesa's "
                        "llvmpipe installed?");
        }
        try {
            make_current();
            load(OSMesaGetProcAddress);
        } catch (...) {
            OSMesaDestroyContext(context_);
            throw;
        }
    }
    ~OffscreenContext() override { OSMesaDestroyContext(context_); }
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

    void make_current() override {
        if (OSMesaMakeCurrent(context_, buffer_.data(), 0x1401 /* GL_UNSIGNED_BYTE */, kSide,
                              kSide) == 0) {
            throw Error("offscreen drawing: OSMesa cannot make its context current");
        }
    }

  private:
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, static_cast<std::size_t>(kSide* kSide * 4)> buffer_{};
};

} // namespace

std::unique_ptr<Context> make_offscreen_context() {
    return std::make_unique<OffscreenContext>();
}

} // namespace toile::render
