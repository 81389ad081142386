// toile plugin list|check
#include "apps/commands.h"
#include "core/error.h"
#include "host/registry.h"
#include "host/trial.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace toile::apps {
namespace {

std::string joined(const std::vector<std::string>& texts) {
    std::string out;
    for (const std::string& text : texts)
        out += (out.empty() ? "" : ", ") + text;
    return out;
}

nlohmann::ordered_json to_json(const host::Registry& registry) {
    nlohmann::ordered_json out;
    out["loaded"] = nlohmann::ordered_json::array();
    for (const host::Manifest& m : registry.manifests())
        out["loaded"].push_back({{"id", m.id},
                                 {"version", m.version},
                                 {"provides", m.provides},
                                 {"schemes", m.schemes},
                                 {"priority", m.priority},
                                 {"licence", m.licence},
                                 {"file", m.file.string()}});
    out["refused"] = nlohmann::ordered_json::array();
    for (const host::RefusedPlugin& r : registry.refused())
        out["refused"].push_back({{"id", r.id},
                                  {"reason", host::refusal_name(r.reason)},
                                  {"text", r.text},
                                  {"file", r.file.string()}});
    return out;
}

void list(const GlobalOptions& options, bool json) {
    host::Services services(options.threads);
    host::Registry registry(services, {.folders = options.plugin_folders});
    registry.load_all();
    if (json) {
        std::cout << to_json(registry).dump(2) << '\n';
        return;
    }
    for (const host::Manifest& m : registry.manifests())
        std::cout << "loaded   " << m.id << ' ' << m.version << ": " << joined(m.provides)
                  << (m.schemes.empty() ? "" : "; serves " + joined(m.schemes)) << '\n';
    for (const host::RefusedPlugin& r : registry.refused())
        std::cout << "refused  " << (r.id.empty() ? "" : r.id + ": ") << r.file.string() << ": "
                  << r.text << " [" << host::refusal_name(r.reason) << "]\n";
    if (registry.manifests().empty() && registry.refused().empty())
        std::cout << "no plugins found; give a folder with --plugins or TOILE_PLUGIN_PATH\n";
}

void check(const std::string& path, double timeout_s) {
    try {
        for (const auto& file : host::manifests_of(path)) {
            const host::Manifest manifest = host::read_manifest(file);
            host::try_contract(manifest, timeout_s);
            std::cout << file.string() << ": good: " << manifest.id << ' ' << manifest.version
                      << " keeps the rules of " << joined(manifest.provides) << '\n';
        }
    } catch (const host::PluginRefused& e) {
        throw Error(std::string(e.what()) + " [" + std::string(host::refusal_name(e.reason())) +
                    "]");
    }
}

struct Settings {
    bool json = false;
    std::string path;
    double timeout_s = 30.0;
};

} // namespace

void add_plugin_commands(CLI::App& app, const GlobalOptions& options) {
    CLI::App* group = app.add_subcommand("plugin", "See and check plugins");
    group->require_subcommand(1);
    const auto settings = std::make_shared<Settings>();

    CLI::App* lister = group->add_subcommand("list", "Plugins in use, and those refused with why");
    lister->add_flag("--json", settings->json, "Machine-readable");
    lister->footer("Example: toile plugin list --plugins ./my-plugins");
    lister->callback([&options, settings] { list(options, settings->json); });

    CLI::App* checker = group->add_subcommand(
        "check", "Try a plugin in a child process: load it and run the rules of its kinds");
    checker->add_option("file", settings->path, "plugin.json, library or folder of a plugin")
        ->required();
    checker->add_option("--timeout", settings->timeout_s, "Seconds after which it counts as hung")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    checker->footer("Example: toile plugin check my-plugins/skin/plugin.json --timeout 10");
    checker->callback([settings] { check(settings->path, settings->timeout_s); });
}

} // namespace toile::apps
