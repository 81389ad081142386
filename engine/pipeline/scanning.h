// One surface from cameras' pictures, by a scanner plugin.
#pragma once

#include "abi/scanner.h"
#include "assets/colored_mesh.h"
#include "body/body_model.h"
#include "host/instance.h"
#include "host/registry.h"
#include "pipeline/scan_guide.h"
#include "pipeline/sensor_source.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace toile::pipeline {

/// Methods of the scanners at hand, the default first.
[[nodiscard]] std::vector<std::string> scan_methods(const host::Registry& registry);

struct ScannedSurface {
    assets::ColoredMesh surface;           ///< in the world, as in the first frame
    std::optional<body::SkinWeights> skin; ///< where the scanner gave one
    nlohmann::ordered_json report;
};

/// Opens a scanner; begin, feed, finish.
class Scanning {
  public:
    /// `method`: as plugins declare it; empty: that of the highest priority.
    /// \throw UsageError for a method that none has, listing those there are [main]
    Scanning(host::Registry& registry, host::Services& services, const toile_limits& limits,
             const std::string& method);

    [[nodiscard]] const std::string& method() const noexcept { return method_; }
    /// A switch or number of the plugin. \throw UsageError listing those that there are [main]
    void set(const std::string& parameter, double value);

    /// \throw Error with the plugin's reason, here and below [worker]
    void begin(std::span<const SensorStream> streams);
    /// One picture of each camera.
    void feed(std::span<const SensorFrame> frames);
    [[nodiscard]] ScannedSurface finish(host::Job& job);

  private:
    static std::string id_of(const host::Registry& registry, std::string& method);
    host::Instance& active();

    host::Registry& registry_;
    host::Services& services_;
    std::string method_;
    host::Instance instance_;
    toile_limits limits_;
    std::optional<ScanGuide> guide_; ///< for a scanner that wants one
    bool active_ = false;
};

} // namespace toile::pipeline
