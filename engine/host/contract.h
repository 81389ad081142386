// The rules of every kind as runnable cases: `toile plugin check` and tests/plugins run them.
#pragma once

#include "host/plugin.h"

#include <span>

namespace toile::host {

/// One rule. Cases are independent: each makes instances of its own on tiny made-up inputs (a
/// capsule figure, a tube of cloth).
struct ContractCase {
    const char* kind; ///< "toile.skinning/1"; empty: every plugin
    const char* name; ///< "pose: the rest pose gives the rest surface"
    void (*run)(const std::shared_ptr<const Plugin>& plugin);
};

/// All cases, in the order in which they are tried.
[[nodiscard]] std::span<const ContractCase> contract_cases();

/// Does the case apply to a plugin?
[[nodiscard]] bool applies(const ContractCase& rule, const Manifest& manifest);

/// \throw PluginRefused when the rule is broken: call_failed, call_threw, non_finite or
/// contract_broken
void run_contract_case(const ContractCase& rule, const std::shared_ptr<const Plugin>& plugin);

} // namespace toile::host
