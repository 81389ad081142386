// What the scanners of moving people have in common: parameters, and one camera's frames into a
// session of engine/scan.
#pragma once

#include "boundary/one_camera_scan.h"
#include "scan/warp_session.h"
#include "sdk/parameters.h"

#include <array>

namespace toile::boundary {

/// `iterations`: of P4's registration part by part, where nothing else is set.
constexpr auto warp_parameters(int iterations) {
    return std::array{
        sdk::Parameter{"nodes", TOILE_PARAMETER_INTEGER, "1", "Of the deformation graph", 4, 250,
                       60},
        sdk::Parameter{"rounds", TOILE_PARAMETER_INTEGER, "1", "Of registration, at most", 0, 50,
                       10},
        sdk::Parameter{"views", TOILE_PARAMETER_INTEGER, "1", "Kept of all frames", 8, 400, 72},
        sdk::Parameter{"smoothness", TOILE_PARAMETER_REAL, "1",
                       "How much neighbouring nodes move alike", 0.0001, 1000, 0.1},
        sdk::Parameter{"steadiness", TOILE_PARAMETER_REAL, "1",
                       "How much a node moves alike from view to view", 0.0001, 1000, 0.02},
        sdk::Parameter{"trust", TOILE_PARAMETER_REAL, "1", "In the body's own motions", 0.0, 1000,
                       0.001},
        sdk::Parameter{"reach_m", TOILE_PARAMETER_REAL, "m", "Of pairs in the first round", 0.005,
                       0.2, 0.04},
        sdk::Parameter{"smoothing_radius", TOILE_PARAMETER_INTEGER, "1",
                       "Pixels that depth is smoothed over; 0: 3, or 6 where it is rough", 0, 10,
                       0},
        sdk::Parameter{"bias_rounds", TOILE_PARAMETER_INTEGER, "1",
                       "Rounds of putting back what smoothing takes off bends", 0, 5, 2},
        sdk::Parameter{"voxel_m", TOILE_PARAMETER_REAL, "m", "Detail of the surface", 0.003, 0.02,
                       0.005},
        sdk::Parameter{"iterations", TOILE_PARAMETER_INTEGER, "1",
                       "Of registration part by part, at most", 0, 20,
                       static_cast<double>(iterations)},
    };
}

template <int iterations>
class WarpScanner {
  public:
    static constexpr auto parameters = warp_parameters(iterations);
    double& parameter(std::size_t index) { return values_.at(index); }

    void begin(const sdk::SizedArray<const toile_stream>& streams) {
        scan_.begin(streams, [&](const StreamCamera& camera, RowLoop rows) {
            return std::make_unique<scan::WarpSession>(
                scan::IntakeCamera{camera.intrinsics, camera.world_from_camera}, options(),
                std::move(rows));
        });
    }
    void feed(const sdk::SizedArray<const toile_frame>& frames) { scan_.feed(frames); }
    void guide(const toile_scan_template& rough) { scan_.guide(rough); }
    void finish(toile_scan_sink& sink, sdk::Job job) { scan_.finish(sink, job); }

  protected:
    WarpScanner(sdk::Host host, const char* method) : scan_(host, method, kMostFrames) {
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = parameters[i].default_value;
    }

  private:
    static constexpr std::uint32_t kMostFrames = 3000;

    [[nodiscard]] scan::WarpSessionOptions options() const {
        scan::WarpSessionOptions out;
        out.warp.nodes = static_cast<std::size_t>(values_[0]);
        out.warp.rounds = static_cast<int>(values_[1]);
        out.subject.most_views = static_cast<std::size_t>(values_[2]);
        out.warp.joint.smoothness = values_[3];
        out.warp.joint.steadiness = values_[4];
        out.warp.joint.trust = values_[5];
        out.warp.joint.reach_m = static_cast<float>(values_[6]);
        out.subject.choose_radius = values_[7] == 0.0;
        if (!out.subject.choose_radius) out.subject.filter.radius = static_cast<int>(values_[7]);
        out.warp.bias_rounds = static_cast<int>(values_[8]);
        out.warp.voxel_m = static_cast<float>(values_[9]);
        out.parts.iterations = static_cast<int>(values_[10]);
        return out;
    }

    std::array<double, parameters.size()> values_{};
    OneCameraScan<scan::WarpSession> scan_;
};

} // namespace toile::boundary
