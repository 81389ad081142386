#include "host/registry.h"

#include "core/log.h"
#include "core/paths.h"
#include "host/instance.h"
#include "host/trial.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace toile::host {

struct Registry::Record {
    Manifest manifest; // only file and id when refused by gate 1
    const toile_entry* linked = nullptr;
    bool trusted = false;
    std::shared_ptr<const Plugin> plugin;
    std::optional<RefusedPlugin> refusal;
};

namespace {

std::vector<std::filesystem::path> environment_folders() {
    std::vector<std::filesystem::path> out;
    const char* list = std::getenv("TOILE_PLUGIN_PATH");
    std::istringstream in(list == nullptr ? "" : list);
    for (std::string folder; std::getline(in, folder, ':');) {
        if (folder.empty()) continue;
        std::error_code code;
        if (std::filesystem::is_directory(folder, code))
            out.emplace_back(folder);
        else
            log::warning(folder + ": no such folder (TOILE_PLUGIN_PATH)");
    }
    return out;
}

// Manifests of a folder itself and of its direct sub-folders, sorted by path.
std::vector<std::filesystem::path> find_manifests(const std::filesystem::path& root) {
    std::vector<std::filesystem::path> out = manifests_in(root);
    std::error_code code;
    for (const auto& item : std::filesystem::directory_iterator(root, code)) {
        if (!item.is_directory(code)) continue;
        const auto inner = manifests_in(item.path());
        out.insert(out.end(), inner.begin(), inner.end());
    }
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

Registry::Registry(Services& services, RegistryOptions options)
    : services_(&services), options_(std::move(options)) {
    for (const auto& folder : options_.folders) {
        std::error_code code;
        if (!std::filesystem::is_directory(folder, code))
            throw Error(folder.string() + ": no such folder to look for plugins in");
        discover(folder, false);
    }
    if (options_.environment)
        for (const auto& folder : environment_folders())
            discover(folder, false);
    if (options_.beside_program) discover(program_folder() / "plugins", true);
}

Registry::~Registry() {
    for (const auto& record : records_) {
        if (record->plugin == nullptr || record->plugin.use_count() != 1) continue;
        try {
            record->plugin->entry().deinit();
        } catch (...) {
            log::warning(record->manifest.id + ": deinit threw an exception");
        }
    }
}

void Registry::discover(const std::filesystem::path& root, bool trusted) {
    for (const auto& file : find_manifests(root))
        read(file, trusted);
}

void Registry::read(const std::filesystem::path& file, bool trusted) {
    auto record = std::make_unique<Record>();
    record->manifest.file = file;
    record->trusted = trusted;
    try {
        record->manifest = read_manifest(file);
        for (const auto& other : records_)
            if (other->manifest.id == record->manifest.id)
                throw PluginRefused(Refusal::duplicate_id, file.string(),
                                    "id '" + record->manifest.id + "' is taken by " +
                                        (other->linked != nullptr ? "a plugin linked in"
                                                                  : other->manifest.file.string()));
    } catch (const PluginRefused& e) {
        record->refusal = {file, record->manifest.id, e.reason(), e.detail()};
    }
    records_.push_back(std::move(record));
}

void Registry::add(const toile_entry& entry, Manifest manifest) {
    auto record = std::make_unique<Record>();
    record->linked = &entry;
    record->plugin = Plugin::link(entry, manifest);
    record->manifest = std::move(manifest);
    records_.push_back(std::move(record));
}

std::shared_ptr<const Plugin> Registry::load(Record& record) {
    if (record.plugin != nullptr || record.refusal) return record.plugin;
    try {
        if (!record.trusted && options_.trial)
            try_opening(record.manifest, options_.trial_timeout_s);
        auto plugin = Plugin::load(record.manifest);
        // An instance is made once, to see that it offers what the manifest promises.
        { const Instance trial(plugin, *services_); }
        record.plugin = std::move(plugin);
    } catch (const PluginRefused& e) {
        record.refusal = {record.manifest.file, record.manifest.id, e.reason(), e.detail()};
        log::debug(e.what());
    }
    return record.plugin;
}

void Registry::load_all() {
    for (const auto& record : records_)
        (void)load(*record);
}

std::vector<Registry::Record*> Registry::ranked(const std::string& kind) const {
    std::vector<Record*> out;
    for (const auto& record : records_)
        if (!record->refusal && (kind.empty() || record->manifest.provides_kind(kind)))
            out.push_back(record.get());
    std::sort(out.begin(), out.end(), [](const Record* a, const Record* b) {
        if (a->manifest.priority != b->manifest.priority)
            return a->manifest.priority > b->manifest.priority;
        return a->manifest.id < b->manifest.id;
    });
    return out;
}

std::shared_ptr<const Plugin> Registry::find(const std::string& kind, const std::string& id) {
    for (Record* record : ranked(kind)) {
        if (!id.empty() && record->manifest.id != id) continue;
        if (auto plugin = load(*record)) return plugin;
        log::warning(record->manifest.file.string() + ": " + record->refusal->text);
    }
    const std::string wanted = id.empty() ? "" : " with the id '" + id + "'";
    std::string why = "; see `toile plugin list`";
    for (const auto& record : records_)
        if (record->refusal && !id.empty() && record->refusal->id == id)
            why = ": " + record->refusal->file.string() + ": " + record->refusal->text;
    throw Error("no plugin" + wanted + " for '" + kind + "'" + why);
}

std::shared_ptr<const Plugin> Registry::find_scheme(const std::string& scheme) {
    std::string known;
    for (Record* record : ranked("")) {
        for (const std::string& served : record->manifest.schemes)
            known += (known.empty() ? "" : ", ") + served + ":";
        if (!record->manifest.serves_scheme(scheme)) continue;
        if (auto plugin = load(*record)) return plugin;
        log::warning(record->manifest.file.string() + ": " + record->refusal->text);
    }
    throw Error("no plugin serves the source '" + scheme + ":'; known are " +
                (known.empty() ? "none" : known));
}

std::vector<Manifest> Registry::manifests(const std::string& kind) const {
    std::vector<Manifest> out;
    for (const Record* record : ranked(kind))
        out.push_back(record->manifest);
    return out;
}

std::vector<RefusedPlugin> Registry::refused() const {
    std::vector<RefusedPlugin> out;
    for (const auto& record : records_)
        if (record->refusal) out.push_back(*record->refusal);
    return out;
}

} // namespace toile::host
