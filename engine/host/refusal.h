// Why a plugin is not used: one value per reason, each with a bad plugin in tests/abi.
#pragma once

#include "core/error.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace toile::host {

enum class Refusal : std::uint8_t {
    invalid,
    // gate 1: the manifest, before the library is opened
    manifest_unreadable,
    manifest_abi_major,
    manifest_abi_newer,
    manifest_invalid,
    manifest_unknown_key,
    kind_unknown, ///< a kind or revision of one that this engine does not know
    need_unknown,
    duplicate_id,
    // the library's file
    library_missing,
    library_not_shared_object,
    library_wrong_architecture,
    library_truncated,
    library_unloadable,
    undefined_symbol,
    // gate 2: the entry
    entry_missing,
    entry_short,
    entry_abi_major,
    entry_abi_newer,
    entry_incomplete,
    init_failed,
    init_threw,
    // gate 3: sizes and revisions of what the entry gives
    descriptor_short,
    descriptor_disagrees,
    create_failed,
    instance_short,
    instance_incomplete,
    kind_missing,
    table_short,
    call_missing,
    // trial in a child process
    trial_impossible,
    crashed,
    aborted,
    exited,
    hung,
    call_failed,
    call_threw,
    non_finite,
    contract_broken,
};

/// "manifest_unreadable", as in `toile plugin list --json`.
[[nodiscard]] std::string_view refusal_name(Refusal reason);
/// `Refusal::invalid` for a name that is none.
[[nodiscard]] Refusal refusal_from_name(std::string_view name);

/// A plugin cannot be used; the text is one line: "FILE: WHAT".
class PluginRefused : public Error {
  public:
    PluginRefused(Refusal reason, const std::string& file, const std::string& what)
        : Error(file + ": " + what), reason_(reason), what_(what) {}
    [[nodiscard]] Refusal reason() const noexcept { return reason_; }
    /// The text without the file.
    [[nodiscard]] const std::string& detail() const noexcept { return what_; }

  private:
    Refusal reason_;
    std::string what_;
};

} // namespace toile::host
