#include "host/contract.h"

#include "host/contract_bench.h"

#include <algorithm>
#include <cmath>

namespace toile::host {

Bench::Bench(const std::shared_ptr<const Plugin>& plugin, std::uint32_t threads)
    : shown_(plugin->shown()), services_(threads),
      instance_(std::make_unique<Instance>(plugin, services_)) {}

void Bench::activate() {
    auto limits = sized<toile_limits>();
    limits.max_people = 1;
    limits.max_vertices = 100'000;
    limits.max_triangles = 200'000;
    limits.thread_count = services_.thread_count();
    limits.frame_budget_s = 1.0 / 30;
    limits.random_seed = 1;
    try {
        instance_->activate(limits);
    } catch (const Error& e) {
        throw PluginRefused(Refusal::call_failed, shown_, e.what());
    }
}

PluginRefused Bench::failed(const char* what, toile_status status) {
    const std::string text = instance_->take_error();
    return {Refusal::call_failed, shown_,
            std::string(what) + ": failed with " + status_text(status) +
                (text.empty() ? "" : ": " + text)};
}

void Bench::must_have_failed(const char* what, const char* when, toile_status status) {
    rule(status < 0, std::string(what) + ": answers " + status_text(status) + " " + when +
                         ", an error was wanted");
    rule(!instance_->take_error().empty(),
         std::string(what) + ": reports no text for its error " + when);
}

void Bench::finite(const char* what, std::span<const float> values) const {
    if (!all_finite(values))
        throw PluginRefused(Refusal::non_finite, shown_,
                            std::string(what) + ": returns numbers that are not finite");
}

void Bench::finite(const char* what, const std::vector<Float3>& rows) const {
    finite(what, std::span(rows.empty() ? nullptr : rows[0].data(), rows.size() * 3));
}

void Bench::rule(bool holds, const std::string& text) const {
    if (!holds) throw PluginRefused(Refusal::contract_broken, shown_, text);
}

double Bench::distance(const std::vector<Float3>& a, const std::vector<Float3>& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k)
            square += std::pow(double{a[i][k]} - double{b[i][k]}, 2);
        worst = std::max(worst, std::sqrt(square));
    }
    return worst;
}

std::span<const ContractCase> contract_cases() {
    static const std::vector<ContractCase> all = [] {
        std::vector<ContractCase> out;
        for (const auto part :
             {life_cases(), skinning_cases(), garment_cases(), cloth_cases(), body_source_cases(),
              sensor_cases(), tool_cases(), resizer_cases(), scanner_cases()})
            out.insert(out.end(), part.begin(), part.end());
        return out;
    }();
    return all;
}

bool applies(const ContractCase& rule, const Manifest& manifest) {
    return rule.kind[0] == '\0' || manifest.provides_kind(rule.kind);
}

void run_contract_case(const ContractCase& rule, const std::shared_ptr<const Plugin>& plugin) {
    try {
        rule.run(plugin);
    } catch (const PluginRefused&) {
        throw;
    } catch (const std::exception& e) {
        throw PluginRefused(Refusal::contract_broken, plugin->shown(),
                            std::string(rule.name) + ": " + e.what());
    }
}

} // namespace toile::host
