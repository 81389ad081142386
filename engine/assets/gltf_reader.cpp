// glTF to Scene. tinygltf parses; what it hands over is checked here, index by index.
#include "assets/formats.h"
#include "assets/gltf_accessor.h"
#include "assets/gltf_check.h"
#include "assets/gltf_parts.h"
#include "assets/skins.h"
#include "core/bytes.h"
#include "core/log.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace toile::assets {
namespace {

// tinygltf asks these for every file that a .gltf names; only files below its folder are given.
struct FileAccess {
    std::filesystem::path folder;
    std::size_t max_bytes = 0;
    std::string refusal; // the first one
};

bool inside(const std::filesystem::path& folder, const std::filesystem::path& file) {
    const auto relative = std::filesystem::weakly_canonical(file).lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

bool file_exists(const std::string& name, void* user) {
    auto& access = *static_cast<FileAccess*>(user);
    std::error_code ignored;
    if (!inside(access.folder, name)) {
        // tinygltf also looks in the working directory, as "./name": that is not the file's doing.
        if (access.refusal.empty() && name.rfind("./", 0) != 0)
            access.refusal = "names a file outside its folder: " + name;
        return false;
    }
    return std::filesystem::is_regular_file(name, ignored);
}

std::string expand_path(const std::string& name, void*) {
    return name;
}

bool read_whole(std::vector<unsigned char>* out, std::string* error, const std::string& name,
                void* user) {
    auto& access = *static_cast<FileAccess*>(user);
    if (!file_exists(name, user)) return false;
    try {
        *out = read_bytes(name, access.max_bytes);
        return true;
    } catch (const Error& e) {
        if (access.refusal.empty()) access.refusal = e.what();
        if (error != nullptr) *error += e.what();
        return false;
    }
}

bool write_whole(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

// Pictures stay packed until a material asks for them.
bool keep_packed(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
    image->as_is = true;
    image->image.assign(bytes, bytes + std::max(size, 0));
    return true;
}

std::string first_line(std::string text) {
    text.erase(std::min(text.find('\n'), text.size()));
    return text;
}

tinygltf::Model parse(const std::filesystem::path& file, const Budget& budget) {
    const bool binary = file.extension().string().size() == 4; // .glb, not .gltf
    const std::vector<std::uint8_t> bytes = read_bytes(file, budget.limits().max_file_bytes);
    check_gltf(bytes, binary, budget);

    FileAccess access;
    access.folder =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path());
    access.max_bytes = budget.limits().max_file_bytes;
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_packed, nullptr);
    loader.SetFsCallbacks({file_exists, expand_path, read_whole, write_whole, &access});
    tinygltf::Model model;
    std::string problem;
    std::string warnings;
    bool good = false;
    try {
        const auto size = static_cast<unsigned>(bytes.size());
        good = binary ? loader.LoadBinaryFromMemory(&model, &problem, &warnings, bytes.data(), size,
                                                    access.folder.string())
                      : loader.LoadASCIIFromString(&model, &problem, &warnings,
                                                   reinterpret_cast<const char*>(bytes.data()),
                                                   size, access.folder.string());
    } catch (const std::exception& e) {
        problem = e.what();
    }
    if (!access.refusal.empty()) throw budget.error(access.refusal);
    if (!good)
        throw budget.error("not a good glTF file: " +
                           first_line(problem.empty() ? "it cannot be parsed" : problem));
    return model;
}

class Converter {
  public:
    Converter(const tinygltf::Model& model, Budget& budget)
        : model_(model), budget_(budget), accessors_(model, budget) {}

    Scene run() {
        order_nodes();
        convert_nodes();
        read_gltf_materials(model_, budget_, scene_);
        for (const tinygltf::Mesh& mesh : model_.meshes)
            scene_.meshes.push_back(read_gltf_mesh(model_, mesh, scene_, accessors_, budget_));
        for (std::size_t i = 0; i < model_.skins.size(); ++i)
            convert_skin(model_.skins[i], i);
        for (const tinygltf::Animation& animation : model_.animations) {
            Animation read = read_gltf_animation(animation, new_index_, accessors_, budget_);
            if (!read.channels.empty()) scene_.animations.push_back(std::move(read));
        }
        return std::move(scene_);
    }

  private:
    // Parents before children, otherwise in the order of the file.
    void order_nodes() {
        const std::size_t count = model_.nodes.size();
        parent_.assign(count, kNone);
        for (std::size_t i = 0; i < count; ++i)
            for (const int child : model_.nodes[i].children) {
                if (child < 0 || static_cast<std::size_t>(child) >= count)
                    throw budget_.error(name(i) + " names a child that does not exist");
                int& parent = parent_[static_cast<std::size_t>(child)];
                if (parent != kNone)
                    throw budget_.error(name(static_cast<std::size_t>(child)) + " has two parents");
                parent = static_cast<int>(i);
            }
        new_index_.assign(count, kNone);
        std::vector<std::size_t> stack;
        for (std::size_t root = count; root-- > 0;)
            if (parent_[root] == kNone) stack.push_back(root);
        while (!stack.empty()) {
            const std::size_t i = stack.back();
            stack.pop_back();
            new_index_[i] = static_cast<int>(order_.size());
            order_.push_back(i);
            const auto& children = model_.nodes[i].children;
            for (auto it = children.rbegin(); it != children.rend(); ++it)
                stack.push_back(static_cast<std::size_t>(*it));
        }
        for (std::size_t i = 0; i < count; ++i)
            if (new_index_[i] == kNone)
                throw budget_.error(name(i) + " is part of a cycle of nodes (joint cycle)");
    }

