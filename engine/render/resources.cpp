#include "render/resources.h"

#include "core/error.h"
#include "geometry/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::render {
namespace {

constexpr std::size_t kMaxMaterials = 255; // the surface picture holds indices of 8 bits

template <typename Id>
std::size_t index_of(Id id) {
    return static_cast<std::size_t>(id) - 1; // none wraps round to a huge index
}

bool finite(std::span<const Vec3f> values) noexcept {
    // x * 0 is 0 for every finite x, NaN for the others.
    Vec3f sum = Vec3f::Zero();
    for (const Vec3f& v : values)
        sum += v * 0.0f;
    return sum == Vec3f::Zero();
}

GlObject make_buffer(const GladGLContext& gl, GLenum target, std::size_t bytes, const void* data,
                     GLenum usage) {
    GlObject buffer(gl, GlObject::Kind::buffer);
    gl.BindBuffer(target, buffer.id());
    gl.BufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
    return buffer;
}

GlObject make_attribute(const GladGLContext& gl, GLuint index, GLint components, std::size_t count,
                        const void* data, GLenum usage) {
    const std::size_t bytes = count * static_cast<std::size_t>(components) * sizeof(float);
    GlObject buffer = make_buffer(gl, GL_ARRAY_BUFFER, bytes, data, usage);
    gl.EnableVertexAttribArray(index);
    gl.VertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, 0, nullptr);
    return buffer;
}

void check_mesh(const MeshDescription& m) {
    const std::size_t nv = m.source.empty() ? m.positions.size() : m.source.size();
    if (nv == 0 || m.triangles.empty()) throw Error("mesh to draw: it has no triangles");
    if (!m.texcoords.empty() && m.texcoords.size() != nv) {
        throw Error("mesh to draw: " + std::to_string(m.texcoords.size()) +
                    " texture coordinates for " + std::to_string(nv) + " vertices");
    }
    if (!m.colors.empty() && m.colors.size() != nv) {
        throw Error("mesh to draw: " + std::to_string(m.colors.size()) + " colours for " +
                    std::to_string(nv) + " vertices");
    }
    if (!finite(m.colors)) throw Error("mesh to draw: a colour is not finite");
    if (!m.normals.empty() && m.normals.size() != m.positions.size()) {
        throw Error("mesh to draw: " + std::to_string(m.normals.size()) + " normals for " +
                    std::to_string(m.positions.size()) + " positions");
    }
    for (std::size_t i = 0; i < m.source.size(); ++i) {
        if (m.source[i] >= m.positions.size()) {
            throw Error("mesh to draw: vertex " + std::to_string(i) + " comes from position " +
                        std::to_string(m.source[i]) + " of " + std::to_string(m.positions.size()));
        }
    }
    for (std::size_t i = 0; i < m.triangles.size(); ++i) {
        const Triangle& t = m.triangles[i];
        if (std::max({t[0], t[1], t[2]}) >= nv) {
            throw Error("mesh to draw: triangle " + std::to_string(i) + " names a vertex beyond " +
                        std::to_string(nv - 1));
        }
    }
    for (const Vec2f& t : m.texcoords) {
        if (!t.allFinite()) throw Error("mesh to draw: a texture coordinate is not finite");
    }
    if (!finite(m.positions)) throw Error("mesh to draw: a position is not finite");
    if (!finite(m.normals)) throw Error("mesh to draw: a normal is not finite");
}

} // namespace

Resources::Resources(const GladGLContext& gl) : gl_(gl) {
    const std::array<std::uint8_t, 4> texel = {255, 255, 255, 255};
    white_ = make_texture(GpuTexture::Kind::color, 1, 1, texel.data());
}

GpuTexture Resources::make_texture(GpuTexture::Kind kind, int width, int height,
                                   const void* pixels) {
    clear_gl_errors(gl_);
    GpuTexture t;
    t.object = GlObject(gl_, GlObject::Kind::texture);
    t.kind = kind;
    t.width = width;
    t.height = height;
    bind_texture(gl_, Unit::base_color_texture, t.object.id());
    const bool depth = kind == GpuTexture::Kind::depth;
    const GLint format = depth                             ? GL_R32F
                         : kind == GpuTexture::Kind::color ? GL_SRGB8_ALPHA8
                                                           : GL_RGBA8;
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, depth ? GL_RED : GL_RGBA,
                   depth ? GL_FLOAT : GL_UNSIGNED_BYTE, pixels);
    const GLint wrap = depth ? GL_CLAMP_TO_EDGE : GL_REPEAT;
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, depth ? GL_NEAREST : GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                      depth ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    if (!depth) gl_.GenerateMipmap(GL_TEXTURE_2D);
    check_gl(gl_,
             "texture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    return t;
}

