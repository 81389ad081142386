// Draws scenes into its own framebuffer, the same bytes whatever context it runs in.
#pragma once

#include "render/context.h"
#include "render/scene.h"

#include <memory>

namespace toile::render {

/// What a picture costs. `high`: visibility at full resolution, 2 x 2 supersampling.
enum class Quality { invalid, fast, high };

struct RendererOptions {
    int width = 720; ///< pixels, 1 to 8192
    int height = 1280;
    Quality quality = Quality::fast;
};

/// All calls on the context's thread. Set-up calls throw; the calls of a frame (`update_mesh`,
/// `update_texcoords`, `update_texture`, `update_depth`, `draw`, `read`) do not allocate after the
/// first.
class Renderer {
  public:
    /// `context` must outlive this. \throw Error when the picture has no size, is too large, or the
    /// context lacks the memory
    Renderer(Context& context, const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Keeps the old size when it fails. \throw Error
    void resize(int width, int height);
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;

    /// `linear`: data such as normals, else sRGB colours. \throw Error
    [[nodiscard]] TextureId add_texture(const imaging::Image& image, bool linear);
    /// A texture of depths for Background::depth. \throw Error
    [[nodiscard]] TextureId add_depth(const imaging::DepthImage& depth);
    /// \throw Error when a texture is unknown or a value is not finite
    [[nodiscard]] MaterialId add_material(const Material& material);
    /// \throw Error when an index is out of range, a count differs or a value is not finite
    [[nodiscard]] MeshId add_mesh(const MeshDescription& mesh);
    /// Frees a texture or a material, which nothing may name any more; ids are given out again.
    void remove_texture(TextureId texture);
    void remove_material(MaterialId material);
    /// Frees a mesh; its id is not given out again. \throw Error when it is unknown
    void remove_mesh(MeshId mesh);

    /// New positions (ns) and normals (ns, or empty: computed). On failure the mesh stays as it
    /// was.
    [[nodiscard]] Status update_mesh(MeshId mesh, std::span<const Vec3f> positions,
                                     std::span<const Vec3f> normals = {}) noexcept;
    /// New texture coordinates (nv) of a mesh that was added with some. [frame]
    [[nodiscard]] Status update_texcoords(MeshId mesh, std::span<const Vec2f> texcoords) noexcept;
    /// New content of the same size. [frame]
    [[nodiscard]] Status update_texture(TextureId texture, const imaging::Image& image) noexcept;
    [[nodiscard]] Status update_depth(TextureId texture, const imaging::DepthImage& depth) noexcept;

    /// \throw Error when the scene names unknown things or its camera is degenerate
    void draw(const Scene& scene);

    /// Copies the last picture out. `image` keeps its memory when it has the size.
    void read(imaging::Image& image);
    [[nodiscard]] imaging::Image read();

    /// Copies part of the last picture into a framebuffer of the same context (OpenGL's name).
    /// Rows of both count from the bottom; `to` may be wider than `from`, then it is enlarged.
    struct Part {
        int left = 0, bottom = 0, right = 0, top = 0;
    };
    void copy_to(std::uint32_t framebuffer, const Part& from, const Part& to);

    /// Shows the last picture in the context's default framebuffer (a window of this many pixels),
    /// as large as fits, centred.
    void present(int window_width, int window_height);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace toile::render
