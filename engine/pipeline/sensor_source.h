// A sensor plugin opened by its source URI: cameras, and their frames as pictures.
#pragma once

#include "abi/truth.h"
#include "body/surface_cache.h"
#include "host/instance.h"
#include "host/job.h"
#include "host/registry.h"
#include "imaging/camera.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace toile::pipeline {

/// One camera of a sensor. Where it stands is nothing when it does not know.
struct SensorStream {
    std::string name; ///< "camera0", or what a simulated sensor calls it
    imaging::Intrinsics depth;
    bool has_color = false; ///< registered to depth
    std::optional<Eigen::Isometry3d> world_from_camera;
    double frame_period_s = 0.0;
};

/// Pictures are the reader's own and are reused from frame to frame.
struct SensorFrame {
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0;
    imaging::DepthImage depth;
    imaging::Image color; ///< empty: none
};

/// What a simulated sensor knows of one camera.
struct TrueCamera {
    Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
    double depth_scale = 1.0;
};

/// One surface of what a simulated sensor shows.
struct TrueSurface {
    std::string name;
    body::SurfaceRole role = body::SurfaceRole::invalid;
    std::uint32_t person_id = 0;
    geometry::TriangleMesh mesh; ///< without normals
};

/// Not movable.
class SensorSource {
  public:
    /// \throw UsageError for a URI without a scheme, Error when it cannot be opened or its
    /// description makes no sense [worker]
    SensorSource(const std::string& uri, host::Registry& registry, host::Services& services,
                 const toile_limits& limits, host::Job& job);
    SensorSource(const SensorSource&) = delete;
    SensorSource& operator=(const SensorSource&) = delete;

    [[nodiscard]] const std::vector<SensorStream>& streams() const noexcept { return streams_; }

    /// The next frame of a stream: true when there is one. False: none yet, or no more (`ended`).
    /// \throw Error when the sensor fails or its frame is not as described
    bool next(std::uint32_t stream, SensorFrame& out);
    [[nodiscard]] bool ended(std::uint32_t stream) const { return ended_.at(stream); }

    /// Is this a simulated sensor that tells the truth?
    [[nodiscard]] bool knows_truth() const noexcept { return truth_ != nullptr; }
    /// Of a sensor that knows it; frames by their sequence number. \throw Error
    [[nodiscard]] TrueCamera true_camera(std::uint32_t stream);
    [[nodiscard]] std::vector<body::TrackedPerson> true_people(std::uint32_t sequence);
    [[nodiscard]] std::vector<TrueSurface> true_surfaces(std::uint32_t sequence);

  private:
    void describe_streams();
    [[nodiscard]] Error wrong(const std::string& what);

    host::Instance instance_;
    const toile_sensor& table_;
    const toile_truth* truth_;
    std::vector<SensorStream> streams_;
    std::vector<bool> ended_;
};

} // namespace toile::pipeline
