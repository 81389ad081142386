#include "assets/colored_mesh.h"

#include "geometry/decimate.h"

#include "assets/files.h"
#include "core/error.h"
#include "imaging/srgb.h"

#include <algorithm>
#include <cmath>

namespace toile::assets {
namespace {

std::uint8_t byte(float v) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f)));
}

/// What a primitive's material and colours make of each of its vertices.
void append_colors(const Scene& scene, const Primitive& primitive, std::vector<Rgba8>& out) {
    const Material* material =
        primitive.material == kNone
            ? nullptr
            : &scene.materials.at(static_cast<std::size_t>(primitive.material));
    const Texture* texture =
        material == nullptr || material->base_color_texture == kNone || primitive.texcoords.empty()
            ? nullptr
            : &scene.textures.at(static_cast<std::size_t>(material->base_color_texture));
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
        Rgba8 color = {200, 200, 200, 255};
        if (!primitive.colors.empty())
            color = primitive.colors[v];
        else if (texture != nullptr)
            color = texture_color(texture->image, primitive.texcoords[v]);
        else if (material != nullptr)
            color = {255, 255, 255, 255};
        for (std::size_t k = 0; k < 3 && material != nullptr; ++k) {
            const float light = imaging::linear_from_srgb(static_cast<float>(color[k]) / 255.0f) *
                                material->base_color[static_cast<Eigen::Index>(k)];
            color[k] = byte(imaging::srgb_from_linear(std::clamp(light, 0.0f, 1.0f)));
        }
        color[3] = 255;
        out.push_back(color);
    }
}

} // namespace

Rgba8 texture_color(const imaging::Image& image, const Vec2f& at) {
    const auto wrap = [](int i, int n) { return ((i % n) + n) % n; };
    const float x = (at.x() - std::floor(at.x())) * static_cast<float>(image.width) - 0.5f;
    const float y = (at.y() - std::floor(at.y())) * static_cast<float>(image.height) - 0.5f;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    Rgba8 out{};
    for (std::size_t k = 0; k < 4; ++k) {
        const auto texel = [&](int dx, int dy) {
            const auto i = static_cast<std::size_t>(wrap(y0 + dy, image.height)) *
                               static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(wrap(x0 + dx, image.width));
            return static_cast<float>(image.pixels[4 * i + k]);
        };
        const float value = (1 - fy) * ((1 - fx) * texel(0, 0) + fx * texel(1, 0)) +
                            fy * ((1 - fx) * texel(0, 1) + fx * texel(1, 1));
        out[k] = static_cast<std::uint8_t>(std::lround(value));
    }
    return out;
}

ColoredMesh colored_mesh_of(const Scene& scene) {
    ColoredMesh out;
    std::vector<Eigen::Affine3f> places;
    bool any_color = false, all_normals = true;
    for (const Node& node : scene.nodes) {
        Eigen::Affine3f place =
            Eigen::Translation3f(node.translation) * node.rotation * Eigen::Scaling(node.scale);
        if (node.parent != kNone) place = places[static_cast<std::size_t>(node.parent)] * place;
        places.push_back(place);
        if (node.mesh == kNone) continue;
        for (const Primitive& p : scene.meshes.at(static_cast<std::size_t>(node.mesh)).primitives) {
            const auto base = static_cast<std::uint32_t>(out.mesh.positions.size());
            for (const Vec3f& v : p.positions)
                out.mesh.positions.push_back(place * v);
            for (const Triangle& t : p.triangles)
                out.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
            all_normals = all_normals && p.normals.size() == p.positions.size();
            for (const Vec3f& n : p.normals)
                out.mesh.normals.push_back((place.linear() * n).normalized());
            any_color = any_color || !p.colors.empty() || p.material != kNone;
            append_colors(scene, p, out.colors);
        }
    }
    if (!all_normals) out.mesh.normals.clear();
    if (!any_color) out.colors.clear();
    return out;
}

ColoredMesh load_colored_mesh(const std::filesystem::path& file) {
    ColoredMesh out = colored_mesh_of(load_scene(file));
    if (out.mesh.positions.empty())
        throw FileError(file.string(), "holds no surface and no points");
    return out;
}

Scene scene_of(const ColoredMesh& mesh, const std::string& name) {
    Scene scene;
    Primitive primitive;
    primitive.positions = mesh.mesh.positions;
    primitive.normals = mesh.mesh.normals;
    primitive.triangles = mesh.mesh.triangles;
    primitive.colors = mesh.colors;
    if (!mesh.colors.empty()) {
        Material matte;
        matte.name = name;
        matte.double_sided = true;
        scene.materials.push_back(matte);
        primitive.material = 0;
    }
    scene.meshes.push_back({name, {std::move(primitive)}, {}});
    Node node;
    node.name = name;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

ColoredMesh decimated(const ColoredMesh& mesh, std::size_t triangles) {
    if (mesh.mesh.triangles.size() <= triangles) return mesh;
    // Triangles less twice the vertices: -4 for a ball, more with handles; collapses keep it.
    const auto excess = static_cast<std::ptrdiff_t>(mesh.mesh.triangles.size()) -
                        2 * static_cast<std::ptrdiff_t>(mesh.mesh.positions.size());
    const std::ptrdiff_t vertices = (static_cast<std::ptrdiff_t>(triangles) - excess) / 2;
    const geometry::Decimation kept = geometry::decimate(
        mesh.mesh, static_cast<std::size_t>(std::max<std::ptrdiff_t>(vertices, 4)));
    ColoredMesh out;
    out.mesh.triangles = kept.triangles;
    for (const std::uint32_t v : kept.vertices) {
        out.mesh.positions.push_back(mesh.mesh.positions[v]);
        if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[v]);
    }
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    return out;
}

} // namespace toile::assets
