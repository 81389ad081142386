#include "render/renderer.h"

#include "core/error.h"
#include "render/contact_map.h"
#include "render/resources.h"
#include "render/shaders.h"
#include "render/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace toile::render {
namespace {

constexpr int kLargest = 8192;
int shadow_side(Quality quality) {
    return quality == Quality::high ? 2048 : 1024;
}
constexpr std::size_t kMaterials = 256; // an index fits in 8 bits; 0 is "none"
// Kinds of pixels, as in common.glsl.
constexpr float kMeshKind = 0.25f;
constexpr float kFloorKind = 0.5f;
constexpr float kEdgeKind = 0.5f;
constexpr float kContactStrength = 0.85f;

// Everything one picture needs, checked and looked up.
struct Drawable {
    const GpuMesh* mesh = nullptr;
    const Material* material = nullptr;
    const Instance* instance = nullptr;
    Mat4f world_from_mesh;
    unsigned variant = 0; ///< bits of Variant
    float material_index = 0.0f;
};

// What a mesh's shader must do beyond plain colour.
enum Variant : unsigned { kTextured = 1, kHoles = 2, kNormalMap = 4, kColored = 8, kVariants = 16 };

std::string defines(unsigned variant) {
    std::string text;
    if ((variant & ~kColored) != 0) text += "#define TEXTURED\n";
    if ((variant & kColored) != 0) text += "#define COLORED\n";
    if ((variant & kHoles) != 0) text += "#define HOLES\n";
    if ((variant & kNormalMap) != 0) text += "#define NORMAL_MAP\n";
    return text;
}

Mat4f matrix(const RigidTransform& t) {
    Mat4f m = Mat4f::Identity();
    m.topLeftCorner<3, 3>() = t.rotation.toRotationMatrix();
    m.topRightCorner<3, 1>() = t.translation;
    return m;
}

void check_size(int width, int height) {
    if (width < 1 || height < 1 || width > kLargest || height > kLargest) {
        throw Error("picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels: each side must be 1 to " + std::to_string(kLargest));
    }
}

void check_camera(const Camera& c) {
    const bool finite = c.world_from_camera.translation.allFinite() &&
                        c.world_from_camera.rotation.coeffs().allFinite() &&
                        std::isfinite(c.left + c.right + c.bottom + c.top);
    if (!finite || c.left >= c.right || c.bottom >= c.top ||
        std::abs(c.world_from_camera.rotation.norm() - 1.0f) > 1e-3f) {
        throw Error("camera to draw with: its pose or its picture borders are degenerate");
    }
}

int supersampling(Quality quality) {
    return quality == Quality::high ? 2 : 1;
}

} // namespace

class Renderer::Impl {
  public:
    Impl(Context& context, const RendererOptions& options);

    void resize(int width, int height);
    void draw(const Scene& scene);
    void read(imaging::Image& image);
    void present(int window_width, int window_height);
    void copy_to(GLuint framebuffer, const Part& from, const Part& to);

    Context& context_;
    const GladGLContext& gl_;
    RendererOptions options_;
    Resources resources_;

  private:
    void collect(const Scene& scene);
    void fill_frame(const Scene& scene);
    void draw_contact();
    void draw_shadow_map();
    void draw_meshes();
    void draw_mesh(const Program& program, const Drawable& d, bool cull);
    void draw_screen(const Program& program, float kind);
    void draw_visibility();
    void draw_final(const Scene& scene);
    [[nodiscard]] int horizon_row() const;
    const Program& final_program(const std::string& definitions);
    const Program& mesh_program(unsigned variant);
    const Program& depth_program(unsigned variant);
    [[nodiscard]] GLuint texture_or_white(TextureId id) const;

    std::array<std::unique_ptr<Program>, kVariants> mesh_;
    std::array<std::unique_ptr<Program>, kVariants> depth_;
    Program gather_;
    Program visibility_;
    Program floor_visibility_;
    Program blur_;
    Program floor_blur_;
    Program classify_;
    std::map<std::string, Program> final_; ///< by definitions
    Framebuffer shadow_map_;
    std::optional<Targets> targets_;
    GlObject frame_buffer_;
    GlObject material_buffer_;
    GlObject no_vertices_;
    GlObject contact_texture_;
    ContactMap contact_;
    FrameUniforms frame_{};
    std::array<Vec4f, 2 * kMaterials> materials_{};
    std::vector<Drawable> drawables_;
};

