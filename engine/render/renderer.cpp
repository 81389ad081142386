#include "render/renderer.h"

#include "core/error.h"
#include "render/contact_map.h"
#include "render/resources.h"
#include "render/shaders.h"
#include "render/targets.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toile::render {
namespace {

constexpr int kLargest = 8192;
constexpr int kShadowSide = 2048;
constexpr float kContactStrength = 0.85f;

// Everything one picture needs, checked and looked up.
struct Drawable {
    const GpuMesh* mesh = nullptr;
    const Material* material = nullptr;
    const Instance* instance = nullptr;
    Mat4f world_from_mesh;
    bool holes = false;
};

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

    Context& context_;
    const GladGLContext& gl_;
    RendererOptions options_;
    Resources resources_;

  private:
    void collect(const Scene& scene);
    void fill_frame(const Scene& scene);
    void draw_contact(const Scene& scene);
    void draw_shadow_map();
    void draw_surfaces(const Scene& scene);
    void draw_visibility();
    void draw_background(const Scene& scene, bool over_everything);
    void draw_meshes(const Scene& scene);
    void draw_mesh(const Program& program, const Drawable& d, bool cull);
    void bind_scene_textures(const Scene& scene);
    [[nodiscard]] GLuint texture_or_white(TextureId id) const;

    Program depth_;
    Program surface_;
    Program floor_;
    Program visibility_;
    Program blur_;
    Program mesh_;
    Program background_;
    Program resolve_;
    Framebuffer shadow_map_;
    std::optional<Targets> targets_;
    GlObject frame_buffer_;
    GlObject no_vertices_;
    GlObject contact_texture_;
    ContactMap contact_;
    FrameUniforms frame_{};
    std::vector<Drawable> drawables_;
    bool behind_first_ = false; ///< the background is drawn before the meshes
};

Renderer::Impl::Impl(Context& context, const RendererOptions& options)
    : context_(context), gl_((context.make_current(), context.gl())), options_(options),
      resources_(gl_), depth_(gl_, "depth", {shaders::k_common, shaders::k_depth_vertex},
                              {shaders::k_common, shaders::k_depth_fragment}),
      surface_(gl_, "surface", {shaders::k_common, shaders::k_mesh_vertex},
               {shaders::k_common, shaders::k_surface_fragment}),
      floor_(gl_, "floor", {shaders::k_common, shaders::k_floor_vertex},
             {shaders::k_common, shaders::k_surface_fragment}),
      visibility_(gl_, "visibility", {shaders::k_common, shaders::k_screen_vertex},
                  {shaders::k_common, shaders::k_visibility_fragment}),
      blur_(gl_, "blur", {shaders::k_common, shaders::k_screen_vertex},
            {shaders::k_common, shaders::k_blur_fragment}),
      mesh_(gl_, "mesh", {shaders::k_common, shaders::k_mesh_vertex},
            {shaders::k_common, shaders::k_shading, shaders::k_mesh_fragment}),
      background_(gl_, "background", {shaders::k_common, shaders::k_screen_vertex},
                  {shaders::k_common, shaders::k_shading, shaders::k_background_fragment}),
      resolve_(gl_, "resolve", {shaders::k_common, shaders::k_screen_vertex},
               {shaders::k_common, shaders::k_resolve_fragment}),
      shadow_map_(make_shadow_map(gl_, kShadowSide)), frame_buffer_(gl_, GlObject::Kind::buffer),
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
    gl_.BufferData(GL_UNIFORM_BUFFER, sizeof(FrameUniforms), nullptr, GL_DYNAMIC_DRAW);
    resize(options.width, options.height);
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
    behind_first_ = scene.background.kind == Background::Kind::camera;
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
        d.world_from_mesh = matrix(instance.world_from_mesh);
        const GpuTexture* const base = resources_.texture(d.material->base_color_texture);
        d.holes = d.material->base_color.w() < 0.5f || (base != nullptr && base->holes);
        behind_first_ |= instance.draw == Instance::Draw::occluder;
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
    fit_shadow_map(frame_, scene.lighting.key_direction, casters, kShadowSide);
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
    contact_.begin(casters);
    const Vec3f rectangle = contact_.rectangle();
    frame_.contact = {rectangle.x(), rectangle.y(), 1.0f / rectangle.z(), kContactStrength};
    gl_.BindBuffer(GL_UNIFORM_BUFFER, frame_buffer_.id());
    gl_.BufferSubData(GL_UNIFORM_BUFFER, 0, sizeof(FrameUniforms), &frame_);
    gl_.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer_.id());
}

void Renderer::Impl::draw_contact(const Scene& scene) {
    if (!scene.floor || scene.background.kind != Background::Kind::studio) return;
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
    const Material& m = *d.material;
    if (cull && !m.double_sided) {
        gl_.Enable(GL_CULL_FACE);
    } else {
        gl_.Disable(GL_CULL_FACE);
    }
    gl_.UniformMatrix4fv(program.location("world_from_mesh"), 1, GL_FALSE,
                         d.world_from_mesh.data());
    gl_.Uniform1i(program.location("holes"), d.holes ? 1 : 0);
    bind_texture(gl_, Unit::base_color_texture, texture_or_white(m.base_color_texture));
    gl_.BindVertexArray(d.mesh->vertex_array.id());
    gl_.DrawElements(GL_TRIANGLES, d.mesh->index_count, GL_UNSIGNED_INT, nullptr);
}

