#include "apps/kiosk/metrics.h"

#include <cstdio>

namespace toile::apps::kiosk {
namespace {

constexpr std::array<const char*, kFaultCount> kFaults = {"invalid", "camera", "plugin",  "garment",
                                                          "disk",    "clock",  "picture", "crash"};

class Page {
  public:
    void head(const char* name, const char* type, const char* help) {
        text_ += std::string("# HELP toile_kiosk_") + name + " " + help + "\n# TYPE toile_kiosk_" +
                 name + " " + type + "\n";
    }
    void value(const std::string& name, double value) {
        std::array<char, 32> number{};
        std::snprintf(number.data(), number.size(), "%.9g", value);
        text_ += "toile_kiosk_" + name + " " + number.data() + "\n";
    }
    void counter(const char* name, const char* help, std::uint64_t count) {
        head(name, "counter", help);
        text_ += std::string("toile_kiosk_") + name + " " + std::to_string(count) + "\n";
    }
    void gauge(const char* name, const char* help, double now) {
        head(name, "gauge", help);
        value(name, now);
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    std::string text_;
};

} // namespace

const char* fault_name(Fault fault) {
    return kFaults.at(static_cast<std::size_t>(fault));
}

std::string prometheus_text(const Metrics& metrics) {
    Page page;
    page.counter("frames_total", "Frames shown.", metrics.frames);
    page.counter("frames_dropped_total", "Frames that came late and were left out.",
                 metrics.dropped);
    page.counter("visits_total", "Visits with consent.", metrics.visits);
    page.counter("declined_total", "Visits without consent.", metrics.declined);
    page.counter("garments_total", "Garments put on.", metrics.garments);
    page.counter("snapshots_total", "Pictures that shoppers asked for.", metrics.snapshots);
    page.counter("restarts_total", "Starts of the mirror by its watchdog.", metrics.restarts);
    page.head("faults_total", "counter", "Faults that were gone around.");
    for (std::size_t i = 1; i < kFaultCount; ++i)
        page.value("faults_total{kind=\"" + std::string(kFaults[i]) + "\"}",
                   static_cast<double>(metrics.faults[i]));
    page.gauge("frame_p95_seconds", "Wall time of a frame, 95 of 100 below.", metrics.frame_p95_s);
    page.gauge("latency_p95_seconds", "Capture to picture, 95 of 100 below.",
               metrics.latency_p95_s);
    page.gauge("picture_scale", "Share of the full resolution that is drawn.",
               metrics.picture_scale);
    page.gauge("camera_up", "1 while pictures come.", metrics.camera_up ? 1.0 : 0.0);
    page.head("screen", "gauge", "1 for the screen that is shown.");
    for (int i = 1; i <= static_cast<int>(ScreenName::safe); ++i) {
        const auto screen = static_cast<ScreenName>(i);
        page.value("screen{name=\"" + std::string(screen_name(screen)) + "\"}",
                   screen == metrics.screen ? 1.0 : 0.0);
    }
    return page.take();
}

} // namespace toile::apps::kiosk
