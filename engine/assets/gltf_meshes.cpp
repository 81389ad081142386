#include "assets/gltf_parts.h"
#include "assets/skins.h"
#include "core/log.h"
#include "imaging/srgb.h"

#include <algorithm>
#include <cmath>

namespace toile::assets {
namespace {

std::vector<Vec3f> vectors3(const std::vector<float>& values) {
    std::vector<Vec3f> result(values.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = Vec3f(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    return result;
}

class PrimitiveReader {
  public:
    PrimitiveReader(const Scene& scene, AccessorReader& accessors, Budget& budget,
                    std::string where)
        : scene_(scene), accessors_(accessors), budget_(budget), where_(std::move(where)) {}

    Primitive run(const tinygltf::Primitive& from) {
        const auto position = from.attributes.find("POSITION");
        if (position == from.attributes.end()) throw budget_.error(where_ + " has no POSITION");
        const std::size_t vertices = accessors_.count(position->second, where_ + ", POSITION");
        const std::size_t corners =
            from.indices == kNone ? vertices : accessors_.count(from.indices, where_ + ", indices");
        budget_.add_mesh(vertices, from.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners,
                         where_);

        Primitive primitive;
        primitive.positions = vectors3(floats(from, "POSITION", 3, vertices));
        read_triangles(from, primitive);
        if (from.attributes.contains("NORMAL"))
            primitive.normals = vectors3(floats(from, "NORMAL", 3, vertices));
        if (from.attributes.contains("TEXCOORD_0")) {
            const std::vector<float> uv = floats(from, "TEXCOORD_0", 2, vertices);
            for (std::size_t i = 0; i < vertices; ++i)
                primitive.texcoords.emplace_back(uv[2 * i], uv[2 * i + 1]);
        }
        read_colors(from, primitive);
        read_influences(from, primitive);
        if (from.material != kNone &&
            (from.material < 0 ||
             static_cast<std::size_t>(from.material) >= scene_.materials.size()))
            throw budget_.error(where_ + " names a material that does not exist");
        primitive.material = from.material;
        read_variants(from, primitive);
        return primitive;
    }

    void read_morphs(const tinygltf::Primitive& from, const std::vector<std::string>& names,
                     Primitive& primitive) {
        for (std::size_t t = 0; t < from.targets.size(); ++t) {
            const std::string what = where_ + ", morph target " + std::to_string(t);
            MorphTarget morph;
            morph.name = t < names.size() ? names[t] : "target " + std::to_string(t);
            const auto offsets = [&](const char* key) -> std::vector<Vec3f> {
                const auto it = from.targets[t].find(key);
                if (it == from.targets[t].end()) return {};
                std::vector<Vec3f> values = vectors3(accessors_.floats(it->second, 3, what));
                if (values.size() != primitive.positions.size())
                    throw budget_.error(what + " has " + std::to_string(values.size()) +
                                        " offsets for " +
                                        std::to_string(primitive.positions.size()) + " vertices");
                return values;
            };
            morph.positions = offsets("POSITION");
            if (morph.positions.empty()) {
                budget_.take(primitive.positions.size(), sizeof(Vec3f), what);
                morph.positions.assign(primitive.positions.size(), Vec3f::Zero());
            }
            morph.normals = offsets("NORMAL");
            primitive.morphs.push_back(std::move(morph));
        }
    }

  private:
    std::vector<float> floats(const tinygltf::Primitive& from, const std::string& key,
                              int components, std::size_t vertices) {
        const std::string what = where_ + ", " + key;
        std::vector<float> values = accessors_.floats(from.attributes.at(key), components, what);
        if (values.size() != vertices * static_cast<std::size_t>(components))
            throw budget_.error(what + " does not have one element per vertex");
        return values;
    }

    // glTF's vertex colours are linear light.
    void read_colors(const tinygltf::Primitive& from, Primitive& primitive) {
        const auto it = from.attributes.find("COLOR_0");
        if (it == from.attributes.end()) return;
        const int width = accessors_.components(it->second, where_ + ", COLOR_0") == 3 ? 3 : 4;
        const std::size_t vertices = primitive.positions.size();
        const std::vector<float> light = floats(from, "COLOR_0", width, vertices);
        primitive.colors.assign(vertices, {255, 255, 255, 255});
        const auto byte = [](float v) {
            return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f)));
        };
        for (std::size_t i = 0; i < vertices; ++i) {
            const float* row = light.data() + i * static_cast<std::size_t>(width);
            for (std::size_t k = 0; k < 3; ++k)
                primitive.colors[i][k] =
                    byte(imaging::srgb_from_linear(std::clamp(row[k], 0.0f, 1.0f)));
            if (width == 4) primitive.colors[i][3] = byte(row[3]);
        }
    }

    void read_triangles(const tinygltf::Primitive& from, Primitive& primitive) {
        std::vector<std::uint32_t> corners;
        if (from.indices != kNone) {
            corners = accessors_.integers(from.indices, 1, where_ + ", indices");
        } else {
            corners.resize(primitive.positions.size());
            for (std::uint32_t i = 0; i < corners.size(); ++i)
                corners[i] = i;
        }
        for (const std::uint32_t v : corners)
            if (v >= primitive.positions.size())
                throw budget_.error(where_ + ": index " + std::to_string(v) +
                                    " is out of range (it has " +
                                    std::to_string(primitive.positions.size()) + " vertices)");
        auto& triangles = primitive.triangles;
        if (from.mode == TINYGLTF_MODE_TRIANGLES) {
            if (corners.size() % 3 != 0)
                throw budget_.error(where_ + ": its indices do not make whole triangles");
            for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
                triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
            return;
        }
        const bool fan = from.mode == TINYGLTF_MODE_TRIANGLE_FAN;
        for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
            const Triangle t = fan          ? Triangle{corners[0], corners[i + 1], corners[i + 2]}
                               : i % 2 == 0 ? Triangle{corners[i], corners[i + 1], corners[i + 2]}
                                            : Triangle{corners[i + 1], corners[i], corners[i + 2]};
            if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
        }
    }

