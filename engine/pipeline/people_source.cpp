#include "pipeline/people_source.h"

#include "abi/body_fit.h"
#include "abi/parameters.h"
#include "core/error.h"
#include "host/views.h"
#include "pipeline/sensor_views.h"

#include <cmath>

namespace toile::pipeline {
namespace {

std::unique_ptr<host::Instance> find_tracker(host::Registry& registry, host::Services& services) {
    // What a body source does with frames is known to the libraries only: those that fit collect
    // them, those with schemes read recordings of their own.
    for (const host::Manifest& manifest : registry.manifests(TOILE_BODY_SOURCE)) {
        if (!manifest.schemes.empty()) continue;
        auto instance = std::make_unique<host::Instance>(
            registry.find(TOILE_BODY_SOURCE, manifest.id), services);
        if (instance->find<toile_body_fit>() != nullptr) continue;
        auto info = host::sized<toile_body_source_info>();
        const auto& table = instance->table<toile_body_source>();
        instance->call("describe", [&](toile_instance* i) { return table.describe(i, &info); });
        if (info.input == TOILE_SOURCE_FRAMES) return instance;
    }
    throw Error("no plugin that tracks people in depth frames was found; `toile plugin list` shows "
                "what there is");
}

void wish_for(host::Instance& tracker, const char* id, bool on) {
    const auto* parameters = tracker.find<toile_parameters>();
    if (parameters == nullptr || parameters->set == nullptr) return;
    // One that does not know the parameter works as it does.
    (void)tracker.frame([&](toile_instance* i) { return parameters->set(i, id, on ? 1.0 : 0.0); });
    (void)tracker.take_error();
}

template <class Row>
std::vector<Row> rows_of(const toile_view& view, std::uint32_t format) {
    if (view.data == nullptr || view.format != format || view.stride != sizeof(Row)) return {};
    const auto* rows = static_cast<const Row*>(view.data);
    return {rows, rows + view.count};
}

} // namespace

PeopleSource::PeopleSource(const std::string& uri, host::Registry& registry,
                           host::Services& services, const toile_limits& limits,
                           const TrackingWish& wish, host::Job& job)
    : open_([&registry, &services, &job, uri, limits] {
          return std::make_unique<SensorSource>(uri, registry, services, limits, job);
      }),
      sensor_(open_()), stream_(sensor_->streams().front()),
      tracker_(find_tracker(registry, services)), table_(&tracker_->table<toile_body_source>()),
      labels_(tracker_->find<toile_part_labels>()), joints_(wish.most_people),
      people_(wish.most_people) {
    wish_for(*tracker_, "smoothing", wish.smoothing);
    tracker_->activate(limits);
    if (!stream_.world_from_camera) stream_.world_from_camera = wish.camera;
    const toile_stream stream = stream_view(stream_, 0);
    auto setup = host::sized<toile_body_source_setup>();
    setup.uri = "";
    setup.stream_count = 1;
    setup.streams = &stream;
    setup.body = wish.body == nullptr ? nullptr : &wish.body->abi();
    setup.max_people = wish.most_people;
    tracker_->call("begin",
                   [&](toile_instance* i) { return table_->begin(i, &setup, job.handle()); });
}

PeopleSource::~PeopleSource() {
    tracker_->frame([&](toile_instance* i) {
        table_->end(i);
        return TOILE_OK;
    });
}

void PeopleSource::rewind() {
    sensor_.reset(); // some devices open once only
    sensor_ = open_();
    const double period_s = stream_.frame_period_s > 0.0 ? stream_.frame_period_s : 1.0 / 30.0;
    shift_ns_ = last_ns_ + std::llround(1e9 * period_s);
    sequence_shift_ = last_sequence_ + 1;
}

bool PeopleSource::next(PeopleFrame& out) {
    if (!sensor_->next(0, pictures_)) return false;
    out.taken_s = wall_seconds();
    pictures_.timestamp_ns += shift_ns_;
    pictures_.sequence += sequence_shift_;
    const toile_frame frame = frame_view(pictures_, 0);
    auto input = host::sized<toile_body_source_input>();
    input.frame_count = 1;
    input.frames = &frame;
    const double began = cpu_seconds();
    tracker_->call("feed", [&](toile_instance* i) { return table_->feed(i, &input); });
    time_.add(cpu_seconds() - began);
    out.sequence = last_sequence_ = pictures_.sequence;
    out.timestamp_ns = last_ns_ = pictures_.timestamp_ns;
    read_people(out);
    return true;
}

void PeopleSource::read_parts(PartPicture& out) {
    if (labels_ == nullptr)
        throw Error(tracker_->id() + ": does not tell body parts (it lacks " TOILE_PART_LABELS ")");
    out.width = pictures_.depth.width;
    out.height = pictures_.depth.height;
    out.parts.resize(pictures_.depth.metres.size());
    out.people.resize(out.parts.size());
    const toile_frame frame = frame_view(pictures_, 0);
    auto picture = host::sized<toile_part_picture>();
    picture.parts = host::view_mut(out.parts);
    picture.people = host::view_mut(out.people);
    tracker_->call("labels",
                   [&](toile_instance* i) { return labels_->labels(i, &frame, &picture); });
    for (const std::uint8_t part : out.parts)
        if (part > TOILE_PART_NECK)
            throw Error(tracker_->id() + ": tells the unknown body part " + std::to_string(part));
}

void PeopleSource::read_people(PeopleFrame& out) {
    for (std::size_t i = 0; i < people_.size(); ++i) {
        people_[i] = host::sized<toile_person>();
        people_[i].state.size = sizeof(toile_body_state);
        people_[i].joints = host::view_mut(joints_[i]);
    }
    auto count = static_cast<std::uint32_t>(people_.size());
    tracker_->call("result",
                   [&](toile_instance* i) { return table_->result(i, people_.data(), &count); });
    out.people.clear();
    out.shapes.clear();
    for (std::uint32_t i = 0; i < std::min<std::size_t>(count, people_.size()); ++i) {
        const toile_person& person = people_[i];
        if (!plausible(joints_[i]))
            throw Error(tracker_->id() + ": gave joints that are not finite");
        BodyFrame& body = out.people.emplace_back();
        body.person_id = person.state.person_id;
        body.tracking = person.state.tracking;
        body.sequence = out.sequence;
        body.timestamp_ns = out.timestamp_ns;
        body.joints = joints_[i];
        const bool told = person.has_new_body != 0 && person.body != nullptr;
        if (told && !shapes_.contains(person.body->revision)) keep_shape(*person.body);
        out.shapes.push_back(told ? person.body->revision : 0);
    }
}

void PeopleSource::keep_shape(const toile_body& body) {
    PersonShape shape;
    shape.revision = body.revision;
    shape.rest = rows_of<Vec3f>(body.rest.positions, TOILE_F32X3);
    shape.triangles = rows_of<Triangle>(body.rest.triangles, TOILE_U32X3);
    shape.skin.joints = rows_of<std::array<std::uint16_t, 4>>(body.joint_indices, TOILE_U16X4);
    shape.skin.weights = rows_of<std::array<float, 4>>(body.joint_weights, TOILE_F32X4);
    shape.model = body.model_id == nullptr ? "" : body.model_id;
    for (const float c : rows_of<float>(body.coefficients, TOILE_F32))
        shape.coefficients.push_back(static_cast<double>(c));
    const auto joints = rows_of<Vec3f>(body.rest_joints, TOILE_F32X3);
    if (joints.size() != body::kJointCount || shape.skin.joints.size() != shape.rest.size() ||
        shape.skin.weights.size() != shape.rest.size())
        throw Error(tracker_->id() + ": tells a shape without joints or weights");
    std::copy(joints.begin(), joints.end(), shape.skeleton.rest_positions.begin());
    for (const Vec3f& p : shape.rest)
        if (!p.allFinite()) throw Error(tracker_->id() + ": tells a shape that is not finite");
    // Of everybody's earlier shapes only the newest few can still be asked for.
    if (shapes_.size() > 64) shapes_.erase(shapes_.begin());
    shapes_.emplace(shape.revision, std::move(shape));
}

} // namespace toile::pipeline