TextureId Resources::add_texture(const imaging::Image& image, bool linear) {
    const auto pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (image.width <= 0 || image.height <= 0 || image.pixels.size() != pixels * 4) {
        throw Error("texture: a picture of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " pixels with " +
                    std::to_string(image.pixels.size()) + " bytes");
    }
    auto t = std::make_unique<GpuTexture>(
        make_texture(linear ? GpuTexture::Kind::data : GpuTexture::Kind::color, image.width,
                     image.height, image.pixels.data()));
    for (std::size_t i = 0; i < pixels && !linear; ++i)
        t->holes |= image.pixels[4 * i + 3] < 128;
    return keep(std::move(t));
}

TextureId Resources::keep(std::unique_ptr<GpuTexture> texture) {
    if (!free_textures_.empty()) {
        const TextureId id = free_textures_.back();
        free_textures_.pop_back();
        textures_[index_of(id)] = std::move(texture);
        return id;
    }
    textures_.push_back(std::move(texture));
    return static_cast<TextureId>(textures_.size());
}

void Resources::remove_texture(TextureId id) {
    if (texture(id) == nullptr) return;
    textures_[index_of(id)].reset();
    free_textures_.push_back(id);
}

void Resources::remove_material(MaterialId id) {
    if (material(id) == nullptr ||
        std::find(free_materials_.begin(), free_materials_.end(), id) != free_materials_.end())
        return;
    materials_[index_of(id)] = {};
    free_materials_.push_back(id);
}

TextureId Resources::add_depth(const imaging::DepthImage& depth) {
    const auto pixels =
        static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height);
    if (depth.width <= 0 || depth.height <= 0 || depth.metres.size() != pixels) {
        throw Error("depth picture: " + std::to_string(depth.width) + " x " +
                    std::to_string(depth.height) + " pixels with " +
                    std::to_string(depth.metres.size()) + " values");
    }
    auto t = std::make_unique<GpuTexture>(
        make_texture(GpuTexture::Kind::depth, depth.width, depth.height, nullptr));
    t->staging.resize(pixels);
    const TextureId id = keep(std::move(t));
    static_cast<void>(update_depth(id, depth));
    return id;
}

Status Resources::update_texture(TextureId id, const imaging::Image& image) noexcept {
    const GpuTexture* const t = texture(id);
    if (t == nullptr || t->kind == GpuTexture::Kind::depth) return Status::unknown;
    if (image.width != t->width || image.height != t->height ||
        image.pixels.size() !=
            static_cast<std::size_t>(t->width) * static_cast<std::size_t>(t->height) * 4) {
        return Status::wrong_count;
    }
    bind_texture(gl_, Unit::base_color_texture, t->object.id());
    gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t->width, t->height, GL_RGBA, GL_UNSIGNED_BYTE,
                      image.pixels.data());
    gl_.GenerateMipmap(GL_TEXTURE_2D);
    return Status::ok;
}

Status Resources::update_depth(TextureId id, const imaging::DepthImage& depth) noexcept {
    const std::size_t i = index_of(id);
    if (i >= textures_.size() || !textures_[i] || textures_[i]->kind != GpuTexture::Kind::depth) {
        return Status::unknown;
    }
    GpuTexture& t = *textures_[i];
    if (depth.width != t.width || depth.height != t.height ||
        depth.metres.size() != t.staging.size()) {
        return Status::wrong_count;
    }
    // Unknown depth hides nothing.
    std::transform(depth.metres.begin(), depth.metres.end(), t.staging.begin(),
                   [](float metres) { return std::isfinite(metres) ? metres : 0.0f; });
    bind_texture(gl_, Unit::base_color_texture, t.object.id());
    gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t.width, t.height, GL_RED, GL_FLOAT,
                      t.staging.data());
    return Status::ok;
}

MaterialId Resources::add_material(const Material& m) {
    for (const TextureId id : {m.base_color_texture, m.normal_texture}) {
        if (id != TextureId::none && texture(id) == nullptr) {
            throw Error("material: it names a texture that the renderer does not have");
        }
    }
    const float sum =
        m.base_color.sum() + m.sheen_color.sum() + m.sheen_roughness + m.roughness + m.normal_scale;
    if (!std::isfinite(sum)) throw Error("material: a value is not finite");
    if (!free_materials_.empty()) {
        const MaterialId id = free_materials_.back();
        free_materials_.pop_back();
        materials_[index_of(id)] = m;
        return id;
    }
    if (materials_.size() >= kMaxMaterials) {
        throw Error("material: a renderer holds at most " + std::to_string(kMaxMaterials));
    }
    materials_.push_back(m);
    return static_cast<MaterialId>(materials_.size());
}

