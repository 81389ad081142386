#include "host/manifest.h"

#include "core/json.h"
#include "host/kinds.h"

#include <algorithm>
#include <cctype>

namespace toile::host {
namespace {

constexpr std::size_t kMaxBytes = 64u << 10;

std::string abi_text(std::int64_t major, std::int64_t minor) {
    return std::to_string(major) + "." + std::to_string(minor);
}

// Words of a-z 0-9 _ - joined by single dots.
bool is_id(const std::string& text) {
    bool word = false;
    for (const char c : text) {
        if (c == '.') {
            if (!word) return false;
            word = false;
        } else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-') {
            word = true;
        } else {
            return false;
        }
    }
    return word && text.size() <= 128;
}

bool is_semver(const std::string& text) {
    int numbers = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t begin = at;
        while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0)
            ++at;
        if (at == begin) return false;
        if (++numbers == 3) return at == text.size() || text[at] == '-' || text[at] == '+';
        if (at == text.size() || text[at++] != '.') return false;
    }
    return false;
}

void read_abi(JsonObject& root, Manifest& out) {
    JsonObject abi = root.object("abi");
    const std::int64_t major = abi.integer("major", 0, UINT32_MAX);
    const std::int64_t minor = abi.integer("minor", 0, UINT32_MAX);
    const std::string built = "built for ABI " + abi_text(major, minor);
    const std::string have = "this engine has " + abi_text(TOILE_ABI_MAJOR, TOILE_ABI_MINOR);
    if (major != TOILE_ABI_MAJOR)
        throw PluginRefused(Refusal::manifest_abi_major, out.file.string(),
                            built + ", " + have + ": build it against this engine's headers");
    if (minor > std::int64_t{TOILE_ABI_MINOR})
        throw PluginRefused(Refusal::manifest_abi_newer, out.file.string(),
                            built + ", " + have + ": update the engine");
    out.abi_major = static_cast<std::uint32_t>(major);
    out.abi_minor = static_cast<std::uint32_t>(minor);
    abi.finish();
}

void check_kinds(const JsonObject& root, const Manifest& out) {
    if (out.provides.empty()) throw root.error("provides", "must name at least one kind");
    for (const std::string& kind : out.provides) {
        const auto known = known_kinds();
        if (std::none_of(known.begin(), known.end(), [&](const auto& k) { return kind == k.id; }))
            throw PluginRefused(Refusal::kind_unknown, out.file.string(),
                                "provides '" + kind +
                                    "', a kind or revision that this engine does not know");
        if (std::count(out.provides.begin(), out.provides.end(), kind) > 1)
            throw root.error("provides", "names '" + kind + "' twice");
    }
    for (const std::string& need : out.needs) {
        const auto offered = host_extensions();
        if (std::none_of(offered.begin(), offered.end(), [&](const char* o) { return need == o; }))
            throw PluginRefused(Refusal::need_unknown, out.file.string(),
                                "needs '" + need + "', which this engine does not offer");
    }
    for (const std::string& scheme : out.schemes)
        if (!is_id(scheme)) throw root.error("schemes", "'" + scheme + "' is no URI scheme");
}

// One to three words of a-z and -, joined by single blanks.
bool is_command(const std::string& text) {
    bool word = false;
    int words = 1;
    for (const char c : text) {
        if (c == ' ') {
            if (!word) return false;
            word = false;
            ++words;
        } else if ((c >= 'a' && c <= 'z') || (c == '-' && word)) {
            word = true;
        } else {
            return false;
        }
    }
    return word && words <= 3 && text.size() <= 64;
}

// `toile scan --method` names it; the engine knows none.
void read_method(JsonObject& root, Manifest& out) {
    const bool scanner = out.provides_kind(TOILE_SCANNER);
    if (!root.has("method")) {
        if (scanner)
            throw root.error("method", std::string("must name what provides ") + TOILE_SCANNER);
        return;
    }
    if (!scanner)
        throw root.error("method", std::string("is for plugins that provide ") + TOILE_SCANNER);
    out.method = root.text("method");
    if (!is_command(out.method) || out.method.find(' ') != std::string::npos)
        throw root.error("method", "'" + out.method + "' must be one word of a-z and -");
}