Renderer::Impl::Impl(Context& context, const RendererOptions& options)
    : context_(context), gl_((context.make_current(), context.gl())), options_(options),
      resources_(gl_), gather_(gl_, "gather", {shaders::k_common, shaders::k_screen_vertex},
                               {shaders::k_common, shaders::k_gather_fragment}),
      visibility_(gl_, "visibility", {shaders::k_common, shaders::k_screen_vertex},
                  {shaders::k_common, shaders::k_visibility_fragment}),
      floor_visibility_(gl_, "visibility of the floor",
                        {shaders::k_common, shaders::k_screen_vertex},
                        {shaders::k_common, "#define ON_FLOOR\n", shaders::k_visibility_fragment}),
      blur_(gl_, "blur", {shaders::k_common, shaders::k_screen_vertex},
            {shaders::k_common, shaders::k_blur_fragment}),
      floor_blur_(gl_, "blur on the floor", {shaders::k_common, shaders::k_screen_vertex},
                  {shaders::k_common, "#define ON_FLOOR\n", shaders::k_blur_fragment}),
      classify_(gl_, "classify", {shaders::k_common, shaders::k_screen_vertex},
                {shaders::k_common, shaders::k_classify_fragment}),
      shadow_map_(make_shadow_map(gl_, shadow_side(options.quality))),
      frame_buffer_(gl_, GlObject::Kind::buffer), material_buffer_(gl_, GlObject::Kind::buffer),
      no_vertices_(gl_, GlObject::Kind::vertex_array),
      contact_texture_(
          make_target(gl_, GL_R16F, ContactMap::kSide, ContactMap::kSide, 1, "contact shadow")) {
    if (options.quality != Quality::fast && options.quality != Quality::high) {
        throw Error("renderer: the quality is neither fast nor high");
    }
    gl_.BindTexture(GL_TEXTURE_2D, contact_texture_.id());
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.BindBuffer(GL_UNIFORM_BUFFER, frame_buffer_.id());
    gl_.BufferData(GL_UNIFORM_BUFFER, sizeof(frame_), nullptr, GL_DYNAMIC_DRAW);
    gl_.BindBuffer(GL_UNIFORM_BUFFER, material_buffer_.id());
    gl_.BufferData(GL_UNIFORM_BUFFER, sizeof(materials_), nullptr, GL_DYNAMIC_DRAW);
    resize(options.width, options.height);
}

const Program& Renderer::Impl::final_program(const std::string& definitions) {
    const auto known = final_.find(definitions);
    if (known != final_.end()) return known->second;
    return final_
        .try_emplace(
            definitions, gl_, "final picture",
            std::initializer_list<const char*>{shaders::k_common, shaders::k_screen_vertex},
            std::initializer_list<const char*>{shaders::k_common, definitions.c_str(),
                                               shaders::k_shading, shaders::k_lighting,
                                               shaders::k_final_fragment})
        .first->second;
}

const Program& Renderer::Impl::mesh_program(unsigned variant) {
    std::unique_ptr<Program>& program = mesh_[variant];
    if (!program) {
        const std::string text = defines(variant);
        program = std::make_unique<Program>(
            gl_, "mesh",
            std::initializer_list<const char*>{shaders::k_common, text.c_str(),
                                               shaders::k_mesh_vertex},
            std::initializer_list<const char*>{shaders::k_common, text.c_str(),
                                               shaders::k_mesh_fragment});
    }
    return *program;
}

const Program& Renderer::Impl::depth_program(unsigned variant) {
    std::unique_ptr<Program>& program = depth_[variant & kHoles];
    if (!program) {
        const std::string text = defines(variant & kHoles);
        program = std::make_unique<Program>(
            gl_, "depth",
            std::initializer_list<const char*>{shaders::k_common, text.c_str(),
                                               shaders::k_depth_vertex},
            std::initializer_list<const char*>{shaders::k_common, text.c_str(),
                                               shaders::k_depth_fragment});
    }
    return *program;
}

void Renderer::Impl::resize(int width, int height) {
    check_size(width, height);
    Targets made(gl_, width, height, supersampling(options_.quality));
    targets_.emplace(std::move(made));
    options_.width = width;
    options_.height = height;
}

