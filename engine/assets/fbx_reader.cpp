// FBX by assimp; what assimp drops or leaves to us (units, axes, joints that skin nothing,
// rigid vertices) is put right here.
#include "assets/formats.h"
#include "assets/gltf_parts.h"
#include "assets/skins.h"
#include "core/bytes.h"
#include "core/log.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>
#include <map>
#include <set>

namespace toile::assets {
namespace {

Vec3f vec(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

Eigen::Matrix4f matrix(const aiMatrix4x4& m) {
    Eigen::Matrix4f result;
    for (unsigned i = 0; i < 4; ++i)
        for (unsigned k = 0; k < 4; ++k)
            result(i, k) = static_cast<float>(m[i][k]);
    return result;
}

class FbxConverter {
  public:
    FbxConverter(const aiScene& source, std::filesystem::path file, Budget& budget, float scale)
        : source_(source), file_(std::move(file)), budget_(budget), scale_(scale) {}

    Scene run() {
        add_nodes(*source_.mRootNode, kNone, 0);
        for (unsigned i = 0; i < source_.mNumMaterials; ++i)
            add_material(*source_.mMaterials[i]);
        const std::size_t count = scene_.nodes.size();
        for (std::size_t i = 0; i < count; ++i)
            add_mesh(i);
        for (unsigned i = 0; i < source_.mNumAnimations; ++i)
            add_animation(*source_.mAnimations[i]);
        return std::move(scene_);
    }

  private:
    void add_nodes(const aiNode& from, int parent, int depth) {
        if (depth > 512) throw budget_.error("its nodes are nested more than 512 deep");
        const int index = static_cast<int>(scene_.nodes.size());
        Node node;
        node.name = from.mName.C_Str();
        node.parent = parent;
        const Eigen::Matrix4f m = matrix(from.mTransformation);
        if (!m.allFinite())
            throw budget_.error("node '" + node.name + "' has a transform that is not finite");
        decompose(Eigen::Affine3d(m.cast<double>()), node);
        node.translation *= scale_;
        scene_.nodes.push_back(node);
        sources_.push_back(&from);
        node_of_.emplace(node.name, index);
        for (unsigned i = 0; i < from.mNumChildren; ++i)
            add_nodes(*from.mChildren[i], index, depth + 1);
    }

    void add_material(const aiMaterial& from) {
        Material material;
        aiString name;
        if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
        aiColor4D color;
        if (from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
            material.base_color = Vec4f(color.r, color.g, color.b, 1.0f);
            if (!material.base_color.allFinite())
                throw budget_.error("material '" + material.name + "' is not finite");
        }
        aiString texture;
        if (from.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS)
            material.base_color_texture = add_texture(texture.C_Str(), false);
        if (from.GetTexture(aiTextureType_NORMALS, 0, &texture) == aiReturn_SUCCESS)
            material.normal_texture = add_texture(texture.C_Str(), true);
        scene_.materials.push_back(std::move(material));
    }

    // Embedded, else beside the file: the folders in FBX files are those of their maker's machine.
    int add_texture(const std::string& path, bool linear) {
        const auto [it, fresh] =
            texture_of_.try_emplace({path, linear}, static_cast<int>(scene_.textures.size()));
        if (!fresh) return it->second;
        const int side = static_cast<int>(budget_.limits().max_texture_side);
        const std::string name = path.substr(path.find_last_of("/\\") + 1);
        imaging::Image image;
        const aiTexture* embedded = source_.GetEmbeddedTexture(path.c_str());
        if (embedded != nullptr && embedded->mHeight == 0) {
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
            image = imaging::decode_image({bytes, embedded->mWidth}, budget_.file() + ": " + name,
                                          side);
        } else {
            const std::filesystem::path picture = file_.parent_path() / name;
            if (name.empty() || name == ".." || !std::filesystem::exists(picture))
                throw budget_.error("the texture '" + name + "' is missing beside it");
            image = imaging::load_image(picture, side);
        }
        budget_.take(image.pixels.size(), 1, name);
        scene_.textures.push_back({name, std::move(image), linear});
        return it->second;
    }

    void add_mesh(std::size_t index) {
        const aiNode& node = *sources_[index];
        if (node.mNumMeshes == 0) return;
        Mesh mesh;
        mesh.name = scene_.nodes[index].name;
        Skin skin;
        skin.name = mesh.name;
        std::map<int, std::size_t> joint_of; // node -> joint
        for (unsigned i = 0; i < node.mNumMeshes; ++i)
            collect_joints(*source_.mMeshes[node.mMeshes[i]], skin, joint_of);
        if (!skin.joints.empty()) add_idle_joints(skin, joint_of);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            const aiMesh& from = *source_.mMeshes[node.mMeshes[i]];
            Primitive primitive = convert(from, mesh.name);
            if (primitive.triangles.empty()) continue;
            if (!skin.joints.empty())
                add_weights(from, static_cast<int>(index), skin, joint_of, primitive);
            mesh.primitives.push_back(std::move(primitive));
        }
        if (mesh.primitives.empty()) return;
        for (const Primitive& primitive : mesh.primitives)
            if (primitive.morphs.size() != mesh.primitives.front().morphs.size())
                throw budget_.error("mesh '" + mesh.name +
                                    "': its parts differ in their shape keys");
        scene_.nodes[index].mesh = static_cast<int>(scene_.meshes.size());
        scene_.meshes.push_back(std::move(mesh));
        if (skin.joints.empty()) return;
        scene_.nodes[index].skin = static_cast<int>(scene_.skins.size());
        scene_.skins.push_back(std::move(skin));
    }

    Primitive convert(const aiMesh& from, const std::string& mesh) {
        const std::string who = "mesh '" + mesh + "'";
        budget_.add_mesh(from.mNumVertices, from.mNumFaces, who);
        Primitive primitive;
        for (unsigned v = 0; v < from.mNumVertices; ++v) {
            primitive.positions.push_back(scale_ * vec(from.mVertices[v]));
            if (!primitive.positions.back().allFinite())
                throw budget_.error(who + ": vertex " + std::to_string(v) + " is not finite");
            if (from.HasNormals()) primitive.normals.push_back(vec(from.mNormals[v]));
            if (from.HasTextureCoords(0)) // assimp counts v from the bottom
                primitive.texcoords.emplace_back(from.mTextureCoords[0][v].x,
                                                 1.0f - from.mTextureCoords[0][v].y);
        }
        std::size_t left_out = 0;
        for (unsigned f = 0; f < from.mNumFaces; ++f) {
            const aiFace& face = from.mFaces[f];
            if (face.mNumIndices != 3) {
                ++left_out;
                continue;
            }
            const Triangle t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
            for (const std::uint32_t v : t)
                if (v >= from.mNumVertices)
                    throw budget_.error(who + ": index " + std::to_string(v) +
                                        " is out of range (it has " +
                                        std::to_string(from.mNumVertices) + " vertices)");
            primitive.triangles.push_back(t);
        }
        if (left_out > 0)
            log::warning(budget_.file() + ": " + who + ": " + std::to_string(left_out) +
                         " points or lines are left out");
        primitive.material = static_cast<int>(from.mMaterialIndex);
        for (unsigned m = 0; m < from.mNumAnimMeshes; ++m)
            primitive.morphs.push_back(morph(from, *from.mAnimMeshes[m], who));
        return primitive;
    }

    MorphTarget morph(const aiMesh& base, const aiAnimMesh& from, const std::string& who) {
        if (from.mNumVertices != base.mNumVertices || !from.HasPositions())
            throw budget_.error(who + ": a shape key does not fit its mesh");
        budget_.take(base.mNumVertices, sizeof(Vec3f), who);
        MorphTarget morph;
        morph.name = from.mName.C_Str();
        for (unsigned v = 0; v < base.mNumVertices; ++v)
            morph.positions.push_back(scale_ * vec(from.mVertices[v] - base.mVertices[v]));
        return morph;
    }

    int bone_node(const aiBone& bone) const {
        const auto it = node_of_.find(bone.mName.C_Str());
        if (it == node_of_.end())
            throw budget_.error(std::string("the joint '") + bone.mName.C_Str() +
                                "' has no node in the file");
        return it->second;
    }

    void collect_joints(const aiMesh& from, Skin& skin, std::map<int, std::size_t>& joint_of) {
        for (unsigned b = 0; b < from.mNumBones; ++b) {
            const aiBone& bone = *from.mBones[b];
            const int node = bone_node(bone);
            if (!joint_of.try_emplace(node, skin.joints.size()).second) continue;
            Eigen::Matrix4f inverse_bind = matrix(bone.mOffsetMatrix);
            inverse_bind.topRightCorner<3, 1>() *= scale_;
            skin.joints.push_back(node);
            skin.inverse_bind.push_back(inverse_bind);
        }
    }

    // Assimp forgets joints that skin nothing. Those between and below the skinning ones come back
    // with the bind pose that their rest transform gives them relative to the skinning joint.
    void add_idle_joints(Skin& skin, std::map<int, std::size_t>& joint_of) const {
        const std::vector<Eigen::Matrix4f> world = node_transforms(scene_);
        std::vector<int> nearest(scene_.nodes.size(), kNone); // joint at or above each node
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            const auto it = joint_of.find(static_cast<int>(i));
            const int parent = scene_.nodes[i].parent;
            nearest[i] = it != joint_of.end() ? static_cast<int>(it->second)
                         : parent == kNone    ? kNone
                                              : nearest[static_cast<std::size_t>(parent)];
        }
        const std::size_t skinning = skin.joints.size();
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (nearest[i] == kNone || joint_of.contains(static_cast<int>(i)) ||
                sources_[i]->mNumMeshes > 0)
                continue;
            const auto joint = static_cast<std::size_t>(nearest[i]);
            const Eigen::Matrix4f& ancestor = world[static_cast<std::size_t>(skin.joints[joint])];
            joint_of.emplace(static_cast<int>(i), skin.joints.size());
            skin.joints.push_back(static_cast<int>(i));
            skin.inverse_bind.push_back(world[i].inverse() * ancestor * skin.inverse_bind[joint]);
        }
        if (skin.joints.size() > skinning)
            log::debug(budget_.file() + ": skin '" + skin.name +
                       "': " + std::to_string(skin.joints.size() - skinning) +
                       " joints that skin nothing keep their bind pose");
    }

