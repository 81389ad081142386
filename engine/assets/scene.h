// What a 3D file holds, whatever its format: our own neutral form between importers and exporters.
#pragma once

#include "core/types.h"
#include "geometry/mesh.h"
#include "imaging/image.h"

#include <optional>
#include <string>
#include <vector>

namespace toile::assets {

inline constexpr int kNone = -1; ///< "no such index"

struct Texture {
    std::string name;
    imaging::Image image; ///< RGBA8, rows from the top
    bool linear = false;  ///< false: sRGB colours, true: data such as normals
};

/// glTF's metallic-roughness material, and KHR_materials_sheen.
struct Material {
    std::string name;
    Vec4f base_color = Vec4f::Ones(); ///< linear RGBA
    float metallic = 0.0f;
    float roughness = 0.8f;
    Vec3f sheen_color = Vec3f::Zero();
    float sheen_roughness = 0.5f;
    int base_color_texture = kNone; ///< into Scene::textures
    int normal_texture = kNone;
    float normal_scale = 1.0f;
    bool double_sided = false;
};

/// Displacements of a shape key.
struct MorphTarget {
    std::string name;
    std::vector<Vec3f> positions; ///< (nv) offsets
    std::vector<Vec3f> normals;   ///< (nv) offsets, or empty
};

/// One drawable: vertices as in the file (cut along seams).
struct Primitive {
    std::vector<Vec3f> positions;                    ///< (nv)
    std::vector<Vec3f> normals;                      ///< (nv), or empty
    std::vector<Vec2f> texcoords;                    ///< (nv), or empty; origin at the top left
    std::vector<std::array<std::uint8_t, 4>> colors; ///< (nv) sRGB, multiply the material; or empty
    std::vector<Triangle> triangles;
    std::vector<std::array<std::uint16_t, 4>> joints; ///< (nv) into the skin's joints, or empty
    std::vector<std::array<float, 4>> weights;        ///< (nv)
    std::vector<MorphTarget> morphs;
    std::vector<int> variant_materials; ///< per Scene::variants, kNone keeps `material`
    int material = kNone;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives; ///< all with the same morph targets
    std::vector<float> morph_weights;  ///< (targets) at rest, or empty for zeros
};

struct Skin {
    std::string name;
    std::vector<int> joints;                   ///< nodes
    std::vector<Eigen::Matrix4f> inverse_bind; ///< (joints)
};

struct Node {
    std::string name;
    int parent = kNone;
    Vec3f translation = Vec3f::Zero();
    Quatf rotation = Quatf::Identity();
    Vec3f scale = Vec3f::Ones();
    int mesh = kNone;
    int skin = kNone;
};

/// Keyframes of one property of one node, linearly interpolated.
struct Channel {
    enum class Path { invalid, translation, rotation, scale };
    int node = kNone;
    Path path = Path::invalid;
    std::vector<float> times;  ///< seconds, rising
    std::vector<Vec4f> values; ///< (times) x y z (w for rotations)
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
};

struct Scene {
    std::vector<Node> nodes; ///< parents before children
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Animation> animations;
    std::vector<std::string> variants; ///< KHR_materials_variants
};

} // namespace toile::assets