GLuint Renderer::Impl::texture_or_white(TextureId id) const {
    const GpuTexture* const t = resources_.texture(id);
    return t == nullptr ? resources_.white() : t->object.id();
}

void Renderer::Impl::collect(const Scene& scene) {
    drawables_.clear();
    for (const Instance& instance : scene.instances) {
        if (instance.draw == Instance::Draw::hidden) continue;
        Drawable d;
        d.instance = &instance;
        d.mesh = resources_.mesh(instance.mesh);
        d.material = resources_.material(instance.material);
        if (d.mesh == nullptr || d.material == nullptr ||
            instance.draw == Instance::Draw::invalid) {
            throw Error("scene to draw: an instance names a mesh or material that the renderer "
                        "does not have");
        }
        const Material& m = *d.material;
        const GpuTexture* const base = resources_.texture(m.base_color_texture);
        d.world_from_mesh = matrix(instance.world_from_mesh);
        if (base != nullptr) d.variant |= kTextured;
        if (m.base_color.w() < 0.5f || (base != nullptr && base->holes)) d.variant |= kHoles;
        if (m.normal_texture != TextureId::none) d.variant |= kNormalMap;
        if (d.mesh->colors.id() != 0) d.variant |= kColored;
        if (instance.draw == Instance::Draw::visible || instance.draw == Instance::Draw::receiver) {
            const auto index = static_cast<std::size_t>(instance.material);
            d.material_index = static_cast<float>(index) / 255.0f;
            materials_[2 * index] = {m.sheen_color.x(), m.sheen_color.y(), m.sheen_color.z(),
                                     std::clamp(m.sheen_roughness, 0.1f, 1.0f)};
            const float received = instance.draw == Instance::Draw::receiver ? 1.0f : 0.0f;
            materials_[2 * index + 1] = {std::clamp(m.roughness, 0.05f, 1.0f), received, 0.0f,
                                         0.0f};
        }
        drawables_.push_back(d);
    }
}

void Renderer::Impl::fill_frame(const Scene& scene) {
    Box visible;
    Box casters;
    for (const Drawable& d : drawables_) {
        for (int i = 0; i < 8; ++i) {
            const Vec3f p = d.instance->world_from_mesh * d.mesh->bounds.corner(i);
            visible.add(p);
            if (d.instance->casts_shadow) casters.add(p);
        }
    }
    const bool high = options_.quality == Quality::high;
    const auto size_of = [](const Framebuffer& f) {
        const auto w = static_cast<float>(f.width);
        const auto h = static_cast<float>(f.height);
        return Vec4f(w, h, 1.0f / w, 1.0f / h);
    };
    frame_.range.w() = static_cast<float>(supersampling(options_.quality));
    set_camera(frame_, scene.camera, visible);
    set_lighting(frame_, scene.lighting);
    fit_shadow_map(frame_, scene.lighting.key_direction, casters, shadow_map_.width);
    frame_.target_size = size_of(targets_->drawn);
    frame_.visibility_size = size_of(targets_->blurred);

    const Background& b = scene.background;
    const float kind = b.kind == Background::Kind::camera  ? 2.0f
                       : b.kind == Background::Kind::color ? 1.0f
                                                           : 0.0f;
    frame_.backdrop = {b.color.x(), b.color.y(), b.color.z(), kind};
    const bool hides = b.kind == Background::Kind::camera && b.depth != TextureId::none;
    frame_.occlusion = {b.depth_tolerance, hides ? (b.soft_edges ? 2.0f : 1.0f) : 0.0f,
                        high ? 16.0f : 10.0f, high ? 20.0f : 12.0f};
    const bool floor = scene.floor && b.kind == Background::Kind::studio;
    frame_.flags = {floor ? 1.0f : 0.0f, b.noise, static_cast<float>(b.noise_seed % 1021u), 0.0f};
    set_touched(frame_, visible);
    contact_.begin(casters);
    const Vec3f rectangle = contact_.rectangle();
    frame_.contact = {rectangle.x(), rectangle.y(), 1.0f / rectangle.z(), kContactStrength};
    gl_.BindBuffer(GL_UNIFORM_BUFFER, frame_buffer_.id());
    gl_.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(frame_), &frame_);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer_.id());
    gl_.BindBuffer(GL_UNIFORM_BUFFER, material_buffer_.id());
    gl_.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(materials_), materials_.data());
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 1, material_buffer_.id());
}