    void add_weights(const aiMesh& from, int node, Skin& skin, std::map<int, std::size_t>& joint_of,
                     Primitive& primitive) {
        std::vector<std::vector<Influence>> rows(from.mNumVertices);
        for (unsigned b = 0; b < from.mNumBones; ++b) {
            const aiBone& bone = *from.mBones[b];
            const std::size_t joint = joint_of.at(bone_node(bone));
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                const aiVertexWeight& weight = bone.mWeights[w];
                if (weight.mVertexId >= from.mNumVertices)
                    throw budget_.error("the joint '" + std::string(bone.mName.C_Str()) +
                                        "' skins a vertex that does not exist");
                if (weight.mWeight != 0.0f)
                    rows[weight.mVertexId].push_back(
                        {static_cast<std::uint16_t>(joint), weight.mWeight});
            }
        }
        primitive.joints.resize(rows.size());
        primitive.weights.resize(rows.size());
        for (std::size_t v = 0; v < rows.size(); ++v) {
            // FBX: a vertex in no cluster moves with its node.
            if (rows[v].empty()) rows[v].push_back({own_joint(node, skin, joint_of), 1.0f});
            keep_four(rows[v], primitive.joints[v], primitive.weights[v]);
        }
    }

    std::uint16_t own_joint(int node, Skin& skin, std::map<int, std::size_t>& joint_of) const {
        const auto [it, fresh] = joint_of.try_emplace(node, skin.joints.size());
        if (fresh) {
            skin.joints.push_back(node);
            skin.inverse_bind.emplace_back(Eigen::Matrix4f::Identity());
        }
        return static_cast<std::uint16_t>(it->second);
    }

    void add_animation(const aiAnimation& from) {
        Animation animation;
        animation.name = from.mName.C_Str();
        const double per_second = from.mTicksPerSecond > 0.0 ? from.mTicksPerSecond : 25.0;
        for (unsigned c = 0; c < from.mNumChannels; ++c) {
            const aiNodeAnim& curve = *from.mChannels[c];
            const auto node = node_of_.find(curve.mNodeName.C_Str());
            if (node == node_of_.end())
                throw budget_.error("animation '" + animation.name + "' moves the node '" +
                                    curve.mNodeName.C_Str() + "', which does not exist");
            const auto add = [&](Channel::Path path, unsigned count, const auto* keys,
                                 const auto& value) {
                Channel channel{node->second, path, {}, {}};
                for (unsigned k = 0; k < count; ++k) {
                    const auto time = static_cast<float>(keys[k].mTime / per_second);
                    const Vec4f v = value(keys[k].mValue);
                    if (!std::isfinite(time) || !v.allFinite())
                        throw budget_.error("animation '" + animation.name + "' is not finite");
                    if (!channel.times.empty() && time <= channel.times.back()) continue;
                    channel.times.push_back(time);
                    channel.values.push_back(v);
                }
                if (!channel.times.empty()) animation.channels.push_back(std::move(channel));
            };
            add(Channel::Path::translation, curve.mNumPositionKeys, curve.mPositionKeys,
                [this](const aiVector3D& v) -> Vec4f {
                    return {scale_ * v.x, scale_ * v.y, scale_ * v.z, 0.0f};
                });
            add(Channel::Path::rotation, curve.mNumRotationKeys, curve.mRotationKeys,
                [](const aiQuaternion& q) -> Vec4f {
                    return Vec4f(q.x, q.y, q.z, q.w).normalized();
                });
            add(Channel::Path::scale, curve.mNumScalingKeys, curve.mScalingKeys,
                [](const aiVector3D& v) -> Vec4f {
                    return {v.x, v.y, v.z, 0.0f};
                });
        }
        if (!animation.channels.empty()) scene_.animations.push_back(std::move(animation));
    }

    const aiScene& source_;
    std::filesystem::path file_;
    Budget& budget_;
    float scale_; // metres per unit of the file
    Scene scene_;
    std::vector<const aiNode*> sources_; // by node of the scene
    std::map<std::string, int> node_of_;
    std::map<std::pair<std::string, bool>, int> texture_of_;
};

