// All plugins that were found: those that can be used, and those refused with the reason.
#pragma once

#include "host/plugin.h"
#include "host/services.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace toile::host {

struct RegistryOptions {
    std::vector<std::filesystem::path> folders = {}; ///< --plugins; looked at first
    bool environment = true;    ///< then the folders of TOILE_PLUGIN_PATH (a:b)
    bool beside_program = true; ///< then `plugins` beside the program
    /// Libraries of the first two come from elsewhere: they are tried in a child process before
    /// they are opened here. False opens them at once.
    bool trial = true;
    double trial_timeout_s = 10.0;
};

/// A plugin that is not used, and why.
struct RefusedPlugin {
    std::filesystem::path file; ///< its manifest
    std::string id;             ///< empty when the manifest does not tell
    Refusal reason = Refusal::invalid;
    std::string text; ///< one line, without the file
};

/// Discovery reads manifests only; a library is opened when it is first asked for. Of two
/// manifests with one id the first found counts. [main]
class Registry {
  public:
    /// \throw Error when a folder of `options.folders` does not exist
    explicit Registry(Services& services, RegistryOptions options = {});
    ~Registry();
    Registry(const Registry&) = delete;
    Registry& operator=(const Registry&) = delete;

    /// Adds a plugin that is linked in (tests). \throw PluginRefused
    void add(const toile_entry& entry, Manifest manifest);

    /// Opens every library, so that `refused` is complete.
    void load_all();

    /// The plugin that serves a kind: the one named by `id`, else the highest priority of those
    /// that load (one that is refused is passed over with a warning).
    /// \throw Error naming the kind and what was refused
    std::shared_ptr<const Plugin> find(const std::string& kind, const std::string& id = "");
    /// The plugin that serves a source URI's scheme ("kinect-log"), and which kind it does it as.
    /// \throw Error listing the known schemes
    std::shared_ptr<const Plugin> find_scheme(const std::string& scheme);

    /// Manifests that passed gate 1 and whose library is not refused so far, best first by
    /// priority, then by id; all kinds when `kind` is empty.
    [[nodiscard]] std::vector<Manifest> manifests(const std::string& kind = "") const;
    [[nodiscard]] std::vector<RefusedPlugin> refused() const;

  private:
    struct Record;
    void discover(const std::filesystem::path& root, bool trusted);
    void read(const std::filesystem::path& manifest, bool trusted);
    std::shared_ptr<const Plugin> load(Record& record);
    std::vector<Record*> ranked(const std::string& kind) const;

    Services* services_;
    RegistryOptions options_;
    std::vector<std::unique_ptr<Record>> records_;
};

} // namespace toile::host