void Renderer::Impl::draw_contact() {
    if (frame_.flags.x() < 0.5f) return;
    for (const Drawable& d : drawables_) {
        if (!d.instance->casts_shadow) continue;
        contact_.add(d.mesh->surface_positions, d.mesh->surface_triangles,
                     d.instance->world_from_mesh);
    }
    bind_texture(gl_, Unit::contact_map, contact_texture_.id());
    gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, ContactMap::kSide, ContactMap::kSide, GL_RED,
                      GL_FLOAT, contact_.finish().data());
}

void Renderer::Impl::draw_mesh(const Program& program, const Drawable& d, bool cull) {
    if (cull && !d.material->double_sided) {
        gl_.Enable(GL_CULL_FACE);
    } else {
        gl_.Disable(GL_CULL_FACE);
    }
    gl_.UniformMatrix4fv(program.location("world_from_mesh"), 1, GL_FALSE,
                         d.world_from_mesh.data());
    bind_texture(gl_, Unit::base_color_texture, texture_or_white(d.material->base_color_texture));
    gl_.BindVertexArray(d.mesh->vertex_array.id());
    gl_.DrawElements(GL_TRIANGLES, d.mesh->index_count, GL_UNSIGNED_INT, nullptr);
}

void Renderer::Impl::draw_shadow_map() {
    shadow_map_.bind(gl_);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    for (const Drawable& d : drawables_) {
        if (!d.instance->casts_shadow) continue;
        const Program& program = depth_program(d.variant);
        program.use();
        draw_mesh(program, d, true);
    }
}

void Renderer::Impl::draw_meshes() {
    targets_->drawn.bind(gl_);
    const std::array<float, 4> nothing = {};
    const float far_away = 1.0f;
    gl_.ClearBufferfv(GL_COLOR, 0, nothing.data());
    gl_.ClearBufferfv(GL_DEPTH, 0, &far_away);
    for (const Drawable& d : drawables_) {
        const Program& program = mesh_program(d.variant);
        program.use();
        const Material& m = *d.material;
        gl_.Uniform4fv(program.location("base_color"), 1, m.base_color.data());
        gl_.Uniform1f(program.location("material"), d.material_index);
        gl_.Uniform1f(program.location("normal_scale"), m.normal_scale);
        bind_texture(gl_, Unit::normal_texture, texture_or_white(m.normal_texture));
        draw_mesh(program, d, true);
    }
}