std::string first_line(std::string text) {
    text.erase(std::min(text.find('\n'), text.size()));
    return text;
}

// FBX counts in units of UnitScaleFactor centimetres.
float metres_per_unit(const aiScene& scene, const Budget& budget) {
    double centimetres = 1.0;
    float single = 1.0f;
    if (scene.mMetaData == nullptr) return 0.01f;
    if (!scene.mMetaData->Get("UnitScaleFactor", centimetres) &&
        scene.mMetaData->Get("UnitScaleFactor", single))
        centimetres = static_cast<double>(single);
    if (!(centimetres > 1e-6 && centimetres < 1e6))
        throw budget.error("its unit scale factor " + std::to_string(centimetres) +
                           " makes no sense");
    return static_cast<float>(centimetres / 100.0);
}

} // namespace

Scene read_fbx(const std::filesystem::path& file, Budget& budget) {
    const std::vector<std::uint8_t> bytes = read_bytes(file, budget.limits().max_file_bytes);
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
    const aiScene* scene = importer.ReadFileFromMemory(
        bytes.data(), bytes.size(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, "fbx");
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw budget.error("cannot be read: " + first_line(importer.GetErrorString()));
    Scene result = FbxConverter(*scene, file, budget, metres_per_unit(*scene, budget)).run();
    if (result.meshes.empty()) throw budget.error("holds no triangles");
    return result;
}

} // namespace toile::assets
