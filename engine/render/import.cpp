#include "render/import.h"

#include "core/error.h"
#include "imaging/srgb.h"

#include <map>

namespace toile::render {
namespace {

Material material_of(const assets::Material& m) {
    Material out;
    out.base_color = m.base_color;
    out.normal_scale = m.normal_scale;
    out.roughness = m.roughness;
    out.sheen_color = m.sheen_color;
    out.sheen_roughness = m.sheen_roughness;
    out.double_sided = m.double_sided;
    return out;
}

// world_from_node, scales and all.
Eigen::Affine3f placement(const assets::Scene& scene, int node) {
    Eigen::Affine3f out = Eigen::Affine3f::Identity();
    for (int i = node; i != assets::kNone; i = scene.nodes[static_cast<std::size_t>(i)].parent) {
        const assets::Node& n = scene.nodes[static_cast<std::size_t>(i)];
        out = Eigen::Translation3f(n.translation) * n.rotation * Eigen::Scaling(n.scale) * out;
    }
    return out;
}

std::vector<Vec3f> linear_colors(const assets::Primitive& p) {
    std::vector<Vec3f> out;
    out.reserve(p.colors.size());
    const auto light = [](std::uint8_t v) {
        return imaging::linear_from_srgb(static_cast<float>(v) / 255.0f);
    };
    for (const auto& c : p.colors)
        out.emplace_back(light(c[0]), light(c[1]), light(c[2]));
    return out;
}

MeshId add_primitive(Renderer& renderer, const assets::Primitive& p, const Eigen::Affine3f& place,
                     Box& box) {
    std::vector<Vec3f> positions(p.positions.size());
    std::vector<Vec3f> normals(p.normals.size());
    const Mat3f turn = place.linear().inverse().transpose();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i] = place * p.positions[i];
        box.add(positions[i]);
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        normals[i] = (turn * p.normals[i]).normalized();
        if (!normals[i].allFinite()) normals[i] = Vec3f::UnitY();
    }
    // Without normals of its own a surface is smooth across its texture seams.
    geometry::SeamedLayout layout;
    MeshDescription d;
    d.texcoords = p.texcoords;
    d.triangles = p.triangles;
    const std::vector<Vec3f> colors = linear_colors(p);
    d.colors = colors;
    geometry::TriangleMesh welded;
    if (normals.empty()) {
        welded = geometry::weld(positions, p.triangles, p.texcoords, layout);
        d.source = layout.welded;
        d.positions = welded.positions;
    } else {
        d.positions = positions;
        d.normals = normals;
    }
    return renderer.add_mesh(d);
}

} // namespace

std::vector<MaterialId> add_materials(Renderer& renderer, const assets::Scene& scene) {
    std::map<int, TextureId> textures;
    const auto texture = [&](int index, bool linear) {
        if (index == assets::kNone) return TextureId::none;
        const auto i = static_cast<std::size_t>(index);
        if (i >= scene.textures.size()) {
            throw Error("material to draw: it names texture " + std::to_string(index) + " of " +
                        std::to_string(scene.textures.size()));
        }
        const auto known = textures.find(index);
        if (known != textures.end()) return known->second;
        const TextureId id = renderer.add_texture(scene.textures[i].image, linear);
        textures.emplace(index, id);
        return id;
    };
    std::vector<MaterialId> ids;
    for (const assets::Material& m : scene.materials) {
        Material out = material_of(m);
        out.base_color_texture = texture(m.base_color_texture, false);
        out.normal_texture = texture(m.normal_texture, true);
        ids.push_back(renderer.add_material(out));
    }
    return ids;
}

ImportedScene add_scene(Renderer& renderer, const assets::Scene& scene, const Material& fallback) {
    ImportedScene out;
    const std::vector<MaterialId> materials = add_materials(renderer, scene);
    const MaterialId plain = renderer.add_material(fallback);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        const assets::Node& node = scene.nodes[n];
        if (node.mesh == assets::kNone) continue;
        const Eigen::Affine3f place = node.skin == assets::kNone
                                          ? placement(scene, static_cast<int>(n))
                                          : Eigen::Affine3f::Identity();
        for (const auto& p : scene.meshes.at(static_cast<std::size_t>(node.mesh)).primitives) {
            Instance instance;
            instance.mesh = add_primitive(renderer, p, place, out.bounds);
            instance.material = p.material == assets::kNone
                                    ? plain
                                    : materials.at(static_cast<std::size_t>(p.material));
            out.instances.push_back(instance);
        }
    }
    if (out.instances.empty()) throw Error("3D file to draw: it has no triangle meshes");
    return out;
}

Material mannequin_material() {
    Material m;
    m.base_color = {0.52f, 0.47f, 0.425f, 1.0f};
    m.roughness = 0.72f;
    return m;
}

Material cloth_material(const Vec3f& color) {
    Material m;
    m.base_color = {color.x(), color.y(), color.z(), 1.0f};
    m.roughness = 0.95f;
    m.sheen_color = Vec3f::Constant(0.04f) + 0.25f * color;
    m.sheen_roughness = 0.55f;
    m.double_sided = true;
    return m;
}

} // namespace toile::render