void Renderer::Impl::draw_screen(const Program& program, float kind) {
    program.use();
    gl_.Uniform1f(program.location("kind"), kind);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::draw_visibility() {
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(no_vertices_.id());
    const GLenum samples = GL_TEXTURE_2D_MULTISAMPLE;
    bind_texture(gl_, Unit::drawn_surface, targets_->drawn.color.id(), samples);
    bind_texture(gl_, Unit::drawn_normal, targets_->drawn.second.id(), samples);
    bind_texture(gl_, Unit::drawn_depth, targets_->drawn.depth.id(), samples);
    gl_.DepthFunc(GL_ALWAYS);
    targets_->surface.bind(gl_);
    draw_screen(gather_, kMeshKind);

    bind_texture(gl_, Unit::surface_normal, targets_->surface.color.id());
    bind_texture(gl_, Unit::surface_depth, targets_->surface.second.id());
    bind_texture(gl_, Unit::shadow_map, shadow_map_.depth.id());
    gl_.DepthFunc(GL_EQUAL);
    gl_.DepthMask(GL_FALSE);
    const std::array<float, 4> all_seen = {1.0f, 1.0f, 1.0f, 1.0f};
    targets_->visibility.bind(gl_);
    gl_.ClearBufferfv(GL_COLOR, 0, all_seen.data());
    draw_screen(visibility_, kMeshKind);
    draw_screen(floor_visibility_, kFloorKind);
    bind_texture(gl_, Unit::visibility_texture, targets_->visibility.color.id());
    targets_->blurred.bind(gl_);
    gl_.ClearBufferfv(GL_COLOR, 0, all_seen.data());
    draw_screen(blur_, kMeshKind);
    draw_screen(floor_blur_, kFloorKind);
    gl_.DepthMask(GL_TRUE);
}

// The row of the picture that the horizon crosses, for a camera that does not roll.
int Renderer::Impl::horizon_row() const {
    const Mat4f& m = frame_.world_from_camera;
    if (std::abs(m(1, 0)) > 1e-4f || m(1, 1) < 0.1f) return options_.height;
    const float tangent = m(1, 2) / m(1, 1);
    const float share = (tangent - frame_.borders.z()) / (frame_.borders.w() - frame_.borders.z());
    const float row = std::ceil(share * static_cast<float>(options_.height)) + 1.0f;
    return static_cast<int>(std::clamp(row, 0.0f, static_cast<float>(options_.height)));
}

void Renderer::Impl::draw_final(const Scene& scene) {
    bind_texture(gl_, Unit::visibility_texture, targets_->blurred.color.id());
    bind_texture(gl_, Unit::camera_picture, texture_or_white(scene.background.picture));
    bind_texture(gl_, Unit::camera_depth, texture_or_white(scene.background.depth));
    targets_->final.bind(gl_);
    gl_.Enable(GL_SCISSOR_TEST);
    const int w = options_.width;
    const int h = options_.height;
    const auto scissor_meshes = [&] {
        const float scale = frame_.range.w();
        const auto at = [&](float value, int limit) {
            return static_cast<int>(std::clamp(value / scale, 0.0f, static_cast<float>(limit)));
        };
        const int x = at(frame_.meshes.x(), w);
        const int y = at(frame_.meshes.y(), h);
        gl_.Scissor(x, y, at(frame_.meshes.z() + scale, w) - x,
                    at(frame_.meshes.w() + scale, h) - y);
    };
    gl_.Scissor(0, 0, w, h);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    scissor_meshes();
    gl_.DepthFunc(GL_ALWAYS);
    draw_screen(classify_, kMeshKind);

    const Background::Kind kind = scene.background.kind;
    std::string variant = kind == Background::Kind::studio   ? "#define STUDIO\n"
                          : kind == Background::Kind::camera ? "#define CAMERA\n"
                                                             : "";
    const std::string behind = variant;
    if (frame_.occlusion.y() > 0.5f) variant += "#define OCCLUSION\n";
    if (frame_.occlusion.y() == 1.0f) variant += "#define HARD_EDGES\n";
    gl_.DepthFunc(GL_EQUAL);
    gl_.DepthMask(GL_FALSE);
    draw_screen(final_program(variant + "#define SURFACE\n"), kMeshKind);
    draw_screen(final_program(variant + "#define EDGE\n"), kEdgeKind);
    const bool studio = kind == Background::Kind::studio;
    const int horizon = !studio ? h : frame_.flags.x() > 0.5f ? horizon_row() : 0;
    gl_.Scissor(0, 0, w, horizon);
    draw_screen(final_program(behind), 1.0f);
    gl_.Scissor(0, horizon, w, h - horizon);
    if (horizon < h) draw_screen(final_program(behind + "#define WALL\n"), 1.0f);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_SCISSOR_TEST);
}

void Renderer::Impl::draw(const Scene& scene) {
    check_camera(scene.camera);
    const Background& b = scene.background;
    const bool camera = b.kind == Background::Kind::camera;
    if (b.kind == Background::Kind::invalid ||
        (camera && resources_.texture(b.picture) == nullptr) ||
        (camera && b.depth != TextureId::none && resources_.texture(b.depth) == nullptr)) {
        throw Error(
            "scene to draw: its background names a picture that the renderer does not have");
    }
    context_.make_current();
    clear_gl_errors(gl_);
    collect(scene);
    fill_frame(scene);
    draw_contact();
    draw_shadow_map();
    draw_meshes();
    draw_visibility();
    draw_final(scene);
    check_gl(gl_, "drawing a picture");
}

void Renderer::Impl::read(imaging::Image& image) {
    context_.make_current();
    image.width = options_.width;
    image.height = options_.height;
    const std::size_t row = static_cast<std::size_t>(image.width) * 4;
    image.pixels.resize(row * static_cast<std::size_t>(image.height));
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->final.object.id());
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_.ReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    // OpenGL's rows come from the bottom.
    for (auto low = image.pixels.begin(),
              high = image.pixels.end() - static_cast<std::ptrdiff_t>(row);
         low < high;
         low += static_cast<std::ptrdiff_t>(row), high -= static_cast<std::ptrdiff_t>(row)) {
        std::swap_ranges(low, low + static_cast<std::ptrdiff_t>(row), high);
    }
    check_gl(gl_, "reading the picture back");
}

