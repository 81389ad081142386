// Scene to one .glb: nodes, meshes, skins, morph targets, materials, textures, animations.
#include "assets/formats.h"
#include "assets/skins.h"
#include "imaging/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <sstream>
#include <tiny_gltf.h>

namespace toile::assets {
namespace {

using tinygltf::Value;

template <int Rows>
std::vector<double> numbers(const Eigen::Matrix<float, Rows, 1>& v) {
    std::vector<double> result;
    for (int k = 0; k < Rows; ++k)
        result.push_back(static_cast<double>(v[k]));
    return result;
}

class Writer {
  public:
    Writer(const Scene& scene, const SaveOptions& options) : scene_(scene), options_(options) {
        model_.buffers.resize(1);
        find_compact();
    }

    std::vector<std::uint8_t> run() {
        model_.asset.version = "2.0";
        model_.asset.generator = "Toile";
        write_textures();
        write_materials();
        for (std::size_t i = 0; i < scene_.meshes.size(); ++i)
            write_mesh(scene_.meshes[i], i);
        for (const Skin& skin : scene_.skins)
            write_skin(skin);
        write_nodes();
        for (const Animation& animation : scene_.animations)
            write_animation(animation);
        write_extensions();
        if (model_.buffers[0].data.empty()) model_.buffers.clear();

        std::ostringstream stream;
        tinygltf::TinyGLTF writer;
        if (!writer.WriteGltfSceneToStream(&model_, stream, false, true))
            throw Error("a GLB cannot be written");
        const std::string text = stream.str();
        return {text.begin(), text.end()};
    }

  private:
    [[noreturn]] static void fail(const std::string& what) {
        throw Error("a scene cannot be written: " + what);
    }

