// Kind toile.body_source/1, its own source: kinect-log:FILE.
#include "core/error.h"
#include "kinect_log_source/log_player.h"
#include "sdk/body_source.h"
#include "sdk/plugin.h"
#include "sdk/views.h"

#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace body = toile::body;
using toile::Vec3f;
using toile::kinect_log_source::LogPlayer;
using toile::kinect_log_source::PlayedFrame;

body::Skeleton skeleton_of(const toile_body& given) {
    const auto joints =
        sdk::span_of<sdk::Float3>(given.rest_joints, "body.rest_joints", TOILE_JOINT_COUNT);
    body::Skeleton skeleton;
    for (std::size_t i = 0; i < joints.size(); ++i)
        skeleton.rest_positions[i] = Vec3f(joints[i][0], joints[i][1], joints[i][2]);
    return skeleton;
}

/// The body's bulk, or nothing for a body without a surface or part labels.
std::optional<body::BodyVolumes> volumes_of(const toile_body& given,
                                            const body::Skeleton& skeleton) {
    if (given.rest.positions.count == 0 || given.part_labels.count == 0) return std::nullopt;
    const auto rows = sdk::span_of<sdk::Float3>(given.rest.positions, "body.rest.positions");
    const auto labels =
        sdk::span_of<std::uint8_t>(given.part_labels, "body.part_labels", rows.size());
    std::vector<Vec3f> positions(rows.size());
    std::vector<body::Part> parts(rows.size());
    for (std::size_t v = 0; v < rows.size(); ++v) {
        positions[v] = Vec3f(rows[v][0], rows[v][1], rows[v][2]);
        if (labels[v] > TOILE_PART_NECK) throw sdk::bad_argument("body.part_labels: no such part");
        parts[v] = static_cast<body::Part>(labels[v]);
    }
    return body::measure_volumes(skeleton, positions, parts);
}

std::uint32_t tracking_of(PlayedFrame::Tracking tracking) {
    switch (tracking) {
    case PlayedFrame::Tracking::tracked:
        return TOILE_TRACKING_TRACKED;
    case PlayedFrame::Tracking::uncertain:
        return TOILE_TRACKING_UNCERTAIN;
    default:
        return TOILE_TRACKING_LOST;
    }
}

void copy(const Vec3f& from, float* to) {
    std::copy(from.data(), from.data() + 3, to);
}

class KinectLogSource {
  public:
    static constexpr sdk::Info info{.id = "toile.kinect_log_source",
                                    .name = "Recorded Kinect skeletons",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::BodySource>;

    explicit KinectLogSource(sdk::Host host) : host_(host) {}

    toile_body_source_info describe() {
        static constexpr std::array<const char*, 2> schemes{"kinect-log", nullptr};
        return {sizeof(toile_body_source_info), TOILE_SOURCE_OWN, schemes.data()};
    }

    void begin(const toile_body_source_setup& setup, sdk::Job job) {
        end();
        if (setup.uri == nullptr || *setup.uri == '\0')
            throw sdk::bad_argument("kinect-log: names no file (kinect-log:FILE)");
        if (setup.body == nullptr)
            throw sdk::bad_argument("kinect-log: needs a body to pose, a log holds no surface");
        const toile_body given = sdk::read_struct(setup.body, "body");
        toile::kinect_log_source::KinectLog log;
        try {
            log = toile::kinect_log_source::load_kinect_log(setup.uri);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        job.progress(0.5);
        const body::Skeleton skeleton = skeleton_of(given);
        auto volumes = volumes_of(given, skeleton);
        if (!volumes) host_.warning("the body has no part labels: arms are not kept out of it");
        player_ = std::make_unique<LogPlayer>(log, skeleton, std::move(volumes));
        if (!player_->person().legs_seen)
            host_.info("feet are hardly in view: the floor is taken from the avatar's legs");
        revision_ = given.revision;
        job.progress(1.0);
    }

    toile_status feed(const toile_body_source_input&) {
        if (!player_) throw sdk::bad_argument("feed: called before begin");
        has_frame_ = player_->advance();
        return has_frame_ ? TOILE_OK : TOILE_END_OF_STREAM;
    }

    std::uint32_t result(const sdk::SizedArray<toile_person>& people) {
        if (!has_frame_ || people.size() == 0) return 0;
        const PlayedFrame& frame = player_->frame();
        toile_person& person = people[0];
        person.has_new_body = 0;
        person.body = nullptr;
        person.state.person_id = 1;
        person.state.tracking = tracking_of(frame.tracking);
        person.state.sequence = frame.sequence;
        person.state.timestamp_ns = frame.timestamp_ns;
        person.state.body_revision = revision_;
        const auto joints =
            sdk::span_of<toile_joint>(person.joints, "people.joints", TOILE_JOINT_COUNT);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            copy(frame.joints[i].translation, joints[i].position);
            const auto& q = frame.joints[i].rotation.coeffs();
            std::copy(q.data(), q.data() + 4, joints[i].rotation);
            copy(frame.linear_velocity[i], joints[i].linear_velocity);
            copy(frame.angular_velocity[i], joints[i].angular_velocity);
            joints[i].confidence = frame.confidence[i];
        }
        return 1;
    }

    void reset() {
        if (player_) player_->forget();
    }

    void end() {
        player_.reset();
        has_frame_ = false;
    }

  private:
    sdk::Host host_;
    std::unique_ptr<LogPlayer> player_;
    std::uint64_t revision_ = 0;
    bool has_frame_ = false;
};

} // namespace

TOILE_PLUGIN(kinect_log_source, KinectLogSource)
