// Kind toile.scanner/1: one camera, a person who moves a little while turning; extension
// toile.scan_guide/1.
#include "boundary/one_camera_scan.h"
#include "scan/warp_session.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/scanner.h"

#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace scan = toile::scan;

constexpr std::uint32_t kMostFrames = 3000;

class TurntableScanner {
  public:
    static constexpr sdk::Info info{.id = "toile.turntable_scanner",
                                    .name = "A person who sways while turning, by a warped body",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Scanner>;
    using Extensions = sdk::Kinds<sdk::Parameters, sdk::ScanGuide>;

    static constexpr std::array parameters{
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
    };
    double& parameter(std::size_t index) { return values_.at(index); }

    explicit TurntableScanner(sdk::Host host) : scan_(host, "turntable", kMostFrames) {
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = parameters[i].default_value;
    }

    void begin(const sdk::SizedArray<const toile_stream>& streams) {
        scan_.begin(streams, [&](const toile::boundary::StreamCamera& camera, toile::RowLoop rows) {
            return std::make_unique<scan::WarpSession>(
                scan::IntakeCamera{camera.intrinsics, camera.world_from_camera}, options(),
                std::move(rows));
        });
    }
    void feed(const sdk::SizedArray<const toile_frame>& frames) { scan_.feed(frames); }
    void guide(const toile_scan_template& rough) { scan_.guide(rough); }
    void finish(toile_scan_sink& sink, sdk::Job job) { scan_.finish(sink, job); }

  private:
    [[nodiscard]] scan::WarpSessionOptions options() const {
        scan::WarpSessionOptions out;
        out.parts.iterations = 0; // the limbs follow the body, and that is enough
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
        return out;
    }

    std::array<double, parameters.size()> values_{};
    toile::boundary::OneCameraScan<scan::WarpSession> scan_;
};

} // namespace

TOILE_PLUGIN(turntable_scanner, TurntableScanner)