MeshId Resources::add_mesh(const MeshDescription& description) {
    check_mesh(description);
    const bool seamed = !description.source.empty();
    const std::size_t nv = seamed ? description.source.size() : description.positions.size();
    auto m = std::make_unique<GpuMesh>();
    m->surface_count = description.positions.size();
    m->source.assign(description.source.begin(), description.source.end());
    m->surface_triangles.assign(description.triangles.begin(), description.triangles.end());
    for (Triangle& t : m->surface_triangles) {
        for (std::uint32_t& v : t)
            v = seamed ? m->source[v] : v;
    }
    m->surface_positions.resize(m->surface_count);
    m->surface_normals.resize(m->surface_count);
    m->staging.resize(nv);
    m->index_count = static_cast<GLsizei>(description.triangles.size() * 3);

    clear_gl_errors(gl_);
    m->vertex_array = GlObject(gl_, GlObject::Kind::vertex_array);
    gl_.BindVertexArray(m->vertex_array.id());
    m->positions = make_attribute(gl_, 0, 3, nv, nullptr, GL_DYNAMIC_DRAW);
    m->normals = make_attribute(gl_, 1, 3, nv, nullptr, GL_DYNAMIC_DRAW);
    if (!description.texcoords.empty()) {
        m->texcoords = make_attribute(gl_, 2, 2, nv, description.texcoords.data(), GL_STATIC_DRAW);
    }
    if (!description.colors.empty())
        m->colors = make_attribute(gl_, 3, 3, nv, description.colors.data(), GL_STATIC_DRAW);
    m->indices =
        make_buffer(gl_, GL_ELEMENT_ARRAY_BUFFER, description.triangles.size() * sizeof(Triangle),
                    description.triangles.data(), GL_STATIC_DRAW);
    gl_.BindVertexArray(0);
    check_gl(gl_, "mesh of " + std::to_string(nv) + " vertices");
    meshes_.push_back(std::move(m));
    const auto id = static_cast<MeshId>(meshes_.size());
    static_cast<void>(update_mesh(id, description.positions, description.normals));
    return id;
}

void Resources::remove_mesh(MeshId id) {
    if (mesh(id) == nullptr) throw Error("the renderer has no such mesh to remove");
    meshes_[index_of(id)].reset();
}

Status Resources::update_mesh(MeshId id, std::span<const Vec3f> positions,
                              std::span<const Vec3f> normals) noexcept {
    const std::size_t i = index_of(id);
    if (i >= meshes_.size() || meshes_[i] == nullptr) return Status::unknown;
    GpuMesh& m = *meshes_[i];
    if (positions.size() != m.surface_count ||
        (!normals.empty() && normals.size() != m.surface_count)) {
        return Status::wrong_count;
    }
    if (!finite(positions) || !finite(normals)) return Status::not_finite;
    std::copy(positions.begin(), positions.end(), m.surface_positions.begin());
    if (normals.empty()) {
        geometry::vertex_normals(positions, m.surface_triangles, m.surface_normals);
    } else {
        std::copy(normals.begin(), normals.end(), m.surface_normals.begin());
    }
    m.bounds = Box();
    for (const Vec3f& p : positions)
        m.bounds.add(p);
    upload(m);
    return Status::ok;
}

Status Resources::update_texcoords(MeshId id, std::span<const Vec2f> texcoords) noexcept {
    const std::size_t i = index_of(id);
    if (i >= meshes_.size() || meshes_[i] == nullptr) return Status::unknown;
    const GpuMesh& m = *meshes_[i];
    if (m.texcoords.id() == 0 || texcoords.size() != m.staging.size()) return Status::wrong_count;
    if (!std::all_of(texcoords.begin(), texcoords.end(),
                     [](const Vec2f& t) { return t.allFinite(); }))
        return Status::not_finite;
    gl_.BindBuffer(GL_ARRAY_BUFFER, m.texcoords.id());
    gl_.BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(texcoords.size_bytes()),
                      texcoords.data());
    return Status::ok;
}

void Resources::upload(GpuMesh& m) noexcept {
    const auto put = [&](const GlObject& buffer, const std::vector<Vec3f>& surface) {
        const Vec3f* data = surface.data();
        if (!m.source.empty()) {
            for (std::size_t v = 0; v < m.source.size(); ++v)
                m.staging[v] = surface[m.source[v]];
            data = m.staging.data();
        }
        gl_.BindBuffer(GL_ARRAY_BUFFER, buffer.id());
        gl_.BufferSubData(GL_ARRAY_BUFFER, 0,
                          static_cast<GLsizeiptr>(m.staging.size() * sizeof(Vec3f)), data);
    };
    put(m.positions, m.surface_positions);
    put(m.normals, m.surface_normals);
}

const GpuMesh* Resources::mesh(MeshId id) const noexcept {
    const std::size_t i = index_of(id);
    return i < meshes_.size() ? meshes_[i].get() : nullptr;
}

const GpuTexture* Resources::texture(TextureId id) const noexcept {
    const std::size_t i = index_of(id);
    return i < textures_.size() ? textures_[i].get() : nullptr;
}

const Material* Resources::material(MaterialId id) const noexcept {
    const std::size_t i = index_of(id);
    return i < materials_.size() ? &materials_[i] : nullptr;
}

} // namespace toile::render