// The help lists a tool without opening its library.
void read_command(JsonObject& root, Manifest& out) {
    const bool tool = out.provides_kind(TOILE_TOOL);
    if (!root.has("command")) {
        if (tool)
            throw root.error("command",
                             std::string("must tell the words of what provides ") + TOILE_TOOL);
        return;
    }
    if (!tool)
        throw root.error("command", std::string("is for plugins that provide ") + TOILE_TOOL);
    JsonObject command = root.object("command");
    out.command = command.text("words");
    if (!is_command(out.command))
        throw command.error("words", "'" + out.command +
                                         "' must be one to three words of a-z and -, joined by "
                                         "single blanks");
    out.command_summary = command.text("summary");
    command.finish();
}

void read_values(JsonObject& root, Manifest& out) {
    out.id = root.text("id");
    if (!is_id(out.id))
        throw root.error("id", "'" + out.id + "' must be lower case words joined by dots");
    out.version = root.text("version");
    if (!is_semver(out.version))
        throw root.error("version", "'" + out.version + "' must read like 1.2.3");
    const auto beside = [&](const char* key) {
        const std::string name = root.text(key);
        if (name.empty() || name.find('/') != std::string::npos || name == "..")
            throw root.error(key, "must be the name of a file beside the manifest");
        return out.file.parent_path() / name;
    };
    out.library = beside("library");
    if (root.has("sample")) out.sample = beside("sample");
    out.provides = root.texts("provides");
    if (root.has("needs")) out.needs = root.texts("needs");
    if (root.has("schemes")) out.schemes = root.texts("schemes");
    out.priority = static_cast<int>(root.integer_or("priority", -100, 100, 0));
    out.licence = root.text_or("licence", "");
    check_kinds(root, out);
    read_command(root, out);
    read_method(root, out);
}

// The text of a JsonError without the file in front, which PluginRefused adds again.
std::string detail(const JsonError& e, const std::string& file) {
    const std::string text = e.what();
    return text.starts_with(file + ": ") ? text.substr(file.size() + 2) : text;
}

} // namespace

bool Manifest::provides_kind(const std::string& kind) const {
    return std::find(provides.begin(), provides.end(), kind) != provides.end();
}

bool Manifest::serves_scheme(const std::string& scheme) const {
    return std::find(schemes.begin(), schemes.end(), scheme) != schemes.end();
}

Manifest read_manifest(const std::filesystem::path& file) {
    Manifest out;
    out.file = file;
    const std::string name = file.string();
    nlohmann::json json;
    try {
        json = parse_json_file(file, kMaxBytes);
    } catch (const JsonError& e) {
        throw PluginRefused(Refusal::manifest_unreadable, name, detail(e, name));
    }
    try {
        JsonObject root(json, name);
        read_abi(root, out);
        // A misspelt key is told before the missing one that it was meant to be.
        for (const std::string& key : root.keys()) {
            constexpr const char* known[] = {"id",       "version", "abi",     "library",
                                             "provides", "needs",   "schemes", "priority",
                                             "licence",  "sample",  "command", "method"};
            if (std::none_of(std::begin(known), std::end(known),
                             [&](const char* k) { return key == k; }))
                throw PluginRefused(Refusal::manifest_unknown_key, name,
                                    "/" + key + ": is not a known key");
        }
        read_values(root, out);
    } catch (const JsonError& e) {
        throw PluginRefused(Refusal::manifest_invalid, name, detail(e, name));
    }
    return out;
}

std::vector<std::filesystem::path> manifests_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    std::error_code code;
    for (const auto& item : std::filesystem::directory_iterator(folder, code)) {
        const std::string name = item.path().filename().string();
        if (name == "plugin.json" || name.ends_with(".plugin.json")) out.push_back(item.path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace toile::host
