// Kind toile.body_source/1, fed with the depth frames of one camera, and toile.tool/1, which trains
// the forest of body parts.
#include "body/avatar_files.h"
#include "body_tracker/body_tracking.h"
#include "body_tracker/other_body.h"
#include "body_tracker/part_painter.h"
#include "body_tracker/parts_tool.h"
#include "boundary/shaped_body.h"
#include "boundary/stream_camera.h"
#include "core/error.h"
#include "sdk/body_source.h"
#include "sdk/parameters.h"
#include "sdk/part_labels.h"
#include "sdk/plugin.h"
#include "sdk/thread_pool.h"
#include "sdk/views.h"

namespace {

namespace sdk = toile::sdk;
namespace body = toile::body;
namespace tracker = toile::body_tracker;
using toile::RigidTransform;
using toile::Vec3f;

constexpr const char* kModel = "adult";
constexpr const char* kForest = "adult.forest";

class BodyTracker {
  public:
    static constexpr sdk::Info info{.id = "toile.body_tracker",
                                    .name = "People tracked in depth frames",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::BodySource, sdk::Tool>;
    using Extensions = sdk::Kinds<sdk::Parameters, sdk::PartLabels>;
    static constexpr std::array parameters{
        sdk::Parameter{"smoothing", TOILE_PARAMETER_SWITCH, "1",
                       "0: poses as each frame shows them, with their jitter", 0, 1, 1},
        sdk::Parameter{"shape", TOILE_PARAMETER_SWITCH, "1",
                       "0: everybody has the mean body; 1: shape from the first seconds", 0, 1, 1},
        sdk::Parameter{"recovery", TOILE_PARAMETER_SWITCH, "1",
                       "0: goes on from a failed frame; 1: searches anew", 0, 1, 1},
        sdk::Parameter{"colour_weight", TOILE_PARAMETER_REAL, "1",
                       "of places known again in the colour picture; 0: colour is not looked at", 0,
                       10, 0}};

    explicit BodyTracker(sdk::Host host) : host_(host) {}

    double& parameter(std::size_t index) { return switches_[index]; }

    void activate(const toile_limits& limits) { seed_ = limits.random_seed; }

    toile_tool_info describe_tool() { return tracker::parts_tool_info(); }

    void run_tool(const sdk::ToolArguments& arguments, sdk::Job job) {
        const sdk::ThreadPool pool(host_);
        host_.info(tracker::train_parts_by(
            arguments,
            {seed_, [&](std::uint32_t count, std::uint32_t grain,
                        const auto& body) { pool.parallel_for(count, grain, body); }},
            job));
    }

    toile_body_source_info describe() {
        return {sizeof(toile_body_source_info), TOILE_SOURCE_FRAMES, nullptr};
    }

    void begin(const toile_body_source_setup& setup, sdk::Job job) {
        end();
        if (setup.stream_count == 0 || setup.streams == nullptr)
            throw sdk::bad_argument("streams: tracking needs the frames of a depth camera");
        stream_ = sdk::read_struct(setup.streams, "streams");
        if (stream_.depth.width == 0)
            throw sdk::bad_argument("streams: the camera gives no depth, which tracking needs");
        if (setup.stream_count > 1)
            host_.info("people are tracked in the first camera's frames; the others are not used");
        given_revision_ = 0;
        if (setup.body != nullptr) take_given(sdk::read_struct(setup.body, "body"));
        try {
            if (!model_) model_ = std::make_unique<body::FitModel>(body::find_avatar(kModel));
            job.progress(0.7);
            if (!forest_)
                forest_ = std::make_shared<tracker::Forest>(
                    tracker::load_forest(sdk::library_folder() + "/" + kForest));
            start(std::max(1u, setup.max_people));
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        job.progress(1.0);
    }

    toile_status feed(const toile_body_source_input& input) {
        if (!tracking_) throw sdk::bad_argument("feed: called before begin");
        const sdk::SizedArray<const toile_frame> frames(input.frames, input.frame_count, "frames");
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (frames[i].camera != stream_.camera) continue;
            const auto depth = sdk::span_of<float>(frames[i].depth_m, "frame.depth_m");
            if (depth.size() != std::size_t{stream_.depth.width} * stream_.depth.height)
                throw sdk::bad_argument("frame.depth_m: not of the camera's size");
            tracking_->update(depth.data(), frames[i].timestamp_ns, color_of(frames[i]));
            sequence_ = frames[i].sequence;
            timestamp_ns_ = frames[i].timestamp_ns;
            return TOILE_OK;
        }
        return TOILE_NO_NEW_DATA;
    }

    void label_pixels(const toile_frame& frame, std::span<std::uint8_t> parts,
                      std::span<std::uint8_t> people) {
        if (!tracking_) throw sdk::bad_argument("labels: called before begin");
        const auto depth = sdk::span_of<float>(frame.depth_m, "frame.depth_m");
        if (depth.size() != std::size_t{stream_.depth.width} * stream_.depth.height)
            throw sdk::bad_argument("frame.depth_m: not of the camera's size");
        if (!painter_)
            painter_ = std::make_unique<tracker::PartPainter>(
                tracking_->people().front()->body(), forest_.get(),
                toile::boundary::camera_of(stream_).intrinsics);
        painter_->paint(*tracking_, depth, parts, people);
    }

    std::uint32_t result(const sdk::SizedArray<toile_person>& people) {
        if (!tracking_) return 0;
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < tracking_->people().size() && count < people.size(); ++i) {
            const tracker::PersonTrack& track = *tracking_->people()[i];
            if (track.active()) fill(track, shapes_[i], people[count++]);
        }
        return count;
    }

