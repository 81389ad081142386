#include "core/bytes.h"
#include "core/json.h"
#include "garment/package_files.h"

#include <charconv>
#include <cstring>
#include <sstream>

namespace toile::garment {
namespace {

constexpr std::size_t kMaxJsonBytes = 64u << 20;

std::uint32_t little_endian(const std::uint8_t* bytes) {
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
           static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

/// The JSON chunk of a GLB. \throw Error
std::string_view glb_json(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0)
        throw Error("is not a GLB file");
    if (little_endian(bytes.data() + 8) > bytes.size())
        throw Error("is cut off: " + std::to_string(bytes.size()) + " of " +
                    std::to_string(little_endian(bytes.data() + 8)) + " bytes are here");
    const std::size_t length = little_endian(bytes.data() + 12);
    if (std::memcmp(bytes.data() + 16, "JSON", 4) != 0 || length > bytes.size() - 20 ||
        length > kMaxJsonBytes)
        throw Error("is not a GLB file: its first chunk is not JSON");
    return {reinterpret_cast<const char*>(bytes.data()) + 20, length};
}

/// Turns %20 and the like of a URI back.
std::string percent_decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned value = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
            out.push_back(static_cast<char>(value));
            i += 2;
        } else {
            out.push_back(uri[i]);
        }
    }
    return out;
}

std::vector<std::string> names_in_glb(std::span<const std::uint8_t> bytes,
                                      const std::string& shown) {
    std::vector<std::string> names;
    const nlohmann::json json = parse_json(glb_json(bytes), shown);
    for (const char* const list : {"buffers", "images"}) {
        const auto found = json.find(list);
        if (found == json.end() || !found->is_array()) continue;
        for (const auto& item : *found) {
            const auto uri = item.is_object() ? item.find("uri") : item.end();
            if (!item.is_object() || uri == item.end() || !uri->is_string()) continue;
            const std::string name = uri->get<std::string>();
            if (!name.starts_with("data:")) names.push_back(percent_decoded(name));
        }
    }
    return names;
}

/// Words after the first one of lines that start with one of `keys`; of options (-bm 1), the last.
std::vector<std::string> names_in_text(std::span<const std::uint8_t> bytes, bool material_library) {
    std::vector<std::string> names;
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    for (std::string line; std::getline(in, line);) {
        while (!line.empty() && (line.back() == '\r' || line.back() == ' '))
            line.pop_back();
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string::npos) continue;
        const std::size_t gap = line.find_first_of(" \t", start);
        if (gap == std::string::npos) continue;
        const std::string key = line.substr(start, gap - start);
        const bool names_file = material_library ? key.starts_with("map_") || key == "bump" ||
                                                       key == "norm" || key == "disp"
                                                 : key == "mtllib";
        if (!names_file) continue;
        const std::string rest = line.substr(line.find_first_not_of(" \t", gap));
        names.push_back(rest.front() == '-' ? rest.substr(rest.find_last_of(" \t") + 1) : rest);
    }
    return names;
}

std::string beside(const std::string& mesh, const std::string& name) {
    const std::size_t slash = mesh.rfind('/');
    return slash == std::string::npos || name.starts_with('/') ? name
                                                               : mesh.substr(0, slash + 1) + name;
}

} // namespace

std::vector<std::string> referenced_files(const PackageFiles& files, const std::string& mesh) {
    const auto file = files.resolve(mesh, "garment.json");
    const std::string extension = file.extension().string();
    if (extension == ".fbx") return {};
    const auto bytes = read_bytes(file, PackageLimits().max_file_bytes);
    std::vector<std::string> out;
    const auto add = [&](const std::vector<std::string>& names, const std::string& named_by) {
        for (const std::string& name : names) {
            out.push_back(beside(mesh, name));
            static_cast<void>(files.resolve(out.back(), named_by));
        }
    };
    try {
        if (extension == ".glb") {
            add(names_in_glb(bytes, files.shown(mesh)), mesh);
        } else {
            add(names_in_text(bytes, false), mesh);
            const std::vector<std::string> libraries = out;
            for (const std::string& library : libraries)
                add(names_in_text(read_bytes(files.resolve(library, mesh), kMaxJsonBytes), true),
                    library);
        }
    } catch (const PackageError&) {
        throw;
    } catch (const FileError& e) {
        throw PackageError({FaultCode::mesh_file, e.what()});
    } catch (const Error& e) {
        throw PackageError({FaultCode::mesh_file, files.shown(mesh) + ": " + e.what()});
    }
    return out;
}

} // namespace toile::garment
