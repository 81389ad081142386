// Every rule of every kind, run on every plugin that stands beside the program.
#include "host/contract.h"
#include "host/registry.h"

#include <cctype>
#include <gtest/gtest.h>

namespace toile::host {
namespace {

struct Param {
    std::string plugin;
    std::size_t rule;
};

Registry& stock() {
    static Services services(2);
    static Registry registry(services, {.environment = false});
    return registry;
}

// A test's name may hold letters, digits and underscores only.
std::string as_name(const std::string& text) {
    std::string out;
    for (const char c : text)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    return out;
}

std::vector<Param> all() {
    std::vector<Param> out;
    for (const Manifest& manifest : stock().manifests())
        for (std::size_t rule = 0; rule < contract_cases().size(); ++rule)
            if (applies(contract_cases()[rule], manifest)) out.push_back({manifest.id, rule});
    return out;
}

class Contract : public ::testing::TestWithParam<Param> {};

TEST_P(Contract, Holds) {
    std::shared_ptr<const Plugin> plugin;
    for (const Manifest& manifest : stock().manifests())
        if (manifest.id == GetParam().plugin)
            plugin = stock().find(manifest.provides.front(), manifest.id);
    ASSERT_NE(plugin, nullptr);
    EXPECT_NO_THROW(run_contract_case(contract_cases()[GetParam().rule], plugin));
}

INSTANTIATE_TEST_SUITE_P(Stock, Contract, ::testing::ValuesIn(all()), [](const auto& tested) {
    return as_name(tested.param.plugin + " " + contract_cases()[tested.param.rule].name);
});

TEST(StockPlugins, NoneIsRefused) {
    stock().load_all();
    for (const RefusedPlugin& refused : stock().refused())
        ADD_FAILURE() << refused.file << ": " << refused.text;
    EXPECT_FALSE(stock().manifests().empty());
}

} // namespace
} // namespace toile::host
