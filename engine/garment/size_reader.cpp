#include "garment/size_reader.h"

#include "assets/files.h"
#include "garment/manifest_reader.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace toile::garment {
namespace {

constexpr std::string_view kSimulationName = "simulation";

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The simulation mesh's node and the render meshes' nodes; a file with one mesh has it as both.
struct Roles {
    std::vector<std::size_t> simulation;
    std::vector<std::size_t> render;
};

Roles find_roles(const assets::Scene& scene, const std::string& shown) {
    Roles roles;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == assets::kNone) continue;
        (is_simulation(scene, scene.nodes[i]) ? roles.simulation : roles.render).push_back(i);
    }
    if (roles.simulation.empty() && roles.render.size() == 1)
        std::swap(roles.simulation, roles.render);
    if (roles.simulation.size() == 1) return roles;
    const std::string what =
        roles.simulation.size() > 1 ? "has several meshes named 'simulation'; keep one"
        : roles.render.empty()
            ? "has no mesh"
            : "has " + std::to_string(roles.render.size()) +
                  " meshes and none is named 'simulation'; name the one to simulate so";
    throw PackageError({FaultCode::no_simulation, shown + ": " + what});
}

/// All primitives of the simulation mesh as one list of triangles.
struct Soup {
    std::vector<Vec3f> positions;
    std::vector<Vec2f> texcoords;
    std::vector<Triangle> triangles;
    body::SkinWeights skin; ///< in the file's joints until mapped
};

Soup join_primitives(const assets::Mesh& mesh, const std::string& shown) {
    Soup soup;
    bool skinned = true;
    for (const assets::Primitive& p : mesh.primitives) {
        const auto base = static_cast<std::uint32_t>(soup.positions.size());
        if (p.texcoords.size() != p.positions.size() && !p.positions.empty())
            throw PackageError({FaultCode::material_coords,
                                shown + ": the simulation mesh has no texture coordinates, which "
                                        "hold its material coordinates in metres; `toile garment "
                                        "new` makes them"});
        soup.positions.insert(soup.positions.end(), p.positions.begin(), p.positions.end());
        soup.texcoords.insert(soup.texcoords.end(), p.texcoords.begin(), p.texcoords.end());
        for (const Triangle& t : p.triangles)
            soup.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        skinned = skinned && p.joints.size() == p.positions.size() && !p.positions.empty();
        if (!skinned) continue;
        soup.skin.joints.insert(soup.skin.joints.end(), p.joints.begin(), p.joints.end());
        soup.skin.weights.insert(soup.skin.weights.end(), p.weights.begin(), p.weights.end());
    }
    if (!skinned) soup.skin = {};
    if (soup.triangles.empty())
        throw PackageError({FaultCode::mesh, shown + ": the simulation mesh is empty"});
    return soup;
}

/// For each joint of the skin our joint: by VRM name, else that of the nearest named ancestor.
std::vector<std::optional<body::Joint>> map_joints(const assets::Scene& scene,
                                                   const assets::Skin& skin) {
    std::vector<std::optional<body::Joint>> out;
    for (const int joint : skin.joints) {
        std::optional<body::Joint> found;
        for (int node = joint; node != assets::kNone && !found;
             node = scene.nodes[static_cast<std::size_t>(node)].parent)
            found = body::joint_from_name(scene.nodes[static_cast<std::size_t>(node)].name);
        out.push_back(found);
    }
    return out;
}

/// The file's skin in our joints; empty with a note when its joints have other names.
body::SkinWeights map_skin(const assets::Scene& scene, const assets::Node& node, Soup& soup,
                           const std::string& shown, std::vector<std::string>& notes) {
    if (node.skin == assets::kNone || soup.skin.joints.empty()) return {};
    const auto map = map_joints(scene, scene.skins[static_cast<std::size_t>(node.skin)]);
    body::SkinWeights out = std::move(soup.skin);
    for (std::size_t v = 0; v < out.joints.size(); ++v)
        for (std::size_t k = 0; k < 4; ++k) {
            if (out.weights[v][k] <= 0.0f) {
                out.joints[v][k] = 0;
                continue;
            }
            const auto joint = map.at(out.joints[v][k]);
            if (!joint) {
                notes.push_back(shown + ": its skin has joints without VRM names and is not used");
                return {};
            }
            out.joints[v][k] = static_cast<std::uint16_t>(*joint);
        }
    return out;
}

void weld_simulation(Soup& soup, body::SkinWeights skin, GarmentSize& size) {
    geometry::SeamedLayout seams;
    size.simulation = geometry::weld(soup.positions, soup.triangles, soup.texcoords, seams);
    size.material_coords.clear();
    for (const Triangle& t : soup.triangles)
        for (const std::uint32_t corner : t)
            size.material_coords.push_back(soup.texcoords[corner]);
    if (skin.joints.empty()) return;
    size.skin.joints.resize(size.simulation.positions.size());
    size.skin.weights.resize(size.simulation.positions.size());
    for (std::size_t i = seams.welded.size(); i-- > 0;) { // the first of equal vertices counts
        size.skin.joints[seams.welded[i]] = skin.joints[i];
        size.skin.weights[seams.welded[i]] = skin.weights[i];
    }
}

int shifted(int index, std::size_t by) {
    return index == assets::kNone ? index : index + static_cast<int>(by);
}

