// Rules for every plugin: its life, and the extensions it may offer beside its kinds.
#include "host/contract_bench.h"

#include <set>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

void lives_repeatedly(const PluginPtr& plugin) {
    for (int life = 0; life < 2; ++life) {
        Bench bench(plugin);
        for (int turn = 0; turn < 3; ++turn) {
            bench.activate();
            bench.instance().reset();
            bench.instance().deactivate();
        }
    }
}

void lives_side_by_side(const PluginPtr& plugin) {
    Bench first(plugin);
    first.activate();
    {
        Bench second(plugin);
        second.rule(first.instance().handle() != second.instance().handle(),
                    "create: gives the same instance twice");
        second.activate();
    }
    first.instance().reset();
}

void describes_itself(const PluginPtr& plugin) {
    Bench bench(plugin);
    const toile_descriptor* said = bench.instance().handle()->descriptor;
    bench.rule(said != nullptr && said->id != nullptr && plugin->id() == said->id,
               "create: the instance's descriptor is not that of '" + plugin->id() + "'");
}

void knows_no_strangers(const PluginPtr& plugin) {
    Bench bench(plugin);
    toile_instance* i = bench.instance().handle();
    bench.rule(i->get_extension(i, "toile.no_such_kind/1") == nullptr,
               "get_extension: gives a table for an id that nobody knows");
    bench.rule(plugin->entry().create(nullptr, "no.such.plugin") == nullptr,
               "create: makes an instance of an id that it does not describe");
    bench.rule(plugin->entry().describe(UINT32_MAX) == nullptr,
               "describe: gives a descriptor for an index beyond count");
}

void has_sound_parameters(const PluginPtr& plugin) {
    Bench bench(plugin);
    const auto* table = bench.instance().find<toile_parameters>();
    if (table == nullptr) return;
    std::set<std::string> ids;
    const std::uint32_t count = table->count(bench.instance().handle());
    for (std::uint32_t k = 0; k < count; ++k) {
        auto p = sized<toile_parameter>();
        bench.ok("parameters describe", [&](auto* i) { return table->describe(i, k, &p); });
        bench.rule(p.id != nullptr && p.unit != nullptr && p.text != nullptr && p.type >= 1 &&
                       p.type <= 3 && ids.insert(p.id).second,
                   "parameters describe: a null text, an unknown type or an id twice");
        const std::string name = "parameter '" + std::string(p.id) + "': ";
        bench.rule(p.minimum <= p.default_value && p.default_value <= p.maximum,
                   name + "the default lies outside the range");
        double value = 0;
        bench.ok("parameters get", [&](auto* i) { return table->get(i, p.id, &value); });
        bench.rule(value == p.default_value, name + "a fresh instance does not have the default");
        bench.ok("parameters set", [&](auto* i) { return table->set(i, p.id, p.maximum); });
        bench.ok("parameters get", [&](auto* i) { return table->get(i, p.id, &value); });
        bench.rule(value == p.maximum, name + "does not keep what was set");
        bench.fails("parameters set", "beyond the range",
                    [&](auto* i) { return table->set(i, p.id, p.maximum + 1); });
    }
    double value = 0;
    bench.fails("parameters get", "for an unknown id",
                [&](auto* i) { return table->get(i, "no_such_parameter", &value); });
}

constexpr ContractCase kCases[] = {
    {"", "life: create, activate, reset, deactivate, destroy, again and again", &lives_repeatedly},
    {"", "life: two instances side by side", &lives_side_by_side},
    {"", "life: the instance tells which plugin it is", &describes_itself},
    {"", "life: unknown ids get nothing", &knows_no_strangers},
    {"", "parameters: ranges, defaults and errors", &has_sound_parameters},
};

} // namespace

std::span<const ContractCase> life_cases() {
    return kCases;
}

} // namespace toile::host