void Renderer::Impl::draw_shadow_map() {
    shadow_map_.bind(gl_);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    depth_.use();
    for (const Drawable& d : drawables_) {
        if (d.instance->casts_shadow) draw_mesh(depth_, d, false);
    }
}

void Renderer::Impl::draw_surfaces(const Scene& scene) {
    targets_->surface.bind(gl_);
    gl_.ClearColor(0.5f, 0.5f, 1.0f, 0.0f);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    surface_.use();
    for (const Drawable& d : drawables_)
        draw_mesh(surface_, d, true);
    if (scene.floor && scene.background.kind == Background::Kind::studio) {
        floor_.use();
        gl_.Uniform1i(floor_.location("holes"), 0);
        gl_.Disable(GL_CULL_FACE);
        gl_.BindVertexArray(no_vertices_.id());
        gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
}

void Renderer::Impl::draw_visibility() {
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(no_vertices_.id());
    bind_texture(gl_, Unit::surface_depth, targets_->surface.depth.id());
    bind_texture(gl_, Unit::surface_normal, targets_->surface.color.id());
    bind_texture(gl_, Unit::shadow_map, shadow_map_.depth.id());
    targets_->visibility.bind(gl_);
    visibility_.use();
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    bind_texture(gl_, Unit::visibility_texture, targets_->visibility.color.id());
    targets_->blurred.bind(gl_);
    blur_.use();
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.Enable(GL_DEPTH_TEST);
}

void Renderer::Impl::bind_scene_textures(const Scene& scene) {
    bind_texture(gl_, Unit::visibility_texture, targets_->blurred.color.id());
    bind_texture(gl_, Unit::camera_picture, texture_or_white(scene.background.picture));
    bind_texture(gl_, Unit::camera_depth, texture_or_white(scene.background.depth));
    bind_texture(gl_, Unit::contact_map, contact_texture_.id());
}

void Renderer::Impl::draw_background(const Scene& scene, bool over_everything) {
    background_.use();
    gl_.Uniform1i(background_.location("has_floor"), scene.floor ? 1 : 0);
    gl_.Disable(GL_CULL_FACE);
    gl_.DepthMask(GL_FALSE);
    gl_.DepthFunc(over_everything ? GL_ALWAYS : GL_LEQUAL);
    gl_.BindVertexArray(no_vertices_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.DepthMask(GL_TRUE);
    gl_.DepthFunc(GL_LESS);
}

void Renderer::Impl::draw_meshes(const Scene& scene) {
    targets_->drawn.bind(gl_);
    gl_.ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    bind_scene_textures(scene);
    if (behind_first_) draw_background(scene, true);
    surface_.use();
    gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (const Drawable& d : drawables_) {
        if (d.instance->draw == Instance::Draw::occluder) draw_mesh(surface_, d, true);
    }
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    mesh_.use();
    for (const Drawable& d : drawables_) {
        if (d.instance->draw != Instance::Draw::visible) continue;
        const Material& m = *d.material;
        gl_.Uniform4fv(mesh_.location("base_color"), 1, m.base_color.data());
        gl_.Uniform4f(mesh_.location("sheen"), m.sheen_color.x(), m.sheen_color.y(),
                      m.sheen_color.z(), m.sheen_roughness);
        gl_.Uniform1f(mesh_.location("roughness"), std::clamp(m.roughness, 0.05f, 1.0f));
        gl_.Uniform1f(mesh_.location("normal_scale"), m.normal_scale);
        const bool mapped = m.normal_texture != TextureId::none;
        gl_.Uniform1i(mesh_.location("has_normal_texture"), mapped ? 1 : 0);
        bind_texture(gl_, Unit::normal_texture, texture_or_white(m.normal_texture));
        draw_mesh(mesh_, d, true);
    }
    if (!behind_first_) draw_background(scene, false);
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
    draw_contact(scene);
    draw_shadow_map();
    draw_surfaces(scene);
    draw_visibility();
    draw_meshes(scene);

    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.BindVertexArray(no_vertices_.id());
    bind_texture(gl_, Unit::drawn, targets_->drawn.color.id(), GL_TEXTURE_2D_MULTISAMPLE);
    targets_->final.bind(gl_);
    resolve_.use();
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
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
void Renderer::remove_mesh(MeshId mesh) {
    impl_->context_.make_current();
    impl_->resources_.remove_mesh(mesh);
}
Status Renderer::update_mesh(MeshId mesh, std::span<const Vec3f> positions,
                             std::span<const Vec3f> normals) noexcept {
    return impl_->resources_.update_mesh(mesh, positions, normals);
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
void Renderer::present(int window_width, int window_height) {
    impl_->present(window_width, window_height);
}

} // namespace toile::render