    int add_view(const void* data, std::size_t size, int target) {
        auto& bytes = model_.buffers[0].data;
        bytes.resize((bytes.size() + 3) / 4 * 4, 0);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = bytes.size();
        view.byteLength = size;
        view.target = target;
        const auto* begin = static_cast<const std::uint8_t*>(data);
        bytes.insert(bytes.end(), begin, begin + size);
        model_.bufferViews.push_back(view);
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    // Two bytes an index where that will do (65535 itself is not allowed).
    int add_indices(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
        if (vertex_count > 65535)
            return add_accessor(triangles.data(), 3 * triangles.size(), 1,
                                TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, false);
        std::vector<std::uint16_t> narrow;
        narrow.reserve(3 * triangles.size());
        for (const Triangle& t : triangles)
            for (const std::uint32_t v : t)
                narrow.push_back(static_cast<std::uint16_t>(v));
        return add_accessor(narrow.data(), narrow.size(), 1, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                            TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, false);
    }

    // `components` numbers an element; bounds are written where glTF wants them.
    int add_accessor(const void* data, std::size_t count, int components, int component_type,
                     int type, int target, bool bounds) {
        const auto width = static_cast<std::size_t>(components);
        const std::size_t size = component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2 : 4;
        tinygltf::Accessor accessor;
        accessor.bufferView = add_view(data, count * width * size, target);
        accessor.componentType = component_type;
        accessor.count = count;
        accessor.type = type;
        if (component_type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
            const auto* values = static_cast<const float*>(data);
            for (std::size_t i = 0; i < count * width; ++i)
                if (!std::isfinite(values[i])) fail("a number is not finite");
            for (std::size_t k = 0; bounds && k < width; ++k) {
                float low = values[k];
                float high = values[k];
                for (std::size_t i = k; i < count * width; i += width) {
                    low = std::min(low, values[i]);
                    high = std::max(high, values[i]);
                }
                accessor.minValues.push_back(static_cast<double>(low));
                accessor.maxValues.push_back(static_cast<double>(high));
            }
        }
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int add_vectors(const std::vector<Vec3f>& values, bool bounds) {
        static_assert(sizeof(Vec3f) == 12);
        return add_accessor(values.data(), values.size(), 3, TINYGLTF_COMPONENT_TYPE_FLOAT,
                            TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, bounds);
    }

    void write_textures() {
        if (scene_.textures.empty()) return;
        tinygltf::Sampler sampler;
        sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
        sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        model_.samplers.push_back(sampler);
        for (const Texture& from : scene_.textures) {
            tinygltf::Image image;
            image.name = from.name;
            if (options_.textures_beside) {
                if (from.name.empty() || from.name.find('/') != std::string::npos)
                    fail("a texture's name is no name of a file");
                image.uri = from.name + ".png";
            } else {
                const std::vector<std::uint8_t> png = imaging::encode_png(from.image);
                image.mimeType = "image/png";
                image.bufferView = add_view(png.data(), png.size(), 0);
            }
            tinygltf::Texture texture;
            texture.sampler = 0;
            texture.source = static_cast<int>(model_.images.size());
            model_.images.push_back(std::move(image));
            model_.textures.push_back(texture);
        }
    }

    int texture(int index) const {
        if (index < kNone || index >= static_cast<int>(scene_.textures.size()))
            fail("a material names a texture that does not exist");
        return index;
    }

    void write_materials() {
        for (const Material& from : scene_.materials) {
            tinygltf::Material material;
            material.name = from.name;
            material.pbrMetallicRoughness.baseColorFactor = numbers<4>(from.base_color);
            material.pbrMetallicRoughness.metallicFactor = static_cast<double>(from.metallic);
            material.pbrMetallicRoughness.roughnessFactor = static_cast<double>(from.roughness);
            material.pbrMetallicRoughness.baseColorTexture.index = texture(from.base_color_texture);
            material.normalTexture.index = texture(from.normal_texture);
            material.normalTexture.scale = static_cast<double>(from.normal_scale);
            material.doubleSided = from.double_sided;
            if (!from.sheen_color.isZero(0.0f)) {
                Value::Array color;
                for (const double c : numbers<3>(from.sheen_color))
                    color.emplace_back(c);
                Value::Object sheen;
                sheen["sheenColorFactor"] = Value(color);
                sheen["sheenRoughnessFactor"] = Value(static_cast<double>(from.sheen_roughness));
                material.extensions["KHR_materials_sheen"] = Value(sheen);
                sheen_ = true;
            }
            model_.materials.push_back(std::move(material));
        }
    }

    void check_primitive(const Primitive& p, const std::string& who) const {
        const std::size_t count = p.positions.size();
        if (count == 0 || p.triangles.empty()) fail(who + " is empty");
        if ((!p.normals.empty() && p.normals.size() != count) ||
            (!p.texcoords.empty() && p.texcoords.size() != count) ||
            (!p.colors.empty() && p.colors.size() != count))
            fail(who + " does not have one normal, texture coordinate and colour per vertex");
        for (const Triangle& t : p.triangles)
            for (const std::uint32_t v : t)
                if (v >= count) fail(who + " has an index out of range");
        if (p.material < kNone || p.material >= static_cast<int>(scene_.materials.size()))
            fail(who + " names a material that does not exist");
        for (const MorphTarget& morph : p.morphs)
            if (morph.positions.size() != count ||
                (!morph.normals.empty() && morph.normals.size() != count))
                fail(who + ": morph target '" + morph.name +
                     "' does not have one offset per vertex");
    }

    void write_mesh(const Mesh& from, std::size_t index) {
        const std::string who =
            "mesh " + (from.name.empty() ? "#" + std::to_string(index) : "'" + from.name + "'");
        if (from.primitives.empty()) fail(who + " has no primitives");
        tinygltf::Mesh mesh;
        mesh.name = from.name;
        for (const Primitive& primitive : from.primitives) {
            check_primitive(primitive, who);
            if (primitive.morphs.size() != from.primitives.front().morphs.size())
                fail(who + ": its primitives differ in their morph targets");
            mesh.primitives.push_back(convert(primitive, compact_[index]));
        }
        if (!from.primitives.front().morphs.empty()) {
            Value::Array names;
            for (const MorphTarget& morph : from.primitives.front().morphs)
                names.emplace_back(morph.name);
            Value::Object extras;
            extras["targetNames"] = Value(names);
            mesh.extras = Value(extras);
            for (const float w : from.morph_weights)
                mesh.weights.push_back(static_cast<double>(w));
        }
        model_.meshes.push_back(std::move(mesh));
    }

    // Meshes that only nodes at the origin show, without skin and morphs.
    void find_compact() {
        compact_.assign(scene_.meshes.size(), options_.compact);
        for (std::size_t m = 0; m < scene_.meshes.size(); ++m)
            for (const Primitive& p : scene_.meshes[m].primitives) {
                if (!p.morphs.empty() || !p.joints.empty()) compact_[m] = false;
                for (const Vec3f& v : p.positions)
                    if (!((v - kMiddle).cwiseAbs().maxCoeff() < 1.0f)) compact_[m] = false;
            }
        for (const Node& node : scene_.nodes)
            if (node.mesh >= 0 && node.mesh < static_cast<int>(scene_.meshes.size()) &&
                (node.parent != kNone || !node.translation.isZero(0.0f) ||
                 node.scale != Vec3f::Ones() ||
                 node.rotation.coeffs() != Quatf::Identity().coeffs()))
                compact_[static_cast<std::size_t>(node.mesh)] = false;
    }

    // `width` numbers of a small type, padded to four bytes an element.
    template <typename T>
    int add_padded(const std::vector<std::array<T, 4>>& rows, int component_type, bool normalised,
                   const std::vector<double>& low, const std::vector<double>& high) {
        tinygltf::Accessor accessor;
        accessor.bufferView =
            add_view(rows.data(), rows.size() * sizeof(rows[0]), TINYGLTF_TARGET_ARRAY_BUFFER);
        model_.bufferViews.back().byteStride = sizeof(rows[0]);
        accessor.componentType = component_type;
        accessor.normalized = normalised;
        accessor.count = rows.size();
        accessor.type = TINYGLTF_TYPE_VEC3;
        accessor.minValues = low;
        accessor.maxValues = high;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int add_small_positions(const std::vector<Vec3f>& positions) {
        std::vector<std::array<std::int16_t, 4>> rows;
        rows.reserve(positions.size());
        std::vector<double> low(3, 1e9);
        std::vector<double> high(3, -1e9);
        for (const Vec3f& p : positions) {
            auto& row = rows.emplace_back();
            for (int k = 0; k < 3; ++k) {
                const float steps = std::round((p[k] - kMiddle[k]) / kStep);
                row[static_cast<std::size_t>(k)] =
                    static_cast<std::int16_t>(std::clamp(steps, -32767.0f, 32767.0f));
                const auto i = static_cast<std::size_t>(k);
                low[i] = std::min(low[i], static_cast<double>(row[i]));
                high[i] = std::max(high[i], static_cast<double>(row[i]));
            }
        }
        return add_padded(rows, TINYGLTF_COMPONENT_TYPE_SHORT, false, low, high);
    }

    int add_small_normals(const std::vector<Vec3f>& normals) {
        std::vector<std::array<std::int8_t, 4>> rows;
        rows.reserve(normals.size());
        for (const Vec3f& n : normals) {
            auto& row = rows.emplace_back();
            for (int k = 0; k < 3; ++k)
                row[static_cast<std::size_t>(k)] =
                    static_cast<std::int8_t>(std::lround(127.0f * n[k]));
        }
        return add_padded(rows, TINYGLTF_COMPONENT_TYPE_BYTE, true, {}, {});
    }

    // Linear light in 16 bits: 8 would step visibly in the dark.
    int add_colors(const std::vector<std::array<std::uint8_t, 4>>& colors) {
        std::array<std::uint16_t, 256> light{};
        for (std::size_t v = 0; v < light.size(); ++v)
            light[v] = static_cast<std::uint16_t>(
                std::lround(65535.0f * imaging::linear_from_srgb(static_cast<float>(v) / 255.0f)));
        std::vector<std::array<std::uint16_t, 4>> rows;
        rows.reserve(colors.size());
        for (const auto& c : colors)
            rows.push_back(
                {light[c[0]], light[c[1]], light[c[2]], static_cast<std::uint16_t>(257 * c[3])});
        const int out =
            add_accessor(rows.data(), rows.size(), 4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                         TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, false);
        model_.accessors.back().normalized = true;
        return out;
    }

    tinygltf::Primitive convert(const Primitive& from, bool compact) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = from.material;
        primitive.attributes["POSITION"] =
            compact ? add_small_positions(from.positions) : add_vectors(from.positions, true);
        if (!from.normals.empty())
            primitive.attributes["NORMAL"] = compact ? add_small_normals(unit(from.normals))
                                                     : add_vectors(unit(from.normals), false);
        if (!from.texcoords.empty())
            primitive.attributes["TEXCOORD_0"] = add_accessor(
                from.texcoords.data(), from.texcoords.size(), 2, TINYGLTF_COMPONENT_TYPE_FLOAT,
                TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER, false);
        if (!from.colors.empty()) primitive.attributes["COLOR_0"] = add_colors(from.colors);
        if (!from.joints.empty()) {
            primitive.attributes["JOINTS_0"] = add_accessor(
                from.joints.data(), from.joints.size(), 4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, false);
            primitive.attributes["WEIGHTS_0"] = add_accessor(
                from.weights.data(), from.weights.size(), 4, TINYGLTF_COMPONENT_TYPE_FLOAT,
                TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER, false);
        }
        primitive.indices = add_indices(from.triangles, from.positions.size());
        for (const MorphTarget& morph : from.morphs) {
            std::map<std::string, int> target;
            target["POSITION"] = add_vectors(morph.positions, true);
            if (!morph.normals.empty()) target["NORMAL"] = add_vectors(morph.normals, false);
            primitive.targets.push_back(std::move(target));
        }
        write_variants(from, primitive);
        return primitive;
    }

    // glTF wants unit normals, also where a vertex has none of its own.
    static std::vector<Vec3f> unit(std::vector<Vec3f> normals) {
        for (Vec3f& n : normals) {
            const float length = n.norm();
            if (!(length > 1e-12f))
                n = Vec3f::UnitY();
            else if (std::abs(length - 1.0f) > 1e-5f)
                n /= length;
        }
        return normals;
    }

    void write_variants(const Primitive& from, tinygltf::Primitive& primitive) {
        std::map<int, Value::Array> variants_of; // by material
        for (std::size_t v = 0; v < from.variant_materials.size(); ++v) {
            const int material = from.variant_materials[v];
            if (material == kNone) continue;
            if (material < 0 || material >= static_cast<int>(scene_.materials.size()) ||
                v >= scene_.variants.size())
                fail("a variant names a material that does not exist");
            variants_of[material].emplace_back(static_cast<int>(v));
        }
        if (variants_of.empty()) return;
        Value::Array mappings;
        for (const auto& [material, variants] : variants_of) {
            Value::Object mapping;
            mapping["material"] = Value(material);
            mapping["variants"] = Value(variants);
            mappings.emplace_back(mapping);
        }
        Value::Object extension;
        extension["mappings"] = Value(mappings);
        primitive.extensions["KHR_materials_variants"] = Value(extension);
    }

    void write_skin(const Skin& from) {
        tinygltf::Skin skin;
        skin.name = from.name;
        skin.joints = from.joints;
        std::vector<Eigen::Matrix4f> matrices = from.inverse_bind;
        for (Eigen::Matrix4f& m : matrices)
            m.row(3) = Eigen::RowVector4f(0, 0, 0, 1);
        skin.inverseBindMatrices =
            add_accessor(matrices.data(), matrices.size(), 16, TINYGLTF_COMPONENT_TYPE_FLOAT,
                         TINYGLTF_TYPE_MAT4, 0, false);
        model_.skins.push_back(std::move(skin));
    }

    void write_nodes() {
        tinygltf::Scene root;
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& from = scene_.nodes[i];
            tinygltf::Node node;
            node.name = from.name;
            node.mesh = from.mesh;
            node.skin = from.skin;
            if (node.mesh != kNone && compact_[static_cast<std::size_t>(node.mesh)]) {
                node.translation = numbers<3>(kMiddle);
                node.scale = std::vector<double>(3, static_cast<double>(kStep));
            }
            if (!from.translation.isZero(0.0f)) node.translation = numbers<3>(from.translation);
            if (from.scale != Vec3f::Ones()) node.scale = numbers<3>(from.scale);
            if (from.rotation.coeffs() != Quatf::Identity().coeffs())
                node.rotation = unit_rotation(from.rotation.coeffs());
            const bool bare = node.name.empty() && node.mesh == kNone && node.scale.empty() &&
                              node.translation.empty() && node.rotation.empty();
            if (bare) node.translation = {0.0, 0.0, 0.0}; // tinygltf writes a bare node as null
            if (from.parent == kNone)
                root.nodes.push_back(static_cast<int>(i));
            else
                model_.nodes[static_cast<std::size_t>(from.parent)].children.push_back(
                    static_cast<int>(i));
            model_.nodes.push_back(std::move(node));
        }
        if (root.nodes.empty()) return;
        model_.scenes.push_back(std::move(root));
        model_.defaultScene = 0;
    }

    static std::vector<double> unit_rotation(Vec4f q) {
        if (std::abs(q.norm() - 1.0f) > 1e-6f) q.normalize();
        return numbers<4>(q);
    }

    void write_animation(const Animation& from) {
        tinygltf::Animation animation;
        animation.name = from.name;
        for (const Channel& channel : from.channels) {
            if (channel.times.empty() || channel.values.size() != channel.times.size() ||
                channel.node < 0 || channel.node >= static_cast<int>(scene_.nodes.size()) ||
                channel.path == Channel::Path::invalid)
                fail("animation '" + from.name + "' has a channel without node, times or values");
            const bool rotation = channel.path == Channel::Path::rotation;
            std::vector<float> values;
            for (const Vec4f& v : channel.values)
                for (int k = 0; k < (rotation ? 4 : 3); ++k)
                    values.push_back(rotation ? v[k] / v.norm() : v[k]);
            tinygltf::AnimationSampler sampler;
            sampler.input =
                add_accessor(channel.times.data(), channel.times.size(), 1,
                             TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 0, true);
            sampler.output =
                add_accessor(values.data(), channel.values.size(), rotation ? 4 : 3,
                             TINYGLTF_COMPONENT_TYPE_FLOAT,
                             rotation ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, 0, false);
            tinygltf::AnimationChannel out;
            out.sampler = static_cast<int>(animation.samplers.size());
            out.target_node = channel.node;
            out.target_path = rotation                                     ? "rotation"
                              : channel.path == Channel::Path::translation ? "translation"
                                                                           : "scale";
            animation.samplers.push_back(std::move(sampler));
            animation.channels.push_back(std::move(out));
        }
        if (!animation.channels.empty()) model_.animations.push_back(std::move(animation));
    }

    void write_extensions() {
        if (sheen_) model_.extensionsUsed.emplace_back("KHR_materials_sheen");
        if (std::find(compact_.begin(), compact_.end(), true) != compact_.end()) {
            model_.extensionsUsed.emplace_back("KHR_mesh_quantization");
            model_.extensionsRequired.emplace_back("KHR_mesh_quantization");
        }
        if (scene_.variants.empty()) return;
        model_.extensionsUsed.emplace_back("KHR_materials_variants");
        Value::Array variants;
        for (const std::string& name : scene_.variants) {
            Value::Object variant;
            variant["name"] = Value(name);
            variants.emplace_back(variant);
        }
        Value::Object extension;
        extension["variants"] = Value(variants);
        model_.extensions["KHR_materials_variants"] = Value(extension);
    }

    static constexpr float kStep = 1.0f / 32768.0f; // metres, of compact positions
    inline static const Vec3f kMiddle{0.0f, 1.0f, 0.0f};

    const Scene& scene_;
    const SaveOptions& options_;
    std::vector<bool> compact_; // (meshes)
    tinygltf::Model model_;
    bool sheen_ = false;
};

} // namespace

std::vector<std::uint8_t> write_glb(const Scene& scene, const SaveOptions& options) {
    Scene checked = scene;
    check_skins(checked, "scene to be written");
    return Writer(checked, options).run();
}

} // namespace toile::assets
