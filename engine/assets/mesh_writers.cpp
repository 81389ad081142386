// OBJ and PLY: surfaces only, placed as their nodes stand; skinned meshes as they are bound.
#include "assets/formats.h"
#include "assets/skins.h"

#include <charconv>
#include <cstring>

namespace toile::assets {
namespace {

// All primitives of a scene in world coordinates, one after another.
struct Placed {
    const Primitive* primitive;
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
};

std::vector<Placed> place(const Scene& scene) {
    const std::vector<Eigen::Matrix4f> world = node_transforms(scene);
    std::vector<Placed> all;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.mesh == kNone) continue;
        const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(node.mesh));
        for (const Primitive& primitive : mesh.primitives) {
            Placed placed{&primitive, mesh.name, primitive.positions, primitive.normals};
            if (node.skin == kNone) {
                const Eigen::Affine3f m(world[i]);
                const Mat3f normal_matrix = m.linear().inverse().transpose();
                for (Vec3f& p : placed.positions)
                    p = m * p;
                for (Vec3f& n : placed.normals)
                    n = (normal_matrix * n).normalized();
            }
            for (const Vec3f& p : placed.positions)
                if (!p.allFinite())
                    throw Error("a scene cannot be written: a vertex is not finite");
            all.push_back(std::move(placed));
        }
    }
    if (all.empty()) throw Error("a scene cannot be written: no node has a mesh");
    return all;
}

// Shortest text that reads back to the same number.
void append(std::string& text, float value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    text += ' ';
    text.append(buffer, end);
}

template <typename T>
void append_bytes(std::vector<std::uint8_t>& bytes, const T& value) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(bytes.data() + at, &value, sizeof(T));
}

std::string material_name(const Scene& scene, int material) {
    const std::string& name = scene.materials.at(static_cast<std::size_t>(material)).name;
    return name.empty() ? "material" + std::to_string(material) : name;
}

} // namespace

std::string write_mtl(const Scene& scene) {
    std::string text = "# Toile\n";
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        text += "newmtl " + material_name(scene, static_cast<int>(i)) + "\nKd";
        for (int k = 0; k < 3; ++k)
            append(text, m.base_color[k]);
        text += '\n';
        if (m.base_color_texture == kNone) continue;
        const auto& name = scene.textures.at(static_cast<std::size_t>(m.base_color_texture)).name;
        if (name.empty() || name.find('/') != std::string::npos)
            throw Error("a scene cannot be written: a texture's name is no name of a file");
        text += "map_Kd " + name + ".png\n";
    }
    return text;
}

std::string write_obj(const Scene& scene, const std::string& library) {
    std::string text = "# Toile; metres\n";
    if (!library.empty()) text += "mtllib " + library + "\n";
    std::size_t base = 1;
    std::size_t uv_base = 1;
    std::size_t normal_base = 1;
    for (const Placed& placed : place(scene)) {
        const Primitive& p = *placed.primitive;
        text += "o " + (placed.name.empty() ? std::string("mesh") : placed.name) + "\n";
        if (!library.empty() && p.material != kNone)
            text += "usemtl " + material_name(scene, p.material) + "\n";
        for (const Vec3f& v : placed.positions) {
            text += 'v';
            for (int k = 0; k < 3; ++k)
                append(text, v[k]);
            text += '\n';
        }
        for (const Vec2f& uv : p.texcoords) { // OBJ counts v from the bottom
            text += "vt";
            append(text, uv.x());
            append(text, 1.0f - uv.y());
            text += '\n';
        }
        for (const Vec3f& n : placed.normals) {
            text += "vn";
            for (int k = 0; k < 3; ++k)
                append(text, n[k]);
            text += '\n';
        }
        for (const Triangle& t : p.triangles) {
            text += 'f';
            for (const std::uint32_t v : t) {
                text += ' ' + std::to_string(base + v);
                if (!p.texcoords.empty() || !placed.normals.empty()) text += '/';
                if (!p.texcoords.empty()) text += std::to_string(uv_base + v);
                if (!placed.normals.empty()) text += '/' + std::to_string(normal_base + v);
            }
            text += '\n';
        }
        base += placed.positions.size();
        uv_base += p.texcoords.size();
        normal_base += placed.normals.size();
    }
    return text;
}

std::vector<std::uint8_t> write_ply(const Scene& scene) {
    const std::vector<Placed> all = place(scene);
    std::size_t vertices = 0;
    std::size_t faces = 0;
    bool normals = true, colors = true;
    for (const Placed& placed : all) {
        vertices += placed.positions.size();
        faces += placed.primitive->triangles.size();
        normals = normals && placed.normals.size() == placed.positions.size();
        colors = colors && placed.primitive->colors.size() == placed.positions.size();
    }
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment Toile; metres\n";
    header += "element vertex " + std::to_string(vertices) + "\n";
    for (const char* name : {"x", "y", "z"})
        header += std::string("property float ") + name + "\n";
    if (normals)
        for (const char* name : {"nx", "ny", "nz"})
            header += std::string("property float ") + name + "\n";
    if (colors)
        for (const char* name : {"red", "green", "blue"})
            header += std::string("property uchar ") + name + "\n";
    header += "element face " + std::to_string(faces) + "\n";
    header += "property list uchar int vertex_indices\nend_header\n";

    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    for (const Placed& placed : all)
        for (std::size_t i = 0; i < placed.positions.size(); ++i) {
            for (int k = 0; k < 3; ++k)
                append_bytes(bytes, placed.positions[i][k]);
            for (int k = 0; normals && k < 3; ++k)
                append_bytes(bytes, placed.normals[i][k]);
            for (std::size_t k = 0; colors && k < 3; ++k)
                append_bytes(bytes, placed.primitive->colors[i][k]);
        }
    std::uint32_t base = 0;
    for (const Placed& placed : all) {
        for (const Triangle& t : placed.primitive->triangles) {
            append_bytes(bytes, std::uint8_t{3});
            for (const std::uint32_t v : t)
                append_bytes(bytes, static_cast<std::int32_t>(base + v));
        }
        base += static_cast<std::uint32_t>(placed.positions.size());
    }
    return bytes;
}

} // namespace toile::assets