    void reset() {
        if (tracking_) start(static_cast<std::uint32_t>(tracking_->people().size()));
    }

    void end() {
        painter_.reset();
        tracking_.reset();
        shapes_.clear();
    }

  private:
    /// What was last told of one person's shape.
    struct Told {
        std::unique_ptr<toile::boundary::ShapedBody> shape;
        std::uint32_t version = 0, person = 0;
    };

    void take_given(const toile_body& given) {
        given_revision_ = given.revision;
        const auto joints =
            sdk::span_of<sdk::Float3>(given.rest_joints, "body.rest_joints", TOILE_JOINT_COUNT);
        for (std::size_t i = 0; i < joints.size(); ++i)
            given_.rest_positions[i] = Vec3f(joints[i][0], joints[i][1], joints[i][2]);
    }

    /// Null when there is none that is registered to the depth.
    [[nodiscard]] const std::uint8_t* color_of(const toile_frame& frame) const {
        const auto color = sdk::span_of<sdk::Byte4>(frame.color, "frame.color");
        const bool fits = stream_.registered != 0 &&
                          color.size() == std::size_t{stream_.depth.width} * stream_.depth.height;
        return fits ? color.data()->data() : nullptr;
    }

    void start(std::uint32_t most_people) {
        painter_.reset();
        const toile::boundary::StreamCamera camera = toile::boundary::camera_of(stream_);
        const tracker::CameraPlace place = camera.world_from_camera;
        tracker::TrackingOptions options;
        options.most_people = most_people;
        options.person.forest = forest_;
        options.person.smoothing.on = switches_[0] != 0.0;
        options.person.learn_shape = switches_[1] != 0.0;
        options.person.recover = switches_[2] != 0.0;
        options.person.marks.weight = static_cast<float>(switches_[3]);
        tracking_ =
            std::make_unique<tracker::BodyTracking>(*model_, camera.intrinsics, place, options);
        world_ = {};
        if (place) {
            const toile::Quatf turn(place->linear().cast<float>());
            world_ = {turn.normalized(), place->translation().cast<float>()};
        }
        shapes_.clear();
        shapes_.resize(tracking_->people().size());
    }

    void fill(const tracker::PersonTrack& track, Told& told, toile_person& out) {
        using tracker::Following;
        out.has_new_body = 0;
        out.body = nullptr;
        out.state.person_id = track.id();
        out.state.tracking = track.following() == Following::detected    ? TOILE_TRACKING_DETECTED
                             : track.following() == Following::tracked   ? TOILE_TRACKING_TRACKED
                             : track.following() == Following::uncertain ? TOILE_TRACKING_UNCERTAIN
                                                                         : TOILE_TRACKING_LOST;
        out.state.sequence = sequence_;
        out.state.timestamp_ns = timestamp_ns_;
        out.state.body_revision = given_revision_;
        if (given_revision_ == 0) tell_shape(track, told, out);
        body::JointTransforms world = track.joints();
        for (RigidTransform& joint : world)
            joint = world_ * joint;
        if (given_revision_ != 0) world = tracker::on_body(given_, track.body().skeleton(), world);
        const auto joints =
            sdk::span_of<toile_joint>(out.joints, "people.joints", TOILE_JOINT_COUNT);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            std::copy_n(world[i].translation.data(), 3, joints[i].position);
            const Eigen::Vector4f q = world[i].rotation.normalized().coeffs();
            std::copy_n(q.data(), 4, joints[i].rotation);
            const Vec3f speed = world_.rotation * track.velocity(i);
            const Vec3f turning = world_.rotation * track.angular_velocity(i);
            std::copy_n(speed.data(), 3, joints[i].linear_velocity);
            std::copy_n(turning.data(), 3, joints[i].angular_velocity);
            joints[i].confidence = track.confidence()[i];
        }
    }

    void tell_shape(const tracker::PersonTrack& track, Told& told, toile_person& out) {
        if (told.shape == nullptr || told.version != track.shape_version()) {
            const body::ShapeVector& wanted = track.body().shape();
            told.shape = std::make_unique<toile::boundary::ShapedBody>(
                model_->space().model(), track.body().dressed(),
                std::span(wanted.data(), static_cast<std::size_t>(wanted.size())),
                body::Measurements{}, ++revision_);
            told.version = track.shape_version();
        }
        out.has_new_body = 1;
        out.body = &told.shape->abi();
        out.state.body_revision = out.body->revision;
    }

    sdk::Host host_;
    std::array<double, 4> switches_{1.0, 1.0, 1.0, 0.0};
    std::unique_ptr<body::FitModel> model_;
    std::shared_ptr<const tracker::Forest> forest_;
    std::unique_ptr<tracker::BodyTracking> tracking_;
    std::unique_ptr<tracker::PartPainter> painter_; ///< once somebody asked for labels
    std::vector<Told> shapes_;                      ///< of tracking_->people()
    toile_stream stream_{};
    RigidTransform world_; ///< world_from_camera
    body::Skeleton given_;
    std::uint64_t seed_ = 1;
    std::uint64_t given_revision_ = 0; ///< 0: the body is found
    std::uint64_t revision_ = 0;
    std::uint32_t sequence_ = 0;
    std::int64_t timestamp_ns_ = 0;
};

} // namespace

TOILE_PLUGIN(body_tracker, BodyTracker)
