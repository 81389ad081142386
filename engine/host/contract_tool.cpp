// Rules of toile.tool/1: a command that can be listed, read and refused.
#include "host/contract_bench.h"

#include <cmath>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

bool filled(const char* text) {
    return text != nullptr && text[0] != '\0';
}

void describes(const PluginPtr& plugin) {
    Bench bench(plugin);
    auto info = sized<toile_tool_info>();
    bench.ok("describe", [&](auto* i) { return bench.table<toile_tool>().describe(i, &info); });
    bench.rule(filled(info.command) && filled(info.summary) && filled(info.example),
               "describe: no command, summary or example");
    // One linked in has no manifest of its own.
    const Manifest& manifest = plugin->manifest();
    bench.rule(manifest.command.empty() || manifest.command == info.command,
               "describe: another command than the manifest's");
}

void options_are_whole(const PluginPtr& plugin) {
    Bench bench(plugin);
    auto info = sized<toile_tool_info>();
    bench.ok("describe", [&](auto* i) { return bench.table<toile_tool>().describe(i, &info); });
    bench.rule(info.option_count == 0 || info.options != nullptr, "describe: no list of options");
    const auto* bytes = reinterpret_cast<const char*>(info.options);
    for (std::uint32_t k = 0; k < info.option_count; ++k) {
        const auto& option =
            *reinterpret_cast<const toile_tool_option*>(bytes + k * info.options->size);
        const std::string which = "describe: option " + std::to_string(k);
        bench.rule(filled(option.name) && filled(option.text), which + " has no name or text");
        bench.rule(option.type > TOILE_OPTION_INVALID && option.type <= TOILE_OPTION_OUTPUT,
                   which + " has an unknown type");
        const bool number = option.type == TOILE_OPTION_REAL || option.type == TOILE_OPTION_INTEGER;
        bench.rule(!number || option.minimum <= option.maximum, which + " has no range");
    }
}

void refuses_wrong_calls(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_tool>();
    bench.fails("describe", "without a place to write to",
                [&](auto* i) { return table.describe(i, nullptr); });
    bench.fails("run", "without words", [&](auto* i) { return table.run(i, 1, nullptr, nullptr); });
    const char* nothing = nullptr;
    bench.fails("run", "with a word that is null",
                [&](auto* i) { return table.run(i, 1, &nothing, nullptr); });
}

constexpr ContractCase kCases[] = {
    {TOILE_TOOL, "tool: describes its command", &describes},
    {TOILE_TOOL, "tool: its options are whole", &options_are_whole},
    {TOILE_TOOL, "tool: wrong calls are refused with a text", &refuses_wrong_calls},
};

} // namespace

std::span<const ContractCase> tool_cases() {
    return kCases;
}

} // namespace toile::host
