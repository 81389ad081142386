// The host as a plugin instance sees it.
#pragma once

#include "abi/host.h"

#include <string>

namespace toile::sdk {

/// Borrowed; outlives the instance. Cheap to copy. [any thread]
class Host {
  public:
    explicit Host(const toile_host* host) noexcept : host_(host) {}

    void debug(const std::string& text) const noexcept { report(TOILE_LOG_DEBUG, TOILE_OK, text); }
    void info(const std::string& text) const noexcept { report(TOILE_LOG_INFO, TOILE_OK, text); }
    void warning(const std::string& text) const noexcept {
        report(TOILE_LOG_WARNING, TOILE_OK, text);
    }
    void report(std::int32_t level, toile_status status, const std::string& text) const noexcept {
        if (host_ != nullptr) host_->report(host_, level, status, text.c_str());
    }
    /// A table of the host's, e.g. extension<toile_thread_pool>(TOILE_THREAD_POOL); or null.
    template <class Table>
    [[nodiscard]] const Table* extension(const char* id) const noexcept {
        if (host_ == nullptr) return nullptr;
        return static_cast<const Table*>(host_->get_extension(host_, id));
    }
    [[nodiscard]] const toile_host* handle() const noexcept { return host_; }

  private:
    const toile_host* host_;
};

} // namespace toile::sdk