    void read_influences(const tinygltf::Primitive& from, Primitive& primitive) {
        const std::size_t vertices = primitive.positions.size();
        std::vector<std::uint32_t> joints;
        std::vector<float> weights;
        std::size_t sets = 0;
        for (; from.attributes.contains("JOINTS_" + std::to_string(sets)); ++sets) {
            const std::string key = std::to_string(sets);
            if (!from.attributes.contains("WEIGHTS_" + key))
                throw budget_.error(where_ + " has JOINTS_" + key + " without WEIGHTS_" + key);
            const std::vector<std::uint32_t> j = accessors_.integers(
                from.attributes.at("JOINTS_" + key), 4, where_ + ", JOINTS_" + key);
            const std::vector<float> w = floats(from, "WEIGHTS_" + key, 4, vertices);
            if (j.size() != w.size())
                throw budget_.error(where_ + ", JOINTS_" + key +
                                    " does not have one element per vertex");
            joints.insert(joints.end(), j.begin(), j.end());
            weights.insert(weights.end(), w.begin(), w.end());
        }
        if (sets == 0) return;
        primitive.joints.resize(vertices);
        primitive.weights.resize(vertices);
        std::vector<Influence> row(4 * sets);
        for (std::size_t v = 0; v < vertices; ++v) {
            for (std::size_t i = 0; i < row.size(); ++i) {
                const std::size_t at = (i / 4 * vertices + v) * 4 + i % 4;
                row[i].weight = weights[at];
                row[i].joint =
                    weights[at] == 0.0f
                        ? std::uint16_t{0}
                        : static_cast<std::uint16_t>(std::min(joints[at], std::uint32_t{0xffff}));
            }
            if (sets > 1) {
                keep_four(row, primitive.joints[v], primitive.weights[v]);
                continue;
            }
            for (std::size_t k = 0; k < 4; ++k) {
                primitive.joints[v][k] = row[k].joint;
                primitive.weights[v][k] = row[k].weight;
            }
        }
    }

    void read_variants(const tinygltf::Primitive& from, Primitive& primitive) const {
        const auto it = from.extensions.find("KHR_materials_variants");
        if (it == from.extensions.end() || !it->second.Has("mappings")) return;
        primitive.variant_materials.assign(scene_.variants.size(), kNone);
        const tinygltf::Value& mappings = it->second.Get("mappings");
        for (std::size_t m = 0; m < mappings.ArrayLen(); ++m) {
            const tinygltf::Value& mapping = mappings.Get(static_cast<int>(m));
            const int material =
                mapping.Has("material") ? mapping.Get("material").GetNumberAsInt() : kNone;
            if (material < 0 || static_cast<std::size_t>(material) >= scene_.materials.size())
                throw budget_.error(where_ + ": a variant names a material that does not exist");
            if (!mapping.Has("variants")) continue;
            const tinygltf::Value& variants = mapping.Get("variants");
            for (std::size_t v = 0; v < variants.ArrayLen(); ++v) {
                const int variant = variants.Get(static_cast<int>(v)).GetNumberAsInt();
                if (variant < 0 || static_cast<std::size_t>(variant) >= scene_.variants.size())
                    throw budget_.error(where_ + " names a variant that does not exist");
                primitive.variant_materials[static_cast<std::size_t>(variant)] = material;
            }
        }
    }

    const Scene& scene_;
    AccessorReader& accessors_;
    Budget& budget_;
    std::string where_;
};

std::vector<std::string> target_names(const tinygltf::Mesh& mesh) {
    std::vector<std::string> names;
    if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return names;
    const tinygltf::Value& list = mesh.extras.Get("targetNames");
    for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
        const tinygltf::Value& name = list.Get(static_cast<int>(i));
        names.push_back(name.IsString() ? name.Get<std::string>() : "");
    }
    return names;
}

} // namespace

Mesh read_gltf_mesh(const tinygltf::Model& model, const tinygltf::Mesh& from, const Scene& scene,
                    AccessorReader& accessors, Budget& budget) {
    Mesh mesh;
    mesh.name = from.name;
    const std::string who =
        "mesh " + (from.name.empty() ? "#" + std::to_string(&from - model.meshes.data())
                                     : "'" + from.name + "'");
    const std::vector<std::string> names = target_names(from);
    for (const tinygltf::Primitive& primitive : from.primitives) {
        const int mode = primitive.mode;
        if (mode >= TINYGLTF_MODE_POINTS && mode <= TINYGLTF_MODE_LINE_STRIP) {
            log::warning(budget.file() + ": " + who + ": points and lines are left out");
            continue;
        }
        if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN)
            throw budget.error(who + " has a primitive of unknown mode " + std::to_string(mode));
        if (primitive.targets.size() != from.primitives.front().targets.size())
            throw budget.error(who + ": its primitives differ in their morph targets");
        PrimitiveReader reader(scene, accessors, budget, who);
        mesh.primitives.push_back(reader.run(primitive));
        reader.read_morphs(primitive, names, mesh.primitives.back());
    }
    for (const double w : from.weights)
        mesh.morph_weights.push_back(static_cast<float>(w));
    const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].morphs.size();
    if (!mesh.morph_weights.empty() && mesh.morph_weights.size() != targets)
        throw budget.error(who + " has " + std::to_string(mesh.morph_weights.size()) +
                           " weights for " + std::to_string(targets) + " morph targets");
    return mesh;
}

} // namespace toile::assets
