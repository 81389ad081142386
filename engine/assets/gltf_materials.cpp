#include "assets/gltf_parts.h"
#include "core/log.h"

#include <map>

namespace toile::assets {
namespace {

class MaterialReader {
  public:
    MaterialReader(const tinygltf::Model& model, Budget& budget, Scene& scene)
        : model_(model), budget_(budget), scene_(scene) {}

    void run() {
        for (std::size_t i = 0; i < model_.materials.size(); ++i)
            scene_.materials.push_back(convert(model_.materials[i], i));
        const auto it = model_.extensions.find("KHR_materials_variants");
        if (it == model_.extensions.end() || !it->second.Has("variants")) return;
        const tinygltf::Value& variants = it->second.Get("variants");
        for (std::size_t i = 0; i < variants.ArrayLen(); ++i) {
            const tinygltf::Value& variant = variants.Get(static_cast<int>(i));
            scene_.variants.push_back(variant.Has("name") && variant.Get("name").IsString()
                                          ? variant.Get("name").Get<std::string>()
                                          : "variant " + std::to_string(i));
        }
    }

  private:
    Material convert(const tinygltf::Material& from, std::size_t index) {
        const std::string who =
            "material " + (from.name.empty() ? "#" + std::to_string(index) : "'" + from.name + "'");
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        Material material;
        material.name = from.name;
        for (std::size_t k = 0; k < 4 && k < pbr.baseColorFactor.size(); ++k)
            material.base_color[static_cast<Eigen::Index>(k)] =
                static_cast<float>(pbr.baseColorFactor[k]);
        material.metallic = static_cast<float>(pbr.metallicFactor);
        material.roughness = static_cast<float>(pbr.roughnessFactor);
        material.base_color_texture =
            texture(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, false, who);
        material.normal_texture =
            texture(from.normalTexture.index, from.normalTexture.texCoord, true, who);
        material.normal_scale = static_cast<float>(from.normalTexture.scale);
        material.double_sided = from.doubleSided;
        if (pbr.metallicRoughnessTexture.index >= 0)
            average_metal(pbr.metallicRoughnessTexture.index, material, who);
        const auto sheen = from.extensions.find("KHR_materials_sheen");
        if (sheen != from.extensions.end()) read_sheen(sheen->second, material);
        if (!material.base_color.allFinite() || !std::isfinite(material.metallic) ||
            !std::isfinite(material.roughness) || !material.sheen_color.allFinite())
            throw budget_.error(who + " has a factor that is not finite");
        return material;
    }

    static void read_sheen(const tinygltf::Value& sheen, Material& material) {
        material.sheen_roughness = 0.0f;
        if (sheen.Has("sheenColorFactor") && sheen.Get("sheenColorFactor").ArrayLen() == 3)
            for (int k = 0; k < 3; ++k)
                material.sheen_color[k] =
                    static_cast<float>(sheen.Get("sheenColorFactor").Get(k).GetNumberAsDouble());
        if (sheen.Has("sheenRoughnessFactor"))
            material.sheen_roughness =
                static_cast<float>(sheen.Get("sheenRoughnessFactor").GetNumberAsDouble());
    }

    // A texture of metal and roughness becomes its mean: our material has one value for each.
    void average_metal(int index, Material& material, const std::string& who) {
        const imaging::Image image = decode(source(index, who), who);
        double green = 0.0;
        double blue = 0.0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            green += image.pixels[i + 1];
            blue += image.pixels[i + 2];
        }
        const double count = 255.0 * static_cast<double>(image.pixels.size()) / 4.0;
        material.roughness *= static_cast<float>(green / count);
        material.metallic *= static_cast<float>(blue / count);
    }

    std::size_t source(int index, const std::string& who) const {
        if (static_cast<std::size_t>(index) >= model_.textures.size())
            throw budget_.error(who + " names a texture that does not exist");
        const int image = model_.textures[static_cast<std::size_t>(index)].source;
        if (image < 0 || static_cast<std::size_t>(image) >= model_.images.size())
            throw budget_.error(who + " uses a texture without a picture");
        return static_cast<std::size_t>(image);
    }

    imaging::Image decode(std::size_t image, const std::string& who) {
        const tinygltf::Image& from = model_.images[image];
        const std::string label = from.uri.empty() ? "picture #" + std::to_string(image) : from.uri;
        if (from.image.empty())
            throw budget_.error(who + ": the texture '" + label + "' is missing");
        imaging::Image decoded =
            imaging::decode_image(from.image, budget_.file() + ": " + label,
                                  static_cast<int>(budget_.limits().max_texture_side));
        budget_.take(decoded.pixels.size(), 1, label);
        return decoded;
    }

    // Index into the scene's textures of one picture in one use.
    int texture(int index, int texcoord, bool linear, const std::string& who) {
        if (index < 0) return kNone;
        if (texcoord != 0)
            log::warning(budget_.file() + ": " + who +
                         " uses a second set of texture coordinates; the first is taken");
        const std::size_t image = source(index, who);
        const auto [it, fresh] =
            made_.try_emplace({image, linear}, static_cast<int>(scene_.textures.size()));
        if (fresh)
            scene_.textures.push_back({model_.images[image].name, decode(image, who), linear});
        return it->second;
    }

    const tinygltf::Model& model_;
    Budget& budget_;
    Scene& scene_;
    std::map<std::pair<std::size_t, bool>, int> made_;
};

} // namespace

void read_gltf_materials(const tinygltf::Model& model, Budget& budget, Scene& scene) {
    MaterialReader(model, budget, scene).run();
}

} // namespace toile::assets
