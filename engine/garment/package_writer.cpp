#include "assets/files.h"
#include "assets/zip.h"
#include "core/bytes.h"
#include "garment/package.h"
#include "garment/package_files.h"

#include <algorithm>
#include <map>
#include <set>

namespace toile::garment {
namespace fs = std::filesystem;
namespace {

/// The simulation mesh cut where its material coordinates differ. The first nv vertices are the
/// welded ones in order, so that welding on load gives them back with their indices.
assets::Primitive cut_primitive(const GarmentSize& size) {
    const auto& mesh = size.simulation;
    const std::size_t nv = mesh.positions.size();
    if (size.material_coords.size() != 3 * mesh.triangles.size())
        throw Error("size '" + size.entry.name + "': material coordinates must be one per corner");
    assets::Primitive out;
    out.positions = mesh.positions;
    out.texcoords.assign(nv, Vec2f::Zero());
    out.joints = size.skin.joints;
    out.weights = size.skin.weights;
    std::vector<bool> taken(nv, false);
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> cut;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.triangles[i][k];
            const Vec2f& m = size.material_coords[3 * i + k];
            auto next = static_cast<std::uint32_t>(out.positions.size());
            if (!taken[v]) next = v;
            const auto [at, added] = cut.try_emplace({v, m.x(), m.y()}, next);
            corners[k] = at->second;
            if (!added) continue;
            if (!taken[v]) {
                taken[v] = true;
                out.texcoords[v] = m;
                continue;
            }
            out.positions.push_back(mesh.positions[v]);
            out.texcoords.push_back(m);
            if (out.joints.empty()) continue;
            out.joints.push_back(size.skin.joints[v]);
            out.weights.push_back(size.skin.weights[v]);
        }
        out.triangles.push_back(corners);
    }
    out.normals.resize(out.positions.size());
    std::vector<Vec3f> normals(nv);
    geometry::vertex_normals(mesh.positions, mesh.triangles, normals);
    std::copy(normals.begin(), normals.end(), out.normals.begin());
    for (const auto& [key, vertex] : cut)
        out.normals[vertex] = normals[std::get<0>(key)];
    return out;
}

/// Joint nodes that carry the skin's names; the binder needs no more of them.
int add_joints(assets::Scene& scene) {
    assets::Skin skin;
    skin.name = "joints";
    for (std::size_t j = 0; j < body::kJointCount; ++j) {
        const auto joint = static_cast<body::Joint>(j);
        assets::Node node;
        node.name = body::joint_name(joint);
        if (const auto parent = body::joint_parent(joint))
            node.parent = skin.joints[static_cast<std::size_t>(*parent)];
        skin.joints.push_back(static_cast<int>(scene.nodes.size()));
        skin.inverse_bind.emplace_back(Eigen::Matrix4f::Identity());
        scene.nodes.push_back(std::move(node));
    }
    scene.skins.push_back(std::move(skin));
    return static_cast<int>(scene.skins.size()) - 1;
}

assets::Scene scene_of(const GarmentSize& size, const bool compact) {
    assets::Scene scene = size.render;
    const bool drawn_itself = scene.nodes.size() == 1 && scene.nodes.front().name == "simulation";
    assets::Primitive primitive = cut_primitive(size);
    if (drawn_itself) {
        primitive.material = scene.meshes.front().primitives.front().material;
        primitive.variant_materials = scene.meshes.front().primitives.front().variant_materials;
        scene.nodes.clear();
        scene.meshes.clear();
    } else if (compact) {
        primitive.normals.clear(); // it is not drawn
    }
    assets::Mesh mesh;
    mesh.name = "simulation";
    mesh.primitives.push_back(std::move(primitive));
    assets::Node node;
    node.name = "simulation";
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    if (!size.skin.joints.empty()) node.skin = add_joints(scene);
    scene.nodes.push_back(std::move(node));
    return scene;
}

} // namespace

void write_package(const GarmentPackage& package, const fs::path& folder, const bool compact) {
    std::error_code code;
    fs::create_directories(folder, code);
    GarmentPackage copy;
    copy.manifest = package.manifest;
    copy.manifest.sizes.clear();
    for (const GarmentSize& size : package.sizes) {
        SizeEntry entry = size.entry;
        entry.render.clear();
        if (fs::path(entry.mesh).extension() != ".glb")
            throw Error("size '" + entry.name + "': a package is written as .glb, not " +
                        entry.mesh);
        fs::create_directories((folder / entry.mesh).parent_path(), code);
        assets::save_scene(scene_of(size, compact), folder / entry.mesh, {compact, compact});
        copy.manifest.sizes.push_back(std::move(entry));
    }
    write_text(folder / "garment.json", write_manifest(copy.manifest));
}

void pack_package(const fs::path& folder, const fs::path& zip) {
    const auto package = load_package(folder);
    const PackageFiles files(folder, {});
    std::set<std::string> names = {"garment.json"};
    if (!package->manifest.thumbnail.empty()) names.insert(package->manifest.thumbnail);
    for (const GarmentSize& size : package->sizes)
        for (const std::string& mesh : {size.entry.mesh, size.entry.render}) {
            if (mesh.empty()) continue;
            names.insert(mesh);
            for (std::string& name : referenced_files(files, mesh))
                names.insert(std::move(name));
        }
    assets::ZipContents contents;
    for (const std::string& name : names)
        contents[name] =
            read_bytes(files.resolve(name, "garment.json"), PackageLimits().max_file_bytes);
    assets::write_zip(contents, zip);
}

} // namespace toile::garment
