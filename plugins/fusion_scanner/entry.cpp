// Kind toile.scanner/1: one rigid subject; one camera, or several that know where they stand.
#include "boundary/scan_output.h"
#include "boundary/stream_camera.h"
#include "core/error.h"
#include "fusion_scanner/fusion_session.h"
#include "sdk/parameters.h"
#include "sdk/plugin.h"
#include "sdk/scanner.h"
#include "sdk/thread_pool.h"
#include "sdk/views.h"

#include <algorithm>
#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace fusion = toile::fusion_scanner;
using toile::scan::Rgba8;

constexpr std::uint32_t kMostFrames = 1000, kMostCameras = 16;

class FusionScanner {
  public:
    static constexpr sdk::Info info{.id = "toile.fusion_scanner",
                                    .name = "A rigid subject, by fusion",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Scanner>;
    using Extensions = sdk::Kinds<sdk::Parameters>;

    static constexpr std::array parameters{
        sdk::Parameter{"flying_pixels", TOILE_PARAMETER_SWITCH, "1",
                       "Drop readings that have no neighbours at their depth", 0, 1, 1},
        sdk::Parameter{"edge_pixels", TOILE_PARAMETER_INTEGER, "1",
                       "Pixels beside a jump of depth or a shadow that are dropped", 0, 8, 2},
        sdk::Parameter{"joint_bilateral", TOILE_PARAMETER_SWITCH, "1",
                       "Smooth depth up to edges of depth and colour", 0, 1, 1},
        sdk::Parameter{"smoothing_radius", TOILE_PARAMETER_INTEGER, "1",
                       "Pixels that are smoothed over; 0: 3, or 6 where readings are rough", 0, 10,
                       0},
        sdk::Parameter{"averaged_frames", TOILE_PARAMETER_INTEGER, "1",
                       "Frames in a row of which one is made, for what stands still that long", 1,
                       30, 1},
        sdk::Parameter{"close_loop", TOILE_PARAMETER_SWITCH, "1",
                       "Spread what is missing when the turn comes round", 0, 1, 1},
        sdk::Parameter{"refine_jointly", TOILE_PARAMETER_SWITCH, "1",
                       "Place all views at once after the loop", 0, 1, 1},
        sdk::Parameter{"bias_rounds", TOILE_PARAMETER_INTEGER, "1",
                       "Rounds of putting back what smoothing takes off bends", 0, 5, 2},
        sdk::Parameter{"voxel_m", TOILE_PARAMETER_REAL, "m", "Detail of the surface", 0.003, 0.02,
                       0.005},
        sdk::Parameter{"camera_shift_m", TOILE_PARAMETER_REAL, "m",
                       "How far several cameras may be off where they are said to stand; 0: they "
                       "are believed",
                       0, 0.1, 0.003},
        sdk::Parameter{"camera_turn_rad", TOILE_PARAMETER_REAL, "rad",
                       "How far they may be turned from there", 0, 0.1, 0.003},
    };
    double& parameter(std::size_t index) { return values_.at(index); }

    explicit FusionScanner(sdk::Host host) : pool_(host) {
        for (std::size_t i = 0; i < values_.size(); ++i)
            values_[i] = parameters[i].default_value;
    }

    void begin(const sdk::SizedArray<const toile_stream>& streams) {
        session_.reset();
        cameras_.clear();
        if (streams.size() > kMostCameras)
            throw sdk::Failure(TOILE_E_UNSUPPORTED, "fusion takes at most 16 cameras; " +
                                                        std::to_string(streams.size()) +
                                                        " were named");
        try {
            std::vector<toile::scan::IntakeCamera> cameras;
            for (std::uint32_t c = 0; c < streams.size(); ++c) {
                cameras.push_back(camera_of(streams[c]));
                cameras_.push_back({streams[c].camera,
                                    std::size_t{streams[c].depth.width} * streams[c].depth.height});
            }
            session_ =
                std::make_unique<fusion::FusionSession>(std::move(cameras), options(), rows());
        } catch (const toile::Error& e) {
            throw sdk::bad_argument(e.what());
        }
        fed_ = 0;
    }

    void feed(const sdk::SizedArray<const toile_frame>& frames) {
        if (!session_) throw sdk::bad_argument("feed: called before begin");
        std::vector<fusion::SessionPicture> instant;
        for (std::uint32_t i = 0; i < frames.size(); ++i)
            instant.push_back(picture_of(frames[i]));
        try {
            session_->add(instant);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
    }

    void finish(toile_scan_sink& sink, sdk::Job job) {
        if (!session_) throw sdk::bad_argument("finish: called before begin");
        const auto session = std::move(session_); // once
        fusion::SessionResult result;
        try {
            result = session->finish([&](double share) { job.progress(share, "fusing"); });
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
        toile::boundary::give(result.mesh, result.colors, result.report.dump(), sink);
        job.progress(1.0);
    }

  private:
    struct Camera {
        std::uint32_t number;
        std::size_t pixels;
    };

    fusion::SessionPicture picture_of(const toile_frame& frame) {
        const auto at = std::find_if(cameras_.begin(), cameras_.end(), [&](const Camera& camera) {
            return camera.number == frame.camera;
        });
        if (at == cameras_.end())
            throw sdk::bad_argument("frames: a camera that was not announced");
        if (fed_++ >= kMostFrames)
            throw sdk::Failure(TOILE_E_CAPACITY, "more than 1000 frames: take fewer a second");
        fusion::SessionPicture out;
        out.camera = static_cast<std::size_t>(at - cameras_.begin());
        out.depth = sdk::span_of<float>(frame.depth_m, "frame.depth_m", at->pixels);
        out.color = sdk::span_of<Rgba8>(frame.color, "frame.color");
        if (!out.color.empty() && out.color.size() != at->pixels)
            throw sdk::bad_argument("frame.color: not of the depth picture's size");
        return out;
    }

    static toile::scan::IntakeCamera camera_of(const toile_stream& stream) {
        const toile::boundary::StreamCamera camera = toile::boundary::camera_of(stream);
        return {camera.intrinsics, camera.world_from_camera};
    }

    [[nodiscard]] fusion::SessionOptions options() const {
        fusion::SessionOptions out;
        out.filter.flying_pixels = values_[0] != 0.0;
        out.filter.edge_pixels = static_cast<int>(values_[1]);
        out.filter.joint_bilateral = values_[2] != 0.0;
        out.choose_radius = values_[3] == 0.0;
        if (!out.choose_radius) out.filter.radius = static_cast<int>(values_[3]);
        out.averaged_frames = static_cast<int>(values_[4]);
        out.fusion.filter = out.filter;
        out.fusion.close_loop = values_[5] != 0.0;
        out.fusion.refine_jointly = values_[6] != 0.0;
        out.fusion.bias_rounds = static_cast<int>(values_[7]);
        out.fusion.voxel_m = static_cast<float>(values_[8]);
        out.cameras = {values_[10], values_[9]};
        return out;
    }

    [[nodiscard]] toile::RowLoop rows() const {
        return [this](std::uint32_t count, std::uint32_t grain, const auto& work) {
            pool_.parallel_for(count, grain, work);
        };
    }

    sdk::ThreadPool pool_;
    std::array<double, parameters.size()> values_{};
    std::unique_ptr<fusion::FusionSession> session_;
    std::vector<Camera> cameras_;
    std::uint32_t fed_ = 0;
};

} // namespace

TOILE_PLUGIN(fusion_scanner, FusionScanner)