void Renderer::Impl::present(int window_width, int window_height) {
    context_.make_current();
    const double scale = std::min(static_cast<double>(window_width) / options_.width,
                                  static_cast<double>(window_height) / options_.height);
    const int w = std::max(1, static_cast<int>(std::lround(options_.width * scale)));
    const int h = std::max(1, static_cast<int>(std::lround(options_.height * scale)));
    const int x = (window_width - w) / 2;
    const int y = (window_height - h) / 2;
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    gl_.Viewport(0, 0, window_width, window_height);
    gl_.ClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->final.object.id());
    gl_.BlitFramebuffer(0, 0, options_.width, options_.height, x, y, x + w, y + h,
                        GL_COLOR_BUFFER_BIT, scale == 1.0 ? GL_NEAREST : GL_LINEAR);
    check_gl(gl_, "showing the picture");
}

void Renderer::Impl::copy_to(GLuint framebuffer, const Part& from, const Part& to) {
    context_.make_current();
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->final.object.id());
    gl_.BlitFramebuffer(from.left, from.bottom, from.right, from.top, to.left, to.bottom, to.right,
                        to.top, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    check_gl(gl_, "copying the picture");
}

Renderer::Renderer(Context& context, const RendererOptions& options) {
    check_size(options.width, options.height);
    impl_ = std::make_unique<Impl>(context, options);
}
Renderer::~Renderer() {
    if (impl_) impl_->context_.make_current();
}
void Renderer::resize(int width, int height) {
    impl_->context_.make_current();
    impl_->resize(width, height);
}
int Renderer::width() const {
    return impl_->options_.width;
}
int Renderer::height() const {
    return impl_->options_.height;
}
TextureId Renderer::add_texture(const imaging::Image& image, bool linear) {
    impl_->context_.make_current();
    return impl_->resources_.add_texture(image, linear);
}
TextureId Renderer::add_depth(const imaging::DepthImage& depth) {
    impl_->context_.make_current();
    return impl_->resources_.add_depth(depth);
}
MaterialId Renderer::add_material(const Material& m) {
    return impl_->resources_.add_material(m);
}
MeshId Renderer::add_mesh(const MeshDescription& mesh) {
    impl_->context_.make_current();
    return impl_->resources_.add_mesh(mesh);
}
void Renderer::remove_texture(TextureId texture) {
    impl_->context_.make_current();
    impl_->resources_.remove_texture(texture);
}
void Renderer::remove_material(MaterialId material) {
    impl_->resources_.remove_material(material);
}
void Renderer::remove_mesh(MeshId mesh) {
    impl_->context_.make_current();
    impl_->resources_.remove_mesh(mesh);
}
Status Renderer::update_mesh(MeshId mesh, std::span<const Vec3f> positions,
                             std::span<const Vec3f> normals) noexcept {
    return impl_->resources_.update_mesh(mesh, positions, normals);
}
Status Renderer::update_texcoords(MeshId mesh, std::span<const Vec2f> texcoords) noexcept {
    return impl_->resources_.update_texcoords(mesh, texcoords);
}
Status Renderer::update_texture(TextureId texture, const imaging::Image& image) noexcept {
    return impl_->resources_.update_texture(texture, image);
}
Status Renderer::update_depth(TextureId texture, const imaging::DepthImage& depth) noexcept {
    return impl_->resources_.update_depth(texture, depth);
}
void Renderer::draw(const Scene& scene) {
    impl_->draw(scene);
}
void Renderer::read(imaging::Image& image) {
    impl_->read(image);
}
imaging::Image Renderer::read() {
    imaging::Image image;
    impl_->read(image);
    return image;
}
void Renderer::copy_to(std::uint32_t framebuffer, const Part& from, const Part& to) {
    impl_->copy_to(framebuffer, from, to);
}
void Renderer::present(int window_width, int window_height) {
    impl_->present(window_width, window_height);
}

} // namespace toile::render
