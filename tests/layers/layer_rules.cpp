#include "layers/layer_rules.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace toile::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// Direct arrows of the design; they are transitive.
const std::map<std::string, Names> kArrows = {
    {"abi", {}},
    {"sdk", {"abi"}},
    {"core", {}},
    {"geometry", {"core"}},
    {"imaging", {"core"}},
    {"assets", {"geometry", "imaging"}},
    {"body", {"assets"}},
    {"cloth", {"geometry"}},
    {"scan", {"geometry", "imaging"}},
    {"boundary", {"sdk", "body", "cloth", "scan"}},
    {"garment", {"body"}},
    {"host", {"abi", "core"}},
    {"pipeline", {"host", "garment"}},
    {"render", {"assets"}},
    {"apps", {"pipeline", "render", "scan"}},
};

// A plugin: the boundary, and the engine's algorithms up to garment.
const Names kPluginLayers = {"abi",  "sdk",   "core", "geometry", "imaging", "assets",
                             "body", "cloth", "scan", "boundary", "garment"};

struct Library {
    const char* name;
    const char* header; // regular expression on the include's text
    const char* target; // regular expression on a link line's word
    Names layers;       // who may use it directly
    bool plugins;       // may plugins?
};

// Everything that stands on core sees Eigen, JSON and the log through it.
const Names kEverywhere = {"core", "geometry", "imaging", "assets",   "body",   "cloth",
                           "scan", "garment",  "host",    "pipeline", "render", "apps"};

const std::vector<Library> kLibraries = {
    {"Eigen", R"(^Eigen/.*|^unsupported/Eigen/.*)", "^Eigen3::.*", kEverywhere, true},
    {"JSON", "^nlohmann/.*", "^nlohmann_json::.*", kEverywhere, true},
    {"spdlog", "^spdlog/.*", "^spdlog::.*", {"core"}, false},
    {"threads", "^$", "^Threads::.*", {"core"}, false},
    {"OpenMesh", "^OpenMesh/.*", "^OpenMesh.*", {"geometry"}, true},
    {"Embree", "^embree.*", "^embree$", {"geometry"}, true},
    {"nanoflann", "^nanoflann.*", "^nanoflann::.*", {"geometry"}, true},
    {"Spectra", "^Spectra/.*", "^Spectra::.*", {"geometry"}, true},
    {"libpng", "^png\\.h$", "^PNG::.*", {"imaging"}, true},
    {"TurboJPEG", "^turbojpeg\\.h$", "^PkgConfig::TURBOJPEG$", {"imaging"}, true},
    {"tinygltf", "^tiny_gltf\\.h$", "^TinyGLTF::.*", {"assets"}, false},
    {"assimp", "^assimp/.*", "^assimp::.*", {"assets"}, false},
    {"libzip", "^zip\\.h$", "^PkgConfig::LIBZIP$", {"assets"}, false},
    {"oneTBB", "^(tbb|oneapi)/.*", "^TBB::.*", {"host"}, false},
    {"OpenNI2", "^(OpenNI\\.h|Driver/OniDriverAPI\\.h)$", "^PkgConfig::OPENNI2$", {}, true},
    {"dl", "^dlfcn\\.h$", "^\\$\\{CMAKE_DL_LIBS\\}$", {"host"}, false},
    {"GLFW", "^GLFW/.*", "^glfw$", {"render"}, false},
    {"OSMesa and GL",
     "^(GL/.*|glad/.*)",
     "^(PkgConfig::OSMESA|toile_glad|OpenGL::.*)$",
     {"render"},
     false},
    {"Dear ImGui", "^imgui.*", "^PkgConfig::IMGUI$", {"render"}, false},
    {"CLI11", "^CLI/.*", "^CLI11::.*", {"apps"}, false},
    {"OpenImageIO", "^OpenImageIO/.*", "^PkgConfig::OPENIMAGEIO$", {"apps"}, false},
    {"Bullet", "^(btBullet.*|Bullet.*|LinearMath/.*)", "^PkgConfig::BULLET$", {}, true},
};

Names reachable(const std::string& layer) {
    Names out;
    std::vector<std::string> open = {layer};
    while (!open.empty()) {
        const std::string next = open.back();
        open.pop_back();
        if (!out.insert(next).second) continue;
        const auto found = kArrows.find(next);
        if (found != kArrows.end())
            open.insert(open.end(), found->second.begin(), found->second.end());
    }
    return out;
}

std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// One folder of the tree and what it may use.
struct Folder {
    std::string name; // "core", or the plugin's name
    bool is_plugin;
    Names layers;
    std::vector<std::string>* findings;

    [[nodiscard]] bool may_use(const Library& library) const {
        return is_plugin ? library.plugins : library.layers.contains(name);
    }
};

