#include "apps/catalogue_results.h"

#include "core/bytes.h"
#include "core/error.h"

#include <algorithm>
#include <array>

namespace toile::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kWorst = {"deep_fraction_max", "skin_visible_max",
                                               "self_intersections", "strain_rms"};

/// All items of one look.
struct Row {
    std::string garments;
    CatalogueCounts counts;
    std::array<double, kWorst.size()> worst{}, sum{};
    std::array<std::size_t, kWorst.size()> beyond{}; ///< items above the limit of each figure
};

struct Told {
    const CatalogueItem* item;
    ItemRecord record;
    std::vector<std::string> beyond;
};

void count(CatalogueCounts& counts, const Told& told) {
    ++counts.items;
    counts.done += told.record.state == ItemState::done ? 1 : 0;
    counts.failed += told.record.state == ItemState::failed ? 1 : 0;
    counts.missing += told.record.state == ItemState::missing ? 1 : 0;
    counts.beyond += told.beyond.empty() ? 0 : 1;
}

std::vector<Row> rows_of(const CataloguePlan& plan, const std::vector<Told>& all) {
    std::vector<Row> rows;
    std::vector<std::string> looks = plan.garments;
    for (const CatalogueItem& look : plan.looks)
        if (std::find(looks.begin(), looks.end(), look.garments) == looks.end())
            looks.push_back(look.garments);
    for (const std::string& garments : looks) {
        Row& row = rows.emplace_back();
        row.garments = garments;
        for (const Told& told : all) {
            if (told.item->garments != garments) continue;
            count(row.counts, told);
            for (std::size_t i = 0; i < kWorst.size(); ++i) {
                const double value = told.record.figure(kWorst[i]).value_or(0.0);
                row.worst[i] = std::max(row.worst[i], value);
                row.sum[i] += value;
            }
            for (const std::string& text : told.beyond)
                for (std::size_t i = 0; i < kWorst.size(); ++i)
                    row.beyond[i] += text.starts_with(kWorst[i]) ? 1 : 0;
        }
    }
    return rows;
}

std::string line(const char* format, auto... values) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

std::string cell(const Row& row, std::size_t figure) {
    const double mean =
        row.counts.done > 0 ? row.sum[figure] / static_cast<double>(row.counts.done) : 0.0;
    return line(" %.3f / %.3f | %zu |", 100.0 * mean, 100.0 * row.worst[figure],
                row.beyond[figure]);
}

std::string summary(const CataloguePlan& plan, const std::vector<Told>& all) {
    std::string out =
        "| look | items | failed | missing | deep %, mean / worst | over | skin shown "
        "%, mean / worst | over | cut triangles %, mean / worst | over | strain rms "
        "%, mean / worst | over |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows_of(plan, all)) {
        out += line("| %s | %zu | %zu | %zu |", row.garments.c_str(), row.counts.items,
                    row.counts.failed, row.counts.missing);
        for (std::size_t i = 0; i < kWorst.size(); ++i)
            out += cell(row, i);
        out += "\n";
    }
    std::string list;
    for (const Told& told : all) {
        std::string what = told.record.state == ItemState::failed ? "failed: " + told.record.error
                           : told.record.state == ItemState::missing ? "not made"
                                                                     : "";
        for (const std::string& text : told.beyond)
            what += (what.empty() ? "" : ", ") + text;
        if (!what.empty()) list += "- " + told.item->id + ": " + what + "\n";
    }
    return out +
           (list.empty() ? "" : "\nEach that failed, is missing or is over a limit:\n\n" + list);
}

Json json_of(const Told& told) {
    Json json;
    json["id"] = told.item->id;
    json["state"] = told.record.state == ItemState::done     ? "done"
                    : told.record.state == ItemState::failed ? "failed"
                                                             : "missing";
    if (!told.record.error.empty()) json["error"] = told.record.error;
    for (const char* key : {"worn", "figures", "failures"})
        if (told.record.json.contains(key)) json[key] = told.record.json[key];
    if (!told.beyond.empty()) json["beyond"] = told.beyond;
    return json;
}

} // namespace

CatalogueCounts write_results(const CataloguePlan& plan, const std::vector<CatalogueItem>& items) {
    std::vector<Told> all;
    CatalogueCounts counts;
    for (const CatalogueItem& item : items) {
        Told& told = all.emplace_back(Told{&item, read_record(plan, item), {}});
        told.beyond = beyond_limits(plan, told.record);
        count(counts, told);
    }
    Json json;
    json["schema"] = 1;
    json["items"] = counts.items;
    json["done"] = counts.done;
    json["failed"] = counts.failed;
    json["missing"] = counts.missing;
    json["beyond_limits"] = counts.beyond;
    for (const Told& told : all)
        json["list"].push_back(json_of(told));
    write_text(plan.out / "results.json", json.dump(1) + "\n");
    write_text(plan.out / "summary.md", summary(plan, all));
    return counts;
}

} // namespace toile::apps
