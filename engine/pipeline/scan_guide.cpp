#include "pipeline/scan_guide.h"

#include "abi/scan_guide.h"
#include "core/error.h"
#include "host/views.h"

#include <algorithm>

namespace toile::pipeline {

ScanGuide::ScanGuide(std::span<const SensorStream> streams)
    : streams_(streams.begin(), streams.end()) {}

void ScanGuide::keep(std::span<const SensorFrame> frames) {
    const std::uint32_t number = fed_++;
    if (number % stride_ != 0) return;
    kept_.push_back({number, {frames.begin(), frames.end()}});
    if (kept_.size() <= 2 * kMostInstants) return;
    stride_ *= 2;
    std::erase_if(kept_, [&](const Kept& k) { return k.number % stride_ != 0; });
}

/// The first, the last, and others evenly between.
std::vector<const ScanGuide::Kept*> ScanGuide::chosen() const {
    const std::size_t count = std::min(kept_.size(), kMostInstants);
    std::vector<const Kept*> out;
    for (std::size_t k = 0; k < count; ++k)
        out.push_back(&kept_[count == 1 ? 0 : k * (kept_.size() - 1) / (count - 1)]);
    return out;
}

nlohmann::ordered_json ScanGuide::give(host::Registry& registry, host::Services& services,
                                       const toile_limits& limits, host::Instance& scanner,
                                       host::Job& job) {
    const auto instants = chosen();
    FittedBody body;
    try {
        BodyFit fit(registry, services, limits);
        fit.begin_cameras(streams_, job);
        for (const Kept* instant : instants)
            fit.feed_frames(instant->frames);
        body = fit.fit({}, job);
    } catch (const host::Cancelled&) {
        throw;
    } catch (const Error& e) {
        return {{"instants", 0}, {"reason", e.what()}};
    }
    const auto& table = scanner.table<toile_scan_guide>();
    for (std::size_t k = 0; k < instants.size(); ++k) {
        auto rough = host::sized<toile_scan_template>();
        rough.instant = instants[k]->number;
        rough.surface = host::sized<toile_mesh>();
        rough.surface.positions = host::view_of(body.surfaces[k].positions);
        rough.surface.normals = host::view_of(body.surfaces[k].normals);
        rough.surface.triangles = host::view_of(body.surfaces[k].triangles);
        rough.surface.topology_id = 1;
        rough.part_labels = host::view_of(body.part_labels);
        scanner.call("guide", [&](toile_instance* i) { return table.guide(i, &rough); });
    }
    nlohmann::ordered_json out = {{"instants", instants.size()}};
    for (const char* key : {"rms_m", "sex", "paired_share"})
        if (body.report.contains(key)) out[key] = body.report[key];
    return out;
}

} // namespace toile::pipeline
