// Rules of the kinds that are still drafts: that wrong calls come back with a text.
#include "host/contract_bench.h"

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

void scanner_refuses(const PluginPtr& plugin) {
    Bench bench(plugin);
    bench.activate();
    const auto& table = bench.table<toile_scanner>();
    bench.fails("feed", "before begin", [&](auto* i) { return table.feed(i, nullptr, 0); });
    bench.fails("finish", "without a sink",
                [&](auto* i) { return table.finish(i, nullptr, nullptr); });
}

constexpr ContractCase kCases[] = {
    {TOILE_SCANNER, "scanner: wrong calls are refused with a text", &scanner_refuses},
};

} // namespace

std::span<const ContractCase> draft_cases() {
    return kCases;
}

} // namespace toile::host
