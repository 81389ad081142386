// Metrics while it runs, and the report of a run.
#include "apps/kiosk/kiosk.h"

#include "core/bytes.h"

#include <nlohmann/json.hpp>

namespace toile::apps::kiosk {
namespace {

constexpr double kMetricsEvery_s = 5.0;

} // namespace

void Kiosk::write_metrics(bool now) {
    if (run_.config.metrics.empty() || (!now && now_s_ < metrics_at_s_)) return;
    metrics_at_s_ = now_s_ + kMetricsEvery_s;
    metrics_.screen = screens_.now();
    metrics_.camera_up = feed_.up();
    metrics_.frame_p95_s = 1e-3 * frame_time_.quantiles().p95_ms;
    metrics_.latency_p95_s = 1e-3 * picture_latency_.quantiles().p95_ms;
    scribe_.write(run_.config.metrics, prometheus_text(metrics_));
}

void Kiosk::write_report() {
    if (run_.report.empty()) return;
    nlohmann::ordered_json json;
    const auto put = [&](const char* name, const pipeline::DurationHistogram& histogram) {
        const pipeline::Quantiles q = histogram.quantiles();
        json[name] = {{"median_ms", q.median_ms}, {"p95_ms", q.p95_ms}, {"max_ms", q.max_ms}};
    };
    json["frames"] = metrics_.frames;
    json["camera_frames"] = camera_frames_;
    json["dropped"] = metrics_.dropped;
    json["garments"] = metrics_.garments;
    json["seconds"] = last_frame_s_ - first_frame_s_;
    json["longest_gap_s"] = longest_gap_s_;
    put("frame_wall", frame_time_);
    put("compute_wall", compute_time_);
    put("state_interval_wall", interval_time_);
    put("source_wall", feed_.time());
    put("drawing_wall", draw_time_);
    if (live_) put("latency_garment_state", state_latency_);
    if (live_) put("latency_picture", picture_latency_);
    for (std::size_t i = 0; i < pipeline::kStageCount; ++i) {
        const auto stage = static_cast<pipeline::Stage>(i);
        const pipeline::Quantiles q = clock_.stage(stage);
        json["stages"][std::string(pipeline::stage_name(stage))] = {
            {"median_ms", q.median_ms}, {"p95_ms", q.p95_ms}, {"max_ms", q.max_ms}};
    }
    json["picture_scale"] = scale_.now();
    for (std::size_t i = 1; i < kFaultCount; ++i)
        json["faults"][fault_name(static_cast<Fault>(i))] = metrics_.faults[i];
    write_text(run_.report, json.dump(2) + "\n");
}

} // namespace toile::apps::kiosk
