#include "assets/gltf_check.h"

#include "core/json.h"

#include <cstring>
#include <set>
#include <string_view>

namespace toile::assets {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxJsonBytes = 64u << 20;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

// The JSON chunk of a .glb: header (magic, version, length), then chunks (length, type, data).
std::string_view json_chunk(std::span<const std::uint8_t> bytes, const Budget& budget) {
    if (bytes.size() < 20 || word(bytes, 0) != 0x46546c67u)
        throw budget.error("not a GLB file (no 'glTF' at its start)");
    if (word(bytes, 4) != 2)
        throw budget.error("GLB version " + std::to_string(word(bytes, 4)) +
                           " is not supported (2 is)");
    const std::uint32_t length = word(bytes, 8);
    if (length > bytes.size())
        throw budget.error("claims " + std::to_string(length) + " bytes but has " +
                           std::to_string(bytes.size()) + " (cut off?)");
    const std::uint32_t json_length = word(bytes, 12);
    if (word(bytes, 16) != 0x4e4f534au || json_length > length - 20)
        throw budget.error("its JSON chunk is missing or reaches beyond the file");
    return {reinterpret_cast<const char*>(bytes.data()) + 20, json_length};
}

// Optional member that must be a whole number; `fallback` when absent.
std::uint64_t whole(const json& object, const char* key, std::uint64_t fallback,
                    const std::string& where, const Budget& budget) {
    const auto it = object.find(key);
    if (it == object.end()) return fallback;
    if (!it->is_number_unsigned())
        throw budget.error(where + ": '" + key + "' must be a whole number of at least 0");
    return it->get<std::uint64_t>();
}

const json& array(const json& root, const char* key, const Budget& budget) {
    static const json empty = json::array();
    const auto it = root.find(key);
    if (it == root.end()) return empty;
    if (!it->is_array()) throw budget.error(std::string("'") + key + "' must be an array");
    for (const json& element : *it)
        if (!element.is_object())
            throw budget.error(std::string("'") + key + "' must hold objects");
    return *it;
}

void check_buffers(const json& root, const Budget& budget) {
    std::uint64_t total = 0;
    std::vector<std::uint64_t> lengths;
    for (const json& buffer : array(root, "buffers", budget)) {
        const std::string where = "buffer " + std::to_string(lengths.size());
        const std::uint64_t length = whole(buffer, "byteLength", 0, where, budget);
        lengths.push_back(length);
        if (length > budget.limits().max_file_bytes ||
            (total += length) > budget.limits().max_file_bytes)
            throw budget.error(where + " claims " + std::to_string(length) +
                               " bytes; buffers may hold " +
                               std::to_string(budget.limits().max_file_bytes) + " in all");
    }
    std::size_t index = 0;
    for (const json& view : array(root, "bufferViews", budget)) {
        const std::string where = "buffer view " + std::to_string(index++);
        const std::uint64_t buffer = whole(view, "buffer", ~0ull, where, budget);
        const std::uint64_t offset = whole(view, "byteOffset", 0, where, budget);
        const std::uint64_t length = whole(view, "byteLength", 0, where, budget);
        if (buffer >= lengths.size()) throw budget.error(where + " names a missing buffer");
        if (length == 0) throw budget.error(where + " is empty");
        if (offset > lengths[buffer] || length > lengths[buffer] - offset)
            throw budget.error(where + " reaches beyond its buffer");
    }
}

void check_extensions(const json& root, const Budget& budget) {
    static const std::set<std::string> known = {"KHR_materials_sheen", "KHR_materials_variants",
                                                "KHR_mesh_quantization", "KHR_materials_unlit"};
    const auto it = root.find("extensionsRequired");
    if (it == root.end()) return;
    for (const json& name : *it)
        if (!name.is_string() || !known.contains(name.get<std::string>()))
            throw budget.error("requires the extension " + name.dump() +
                               ", which is not supported; export without it");
}

} // namespace

void check_gltf(std::span<const std::uint8_t> bytes, bool binary, const Budget& budget) {
    const std::string_view text =
        binary ? json_chunk(bytes, budget)
               : std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.size() > kMaxJsonBytes)
        throw budget.error("holds more than " + std::to_string(kMaxJsonBytes >> 20) +
                           " MiB of JSON; use a .glb");
    const json root = parse_json(text, budget.file());
    if (!root.is_object()) throw budget.error("its JSON is not an object");
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string() ||
        (*asset)["version"].get<std::string>().rfind("2.", 0) != 0)
        throw budget.error("not glTF 2 ('asset.version' must be 2.x)");
    for (const char* key : {"accessors", "animations", "images", "materials", "meshes", "nodes",
                            "scenes", "skins", "textures", "samplers"})
        (void)array(root, key, budget);
    check_extensions(root, budget);
    check_buffers(root, budget);
}

} // namespace toile::assets
