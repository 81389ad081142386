// Meshes, textures and materials in graphics memory. Private to this folder.
#pragma once

#include "render/frame_uniforms.h"
#include "render/gl_objects.h"
#include "render/scene.h"

#include <memory>
#include <vector>

namespace toile::render {

struct GpuTexture {
    enum class Kind { invalid, color, data, depth };
    GlObject object;
    Kind kind = Kind::invalid;
    int width = 0;
    int height = 0;
    bool holes = false;         ///< some texel's alpha is below a half
    std::vector<float> staging; ///< depth only
};

struct GpuMesh {
    GlObject vertex_array;
    GlObject positions;
    GlObject normals;
    GlObject texcoords;
    GlObject colors;
    GlObject indices;
    GLsizei index_count = 0;
    std::size_t surface_count = 0;
    std::vector<std::uint32_t> source;       ///< empty: identity
    std::vector<Triangle> surface_triangles; ///< into the surface vertices
    std::vector<Vec3f> surface_positions;
    std::vector<Vec3f> surface_normals;
    std::vector<Vec3f> staging;
    Box bounds;
};

/// Ids are indices plus one.
class Resources {
  public:
    explicit Resources(const GladGLContext& gl);

    TextureId add_texture(const imaging::Image& image, bool linear);
    TextureId add_depth(const imaging::DepthImage& depth);
    MaterialId add_material(const Material& material);
    MeshId add_mesh(const MeshDescription& mesh);
    void remove_mesh(MeshId mesh);
    void remove_texture(TextureId texture);
    void remove_material(MaterialId material);

    Status update_mesh(MeshId mesh, std::span<const Vec3f> positions,
                       std::span<const Vec3f> normals) noexcept;
    Status update_texcoords(MeshId mesh, std::span<const Vec2f> texcoords) noexcept;
    Status update_texture(TextureId texture, const imaging::Image& image) noexcept;
    Status update_depth(TextureId texture, const imaging::DepthImage& depth) noexcept;

    /// Null when unknown.
    [[nodiscard]] const GpuMesh* mesh(MeshId id) const noexcept;
    [[nodiscard]] const GpuTexture* texture(TextureId id) const noexcept;
    [[nodiscard]] const Material* material(MaterialId id) const noexcept;
    /// One white texel.
    [[nodiscard]] GLuint white() const { return white_.object.id(); }

  private:
    TextureId keep(std::unique_ptr<GpuTexture> texture);
    GpuTexture make_texture(GpuTexture::Kind kind, int width, int height, const void* pixels);
    void upload(GpuMesh& mesh) noexcept;

    const GladGLContext& gl_;
    std::vector<std::unique_ptr<GpuMesh>> meshes_;
    std::vector<std::unique_ptr<GpuTexture>> textures_;
    std::vector<Material> materials_;
    std::vector<TextureId> free_textures_;
    std::vector<MaterialId> free_materials_;
    GpuTexture white_;
};

} // namespace toile::render
