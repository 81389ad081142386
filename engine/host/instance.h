// One instance of a plugin and its life: create, init, activate, calls, deactivate, destroy.
#pragma once

#include "host/job.h"
#include "host/kinds.h"
#include "host/plugin.h"
#include "host/services.h"

#include <map>
#include <vector>

namespace toile::host {

/// Owns the instance; deactivates and destroys it at the end. Not copied, not moved.
class Instance {
  public:
    /// Creates, inits and fetches the tables of every kind promised: the rest of gate 3.
    /// `services` must outlive this. \throw PluginRefused [main]
    Instance(std::shared_ptr<const Plugin> plugin, Services& services);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    [[nodiscard]] const std::string& id() const noexcept { return plugin_->id(); }
    [[nodiscard]] const Plugin& plugin() const noexcept { return *plugin_; }
    [[nodiscard]] toile_instance* handle() const noexcept { return instance_; }

    /// \throw Error with the text that the plugin reported [main]
    void activate(const toile_limits& limits);
    void deactivate() noexcept; ///< [main]
    void reset() noexcept;      ///< [frame]
    [[nodiscard]] bool active() const noexcept { return active_; }

    /// The calls of a kind or extension; those that an older plugin lacks are null. Null when the
    /// plugin does not offer it. Stays valid. \throw PluginRefused for a broken table
    template <class Table>
    [[nodiscard]] const Table* find() {
        return static_cast<const Table*>(find(KindOf<Table>::id));
    }
    /// The same for a kind that must be there. \throw Error naming it
    template <class Table>
    [[nodiscard]] const Table& table() {
        return *static_cast<const Table*>(require(KindOf<Table>::id));
    }

    /// A set-up call: work(toile_instance*) -> toile_status, which is returned when >= 0.
    /// \throw Cancelled, Error "plugin.id: what: reported text"
    template <class Work>
    toile_status call(const char* what, const Work& work) {
        try {
            return checked(work(instance_), what);
        } catch (const Error&) {
            throw;
        } catch (...) {
            throw threw(what);
        }
    }
    /// A call of the per-frame path: whatever it throws is TOILE_E_INTERNAL. [frame]
    template <class Work>
    toile_status frame(const Work& work) noexcept {
        try {
            return work(instance_);
        } catch (...) {
            return TOILE_E_INTERNAL;
        }
    }
    /// The last error that the plugin reported, forgotten then; empty when none.
    [[nodiscard]] std::string take_error() { return host_.take_error(); }

  private:
    const void* find(const char* id);
    const void* require(const char* id);
    void fetch_table(const KindInfo& kind, const void* table);
    void create();
    toile_status checked(toile_status status, const char* what);
    [[nodiscard]] Error threw(const char* what) const;

    std::shared_ptr<const Plugin> plugin_;
    InstanceHost host_;
    toile_instance* instance_ = nullptr;
    bool active_ = false;
    std::map<std::string, std::vector<void*>> tables_; // padded with nulls to this build's size
};

} // namespace toile::host