    void convert_nodes() {
        for (const std::size_t i : order_) {
            const tinygltf::Node& from = model_.nodes[i];
            Node node;
            node.name = from.name;
            const int parent = parent_[i];
            node.parent = parent == kNone ? kNone : new_index_[static_cast<std::size_t>(parent)];
            place(from, node, name(i));
            node.mesh = reference(from.mesh, model_.meshes.size(), name(i), "mesh");
            node.skin = reference(from.skin, model_.skins.size(), name(i), "skin");
            scene_.nodes.push_back(std::move(node));
        }
    }

    int reference(int index, std::size_t count, const std::string& who, const char* what) const {
        if (index < kNone || (index != kNone && static_cast<std::size_t>(index) >= count))
            throw budget_.error(who + " names a " + what + " that does not exist");
        return index;
    }

    void place(const tinygltf::Node& from, Node& node, const std::string& who) const {
        if (from.matrix.size() == 16) {
            Eigen::Affine3d m;
            for (int k = 0; k < 16; ++k)
                m.matrix()(k % 4, k / 4) = from.matrix[static_cast<std::size_t>(k)];
            decompose(m, node);
        }
        if (from.translation.size() == 3)
            node.translation = Eigen::Map<const Vec3d>(from.translation.data()).cast<float>();
        if (from.scale.size() == 3)
            node.scale = Eigen::Map<const Vec3d>(from.scale.data()).cast<float>();
        if (from.rotation.size() == 4)
            node.rotation = Quatf(Eigen::Map<const Eigen::Vector4d>(from.rotation.data())
                                      .cast<float>()
                                      .eval()
                                      .data());
        const float norm = node.rotation.norm();
        if (!node.translation.allFinite() || !node.scale.allFinite() || !std::isfinite(norm) ||
            norm < 1e-6f)
            throw budget_.error(who + " has a transform that is not finite");
        if (std::abs(norm - 1.0f) > 1e-6f) node.rotation.normalize();
    }

    void convert_skin(const tinygltf::Skin& from, std::size_t index) {
        const std::string who = "skin " + std::to_string(index);
        Skin skin;
        skin.name = from.name;
        for (const int joint : from.joints) {
            if (joint < 0 || static_cast<std::size_t>(joint) >= model_.nodes.size())
                throw budget_.error(who + " names joint node " + std::to_string(joint) +
                                    ", which is out of range");
            skin.joints.push_back(new_index_[static_cast<std::size_t>(joint)]);
        }
        skin.inverse_bind.assign(skin.joints.size(), Eigen::Matrix4f::Identity());
        if (from.inverseBindMatrices != kNone) {
            const std::vector<float> values =
                accessors_.floats(from.inverseBindMatrices, 16, who + ", inverse bind matrices");
            if (values.size() < 16 * skin.joints.size())
                throw budget_.error(who + " has " + std::to_string(skin.joints.size()) +
                                    " joints but " + std::to_string(values.size() / 16) +
                                    " inverse bind matrices");
            for (std::size_t j = 0; j < skin.joints.size(); ++j)
                skin.inverse_bind[j] = Eigen::Map<const Eigen::Matrix4f>(values.data() + 16 * j);
        }
        scene_.skins.push_back(std::move(skin));
    }

    [[nodiscard]] std::string name(std::size_t node) const {
        const std::string& text = model_.nodes[node].name;
        return "node " + (text.empty() ? "#" + std::to_string(node) : "'" + text + "'");
    }

    const tinygltf::Model& model_;
    Budget& budget_;
    AccessorReader accessors_;
    Scene scene_;
    std::vector<int> parent_;        // by index in the file
    std::vector<int> new_index_;     // by index in the file
    std::vector<std::size_t> order_; // by index in the scene
};

} // namespace

void decompose(const Eigen::Affine3d& transform, Node& node) {
    Eigen::Matrix3d rotation;
    Eigen::Matrix3d scaling;
    transform.computeRotationScaling(&rotation, &scaling);
    node.translation = transform.translation().cast<float>();
    node.rotation = Quatf(Eigen::Quaterniond(rotation).normalized().cast<float>());
    node.scale = scaling.diagonal().cast<float>();
}

Scene read_gltf(const std::filesystem::path& file, Budget& budget) {
    const tinygltf::Model model = parse(file, budget);
    return Converter(model, budget).run();
}

} // namespace toile::assets
