#include "host/refusal.h"

#include <array>
#include <utility>

namespace toile::host {
namespace {

constexpr auto kNames = std::to_array<std::pair<Refusal, std::string_view>>({
    {Refusal::manifest_unreadable, "manifest_unreadable"},
    {Refusal::manifest_abi_major, "manifest_abi_major"},
    {Refusal::manifest_abi_newer, "manifest_abi_newer"},
    {Refusal::manifest_invalid, "manifest_invalid"},
    {Refusal::manifest_unknown_key, "manifest_unknown_key"},
    {Refusal::kind_unknown, "kind_unknown"},
    {Refusal::need_unknown, "need_unknown"},
    {Refusal::duplicate_id, "duplicate_id"},
    {Refusal::library_missing, "library_missing"},
    {Refusal::library_not_shared_object, "library_not_shared_object"},
    {Refusal::library_wrong_architecture, "library_wrong_architecture"},
    {Refusal::library_truncated, "library_truncated"},
    {Refusal::library_unloadable, "library_unloadable"},
    {Refusal::undefined_symbol, "undefined_symbol"},
    {Refusal::entry_missing, "entry_missing"},
    {Refusal::entry_short, "entry_short"},
    {Refusal::entry_abi_major, "entry_abi_major"},
    {Refusal::entry_abi_newer, "entry_abi_newer"},
    {Refusal::entry_incomplete, "entry_incomplete"},
    {Refusal::init_failed, "init_failed"},
    {Refusal::init_threw, "init_threw"},
    {Refusal::descriptor_short, "descriptor_short"},
    {Refusal::descriptor_disagrees, "descriptor_disagrees"},
    {Refusal::create_failed, "create_failed"},
    {Refusal::instance_short, "instance_short"},
    {Refusal::instance_incomplete, "instance_incomplete"},
    {Refusal::kind_missing, "kind_missing"},
    {Refusal::table_short, "table_short"},
    {Refusal::call_missing, "call_missing"},
    {Refusal::trial_impossible, "trial_impossible"},
    {Refusal::crashed, "crashed"},
    {Refusal::aborted, "aborted"},
    {Refusal::exited, "exited"},
    {Refusal::hung, "hung"},
    {Refusal::call_failed, "call_failed"},
    {Refusal::call_threw, "call_threw"},
    {Refusal::non_finite, "non_finite"},
    {Refusal::contract_broken, "contract_broken"},
});

} // namespace

std::string_view refusal_name(Refusal reason) {
    for (const auto& [value, name] : kNames)
        if (value == reason) return name;
    return "invalid";
}

Refusal refusal_from_name(std::string_view name) {
    for (const auto& [value, known] : kNames)
        if (known == name) return value;
    return Refusal::invalid;
}

} // namespace toile::host