/// Adds `mesh` and what it needs of `from` to `to`; materials of `from` stand at `first_material`.
void append_mesh(assets::Mesh mesh, const std::string& name, const assets::Scene& from,
                 std::size_t first_material, assets::Scene& to) {
    mesh.name = name;
    for (assets::Primitive& p : mesh.primitives) {
        p.joints.clear();
        p.weights.clear();
        p.material = shifted(p.material, first_material);
        const std::vector<int> variants = std::move(p.variant_materials);
        p.variant_materials.assign(to.variants.size(), assets::kNone);
        for (std::size_t i = 0; i < variants.size(); ++i) {
            const auto at = std::find(to.variants.begin(), to.variants.end(), from.variants[i]);
            p.variant_materials[static_cast<std::size_t>(at - to.variants.begin())] =
                shifted(variants[i], first_material);
        }
    }
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(to.meshes.size());
    to.nodes.push_back(std::move(node));
    to.meshes.push_back(std::move(mesh));
}

std::size_t append_materials(const assets::Scene& from, assets::Scene& to) {
    const std::size_t first = to.materials.size();
    for (assets::Material m : from.materials) {
        m.base_color_texture = shifted(m.base_color_texture, to.textures.size());
        m.normal_texture = shifted(m.normal_texture, to.textures.size());
        to.materials.push_back(std::move(m));
    }
    to.textures.insert(to.textures.end(), from.textures.begin(), from.textures.end());
    for (const std::string& variant : from.variants)
        if (std::find(to.variants.begin(), to.variants.end(), variant) == to.variants.end())
            to.variants.push_back(variant);
    for (assets::Mesh& mesh : to.meshes)
        for (assets::Primitive& p : mesh.primitives)
            p.variant_materials.resize(to.variants.size(), assets::kNone);
    return first;
}

assets::Scene load_checked(const PackageFiles& files, const std::string& mesh) {
    static const std::set<std::string> kKnown = {".glb", ".fbx", ".obj"};
    const auto file = files.resolve(mesh, "garment.json");
    if (!kKnown.contains(file.extension().string()))
        throw PackageError(
            {FaultCode::mesh_file, files.shown(mesh) + ": a mesh must be .glb, .fbx or .obj"});
    static_cast<void>(referenced_files(files, mesh));
    return assets::load_scene(file);
}

} // namespace

bool is_simulation(const assets::Scene& scene, const assets::Node& node) {
    if (node.mesh == assets::kNone) return false;
    return lower(node.name) == kSimulationName ||
           lower(scene.meshes[static_cast<std::size_t>(node.mesh)].name) == kSimulationName;
}

std::vector<Eigen::Affine3f> world_from_node(const assets::Scene& scene) {
    std::vector<Eigen::Affine3f> world;
    for (const assets::Node& node : scene.nodes) {
        Eigen::Affine3f local = Eigen::Affine3f::Identity();
        local.translate(node.translation).rotate(node.rotation).scale(node.scale);
        world.push_back(node.parent == assets::kNone
                            ? local
                            : world[static_cast<std::size_t>(node.parent)] * local);
    }
    return world;
}

assets::Mesh baked_mesh(const assets::Scene& scene, std::size_t node,
                        const Eigen::Affine3f& world) {
    assets::Mesh mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[node].mesh)];
    const bool skinned = scene.nodes[node].skin != assets::kNone;
    const bool moved = !skinned && !world.matrix().isIdentity(0.0f);
    const Mat3f for_normals =
        moved ? Mat3f(world.linear().inverse().transpose()) : Mat3f(Mat3f::Identity());
    for (assets::Primitive& p : mesh.primitives) {
        p.morphs.clear();
        if (!moved) continue;
        for (Vec3f& x : p.positions)
            x = world * x;
        for (Vec3f& n : p.normals)
            n = (for_normals * n).normalized();
        if (world.linear().determinant() < 0.0f)
            for (Triangle& t : p.triangles)
                std::swap(t[1], t[2]);
    }
    return mesh;
}

void append_nodes(const assets::Scene& scene, const std::vector<std::size_t>& nodes,
                  assets::Scene& to) {
    const auto world = world_from_node(scene);
    const std::size_t first = append_materials(scene, to);
    for (const std::size_t i : nodes) {
        const std::string& name = scene.nodes[i].name;
        append_mesh(baked_mesh(scene, i, world[i]), name, scene, first, to);
    }
}

std::vector<std::size_t> nodes_with_meshes(const assets::Scene& scene) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].mesh != assets::kNone) out.push_back(i);
    return out;
}

bool read_size_meshes(const PackageFiles& files, const SizeEntry& entry, GarmentSize& size,
                      Faults& faults, std::vector<std::string>& notes) {
    size.entry = entry;
    const bool simulation = attempt(faults, FaultCode::mesh_file, [&] {
        const std::string shown = files.shown(entry.mesh);
        const assets::Scene scene = load_checked(files, entry.mesh);
        const Roles roles = find_roles(scene, shown);
        const std::size_t node = roles.simulation.front();
        const assets::Mesh mesh = baked_mesh(scene, node, world_from_node(scene)[node]);
        Soup soup = join_primitives(mesh, shown);
        weld_simulation(soup, map_skin(scene, scene.nodes[node], soup, shown, notes), size);
        const bool drawn_itself = roles.render.empty() && entry.render.empty();
        append_nodes(scene, drawn_itself ? roles.simulation : roles.render, size.render);
    });
    if (entry.render.empty()) return simulation;
    const bool render = attempt(faults, FaultCode::mesh_file, [&] {
        const assets::Scene scene = load_checked(files, entry.render);
        append_nodes(scene, nodes_with_meshes(scene), size.render);
    });
    return simulation && render;
}

} // namespace toile::garment