void check_include(const Folder& folder, const std::string& where, const std::string& text,
                   bool quoted) {
    const auto add = [&](const std::string& what) {
        folder.findings->push_back(where + ": " + folder.name + " may not include " + what);
    };
    const std::string first = text.substr(0, text.find('/'));
    if (kArrows.contains(first) && text.find('/') != std::string::npos) {
        if (!folder.layers.contains(first)) add(first + " (" + text + ")");
        return;
    }
    for (const Library& library : kLibraries) {
        if (!std::regex_match(text, std::regex(library.header))) continue;
        if (!folder.may_use(library)) add(std::string(library.name) + " (" + text + ")");
        return;
    }
    // The plugin's own files by their path from plugins/; the boundary's headers among themselves.
    if (quoted && folder.is_plugin && first == folder.name) return;
    if (quoted && folder.name == "abi" && first == text) return;
    // The standard library and the system's own headers have no folder, or sys/.
    if (!quoted && (first == text || first == "sys" || first == "bits")) {
        if (first.find('.') == std::string::npos ||
            std::regex_match(text, std::regex("(sys/"
                                              ".*|unistd|fcntl|signal|poll|spawn|elf|math|stdint|"
                                              "stddef|string|stdlib|stdio|link|time|dirent|"
                                              "errno|pthread|immintrin|cpuid)(\\.h)?")) ||
            first == "sys")
            return;
    }
    add("the unknown header " + text);
}

void check_sources(const Folder& folder, const fs::path& path, const fs::path& root) {
    static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
        const auto relative = fs::relative(entry.path(), root);
        const std::string extension = entry.path().extension();
        if (!entry.is_regular_file() ||
            (extension != ".h" && extension != ".cpp" && extension != ".c"))
            continue;
        // A plugin's tests may use the test framework; what they link is not shipped.
        if (folder.is_plugin && entry.path().parent_path().filename() == "tests") continue;
        std::istringstream in(read(entry.path()));
        int number = 0;
        for (std::string line; std::getline(in, line);) {
            ++number;
            std::smatch match;
            if (!std::regex_search(line, match, kInclude)) continue;
            check_include(folder, relative.string() + ":" + std::to_string(number), match[2],
                          match[1] == "\"");
        }
    }
}

void check_link_line(const Folder& folder, const fs::path& file, const fs::path& root) {
    static const std::regex kComment("#[^\n]*");
    static const std::regex kCall(
        R"((toile_add_layer|toile_add_plugin|target_link_libraries)\s*\(([^)]*)\))");
    const std::string text = std::regex_replace(read(file), kComment, "");
    const std::string where = fs::relative(file, root).string();
    for (std::sregex_iterator call(text.begin(), text.end(), kCall), end; call != end; ++call) {
        std::istringstream in((*call)[2].str());
        bool depends = false;
        bool test_only = false;
        std::string word;
        in >> word; // the target's own name
        while (in >> word) {
            if (word == "DEPENDS" || word == "LINK" || word == "LINK_PRIVATE" || word == "PUBLIC" ||
                word == "PRIVATE" || word == "INTERFACE" || word == "TEST_LINK") {
                depends = word == "DEPENDS";
                test_only = word == "TEST_LINK";
                continue;
            }
            if (test_only) continue;
            std::string layer = depends ? word : std::string();
            if (word.starts_with("toile_") && kArrows.contains(word.substr(6)))
                layer = word.substr(6);
            if (!layer.empty()) {
                if (!folder.layers.contains(layer))
                    folder.findings->push_back(where + ": " + folder.name + " may not link " +
                                               layer);
                continue;
            }
            bool known = word.starts_with(folder.name);
            for (const Library& library : kLibraries) {
                if (!std::regex_match(word, std::regex(library.target))) continue;
                known = true;
                if (!folder.may_use(library))
                    folder.findings->push_back(where + ": " + folder.name + " may not link " +
                                               library.name);
            }
            if (!known)
                folder.findings->push_back(where + ": " + folder.name + " links the unknown " +
                                           word);
        }
    }
}

void check_folder(const Folder& folder, const fs::path& path, const fs::path& root) {
    check_sources(folder, path, root);
    if (fs::exists(path / "CMakeLists.txt")) check_link_line(folder, path / "CMakeLists.txt", root);
}

std::vector<fs::path> subfolders(const fs::path& path) {
    std::vector<fs::path> out;
    if (!fs::exists(path)) return out;
    for (const auto& entry : fs::directory_iterator(path))
        if (entry.is_directory()) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

std::vector<std::string> check_layers(const fs::path& root) {
    std::vector<std::string> findings;
    for (const auto& path : subfolders(root / "engine")) {
        const std::string name = path.filename();
        if (!kArrows.contains(name)) {
            findings.push_back("engine/" + name + ": is not a layer of the design");
            continue;
        }
        check_folder({name, false, reachable(name), &findings}, path, root);
    }
    for (const auto& path : subfolders(root / "plugins"))
        check_folder({path.filename(), true, kPluginLayers, &findings}, path, root);
    return findings;
}

} // namespace toile::test
