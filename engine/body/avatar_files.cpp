#include "body/avatar_files.h"

#include "assets/files.h"
#include "core/error.h"
#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

namespace toile::body {
namespace {

constexpr float kSkinRoughness = 0.75f; // a matte mannequin

/// Metres to the hundredth of a millimetre, so that files stay short.
double rounded(double metres) {
    return std::round(metres * 1e5) / 1e5;
}

/// The layout with its vertices ordered by part, then as they stood.
geometry::SeamedLayout ordered_by_part(const BodyModel& model) {
    const auto& from = model.layout;
    std::vector<std::uint32_t> order(from.welded.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return model.parts[from.welded[a]] < model.parts[from.welded[b]];
    });
    geometry::SeamedLayout out;
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        place[order[i]] = i;
        out.welded.push_back(from.welded[order[i]]);
        if (!from.texcoords.empty()) out.texcoords.push_back(from.texcoords[order[i]]);
    }
    for (const auto& t : from.triangles)
        out.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    return out;
}

assets::Primitive make_primitive(const BodyModel& model, const geometry::SeamedLayout& layout) {
    assets::Primitive out;
    out.material = 0;
    out.texcoords = layout.texcoords;
    out.triangles = layout.triangles;
    for (const auto v : layout.welded) {
        out.positions.push_back(model.rest.positions[v]);
        out.normals.push_back(model.rest.normals[v]);
        out.joints.push_back(model.skin.joints[v]);
        out.weights.push_back(model.skin.weights[v]);
    }
    for (const auto& component : model.shape) {
        assets::MorphTarget target;
        target.name = component.name;
        for (const auto v : layout.welded)
            target.positions.push_back(component.vertex_offsets[v]);
        out.morphs.push_back(std::move(target));
    }
    return out;
}

assets::Scene make_scene(const BodyModel& model, const geometry::SeamedLayout& layout,
                         const imaging::Image& texture) {
    assets::Scene scene;
    assets::Skin skin;
    skin.name = model.id;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto joint = static_cast<Joint>(j);
        assets::Node node;
        node.name = joint_name(joint);
        if (const auto parent = joint_parent(joint)) node.parent = static_cast<int>(*parent);
        node.translation = model.skeleton.offset(joint);
        scene.nodes.push_back(node);
        skin.joints.push_back(static_cast<int>(j));
        Mat4f inverse_bind = Mat4f::Identity();
        inverse_bind.block<3, 1>(0, 3) = -model.skeleton.rest(joint);
        skin.inverse_bind.push_back(inverse_bind);
    }
    assets::Node body;
    body.name = model.id;
    body.mesh = 0;
    body.skin = 0;
    scene.nodes.push_back(body);
    scene.skins.push_back(std::move(skin));
    assets::Mesh mesh;
    mesh.name = model.id;
    mesh.primitives.push_back(make_primitive(model, layout));
    scene.meshes.push_back(std::move(mesh));
    assets::Material material;
    material.name = "mannequin";
    material.roughness = kSkinRoughness;
    if (!texture.empty()) {
        scene.textures.push_back({model.id, texture, false});
        material.base_color_texture = 0;
    }
    scene.materials.push_back(material);
    return scene;
}

nlohmann::ordered_json make_json(const BodyModel& model, const geometry::SeamedLayout& layout) {
    nlohmann::ordered_json json;
    json["schema"] = 1;
    json["id"] = model.id;
    json["version"] = model.version;
    json["name"] = model.name;
    json["licence"] = "CC0-1.0";
    json["model"] = model.id + ".glb";
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto joint = static_cast<Joint>(j);
        const Vec3f& p = model.skeleton.rest(joint);
        json["joints"][std::string(joint_name(joint))] = {rounded(p.x()), rounded(p.y()),
                                                          rounded(p.z())};
    }
    json["parts"] = nlohmann::ordered_json::array();
    for (std::size_t r = 0; r < layout.welded.size();) {
        const Part part = model.parts[layout.welded[r]];
        const std::size_t first = r;
        while (r < layout.welded.size() && model.parts[layout.welded[r]] == part)
            ++r;
        json["parts"].push_back({{"part", part_label(part)}, {"count", r - first}});
    }
    for (const auto& [name, vertex] : model.landmarks)
        json["landmarks"][name] =
            std::find(layout.welded.begin(), layout.welded.end(), vertex) - layout.welded.begin();
    for (const auto& [name, metres] : model.measurements)
        json["measurements"][name] = std::round(metres * 1e4) / 1e4;
    for (const auto& component : model.shape) {
        std::vector<double> offsets;
        for (const auto& o : component.joint_offsets)
            for (const float x : o)
                offsets.push_back(rounded(static_cast<double>(x)));
        json["shape"].push_back({{"name", component.name}, {"joint_offsets", offsets}});
    }
    return json;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw FileError(file.string(), "cannot be written");
}

} // namespace

void save_body_model(const BodyModel& model, const imaging::Image& texture,
                     const std::string& provenance, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const auto layout = ordered_by_part(model);
    assets::save_scene(make_scene(model, layout, texture), folder / (model.id + ".glb"));
    write_text(folder / "avatar.json", make_json(model, layout).dump(2) + "\n");
    write_text(folder / "PROVENANCE.md", provenance);
}

} // namespace toile::body
