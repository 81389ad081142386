// A loaded plugin: its library passed the entry gate, and its descriptor agrees with plugin.json.
#pragma once

#include "abi/plugin.h"
#include "host/manifest.h"

#include <memory>

namespace toile::host {

/// Libraries stay loaded while the program runs. [main]
class Plugin {
  public:
    /// Opens the library of a manifest: gates 2 and 3 up to the descriptor. \throw PluginRefused
    [[nodiscard]] static std::shared_ptr<const Plugin> load(Manifest manifest);
    /// The same for an entry that is linked in (`manifest.file` stays empty). \throw PluginRefused
    [[nodiscard]] static std::shared_ptr<const Plugin> link(const toile_entry& entry,
                                                            Manifest manifest);

    [[nodiscard]] const Manifest& manifest() const noexcept { return manifest_; }
    [[nodiscard]] const std::string& id() const noexcept { return manifest_.id; }
    [[nodiscard]] const toile_entry& entry() const noexcept { return *entry_; }
    [[nodiscard]] const toile_descriptor& descriptor() const noexcept { return *descriptor_; }
    /// What stands in front of error texts: the manifest's path, or the id of one linked in.
    [[nodiscard]] std::string shown() const;

  private:
    Plugin(Manifest manifest, const toile_entry& entry);

    Manifest manifest_;
    const toile_entry* entry_;
    const toile_descriptor* descriptor_ = nullptr;
};

} // namespace toile::host
