// One body from a scan or from cameras' pictures, by a body source plugin that fits.
#pragma once

#include "abi/body_fit.h"
#include "body/sex.h"
#include "body/skeleton.h"
#include "geometry/mesh.h"
#include "host/instance.h"
#include "host/registry.h"
#include "pipeline/sensor_source.h"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace toile::pipeline {

struct FitRequest {
    std::optional<body::Sex> sex; ///< none: the plugin finds out
    bool dressed = false;
};

struct FittedLength {
    double value_m = 0.0;
    double confidence = 0.0; ///< [0, 1]
};

/// Everything as the plugin gave it, checked: finite, of one length.
struct FittedBody {
    std::string model; ///< id of the avatar whose topology and coefficients these are
    std::vector<double> coefficients;
    std::vector<Vec3f> rest; ///< (nv) with the detail that coefficients cannot show
    body::Skeleton skeleton; ///< at rest
    body::Pose pose;         ///< of the last instant
    std::map<std::string, FittedLength> measurements; ///< by ISO name
    std::vector<geometry::TriangleMesh> surfaces;     ///< of each instant, as it was seen
    std::vector<std::uint8_t> part_labels;            ///< (nv) TOILE_PART_*, or empty
    nlohmann::ordered_json report;
};

/// Opens the plugin that can fit bodies; feed it, then `fit`. Not movable.
class BodyFit {
  public:
    /// `input`: of the plugins that can, the first that takes this (TOILE_SOURCE_FRAMES: what fits
    /// the space of bodies, also to scans; TOILE_SOURCE_SCAN: what cleans a scan up and finds its
    /// parts). \throw Error when no plugin can [main]
    BodyFit(host::Registry& registry, host::Services& services, const toile_limits& limits,
            std::uint32_t input = TOILE_SOURCE_FRAMES);
    BodyFit(const BodyFit&) = delete;
    BodyFit& operator=(const BodyFit&) = delete;

    /// A surface, or a cloud (no triangles); `colors` (nv) sRGB, or none. [worker]
    void feed_scan(const geometry::TriangleMesh& scan, host::Job& job,
                   std::span<const std::array<std::uint8_t, 4>> colors = {});
    /// Cameras that stand in one world, or a single one. [worker]
    void begin_cameras(std::span<const SensorStream> streams, host::Job& job);
    /// One picture of each camera.
    void feed_frames(std::span<const SensorFrame> frames);

    /// \throw Error with the plugin's reason when this is no body; host::Cancelled [worker]
    [[nodiscard]] FittedBody fit(const FitRequest& request, host::Job& job);

    /// What a plugin made of a scan's surface, also where it found no body in it.
    struct Surface {
        geometry::TriangleMesh mesh;
        std::vector<std::array<std::uint8_t, 4>> colors; ///< (nv) sRGB, or empty
        nlohmann::ordered_json report;
    };
    /// \throw as fit [worker]
    [[nodiscard]] Surface fit_surface(host::Job& job);

  private:
    void begin(std::span<const toile_stream> streams, host::Job& job);

    void run(const FitRequest& request, host::Job& job);
    [[nodiscard]] FittedBody take();
    [[nodiscard]] Surface take_surface(std::uint32_t instant);
    [[nodiscard]] nlohmann::ordered_json take_report();

    std::unique_ptr<host::Instance> instance_;
    const toile_body_source* source_ = nullptr;
    const toile_body_fit* fit_ = nullptr;
    std::uint32_t instants_ = 0;
};

} // namespace toile::pipeline
