#include "pipeline/run_report.h"

#include "core/error.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace toile::pipeline {
namespace {

nlohmann::ordered_json to_json(const Quantiles& q) {
    return {{"median_ms", q.median_ms}, {"p95_ms", q.p95_ms}, {"max_ms", q.max_ms}};
}

nlohmann::ordered_json to_json(const Latency& latency) {
    return {{"median_ms", latency.median_ms}, {"p95_ms", latency.p95_ms}};
}

std::string row(const std::string& name, const Quantiles& q) {
    std::array<char, 96> line{};
    std::snprintf(line.data(), line.size(), "%-10s %10.2f %10.2f %10.2f\n", name.c_str(),
                  q.median_ms, q.p95_ms, q.max_ms);
    return line.data();
}

} // namespace

void write_report(const RunReport& report, const std::filesystem::path& file) {
    nlohmann::ordered_json json;
    json["frames"] = report.frames;
    json["dropped"] = report.dropped;
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const std::string name(stage_name(static_cast<Stage>(i)));
        const auto found = report.stages.find(name);
        if (found != report.stages.end()) json["stages"][name] = to_json(found->second);
    }
    json["compute"] = to_json(report.compute);
    if (report.picture_latency) json["latency"]["picture"] = to_json(*report.picture_latency);
    if (report.garment_state_latency)
        json["latency"]["garment_state"] = to_json(*report.garment_state_latency);
    if (report.contact) {
        const ContactWorst& worst = *report.contact;
        json["garment"] = {
            {"deep_fraction_max", worst.deep_fraction},
            {"deep_fraction_max_frame", worst.deep_frame},
            {"deepest_max_m", worst.deepest_m},
            {"deep_fraction_self_intersecting_max", worst.deep_fraction_apart},
        };
        json["skin"] = {
            {"visible_fraction_max", worst.visible_fraction},
            {"visible_fraction_max_frame", worst.visible_frame},
            {"visible_fraction_self_intersecting_max", worst.visible_fraction_apart},
        };
    }
    json["garment"]["positions_digest"] = report.positions_digest;
    json["versions"] = report.versions;
    json["seed"] = report.seed;
    std::ofstream out(file, std::ios::binary);
    out << json.dump(2) << "\n";
    out.flush();
    if (!out) throw FileError(file.string(), "the report cannot be written");
}

std::string report_table(const RunReport& report) {
    std::string text = "stage       median ms     p95 ms     max ms\n";
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const std::string name(stage_name(static_cast<Stage>(i)));
        const auto found = report.stages.find(name);
        if (found != report.stages.end()) text += row(name, found->second);
    }
    return text + row("compute", report.compute);
}

} // namespace toile::pipeline
