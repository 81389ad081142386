#include "pipeline/body_fit.h"

#include "core/error.h"
#include "host/mesh_sink.h"
#include "host/views.h"
#include "pipeline/body_frame.h"
#include "pipeline/sensor_views.h"

#include <algorithm>
#include <cmath>

namespace toile::pipeline {
namespace {

constexpr std::uint32_t kMostVertices = 2'000'000;
constexpr std::uint32_t kMostTriangles = 4'000'000;
constexpr std::uint64_t kMostReport = 1u << 20;

std::vector<Vec3f> vectors_of(const toile_view& view, const char* name) {
    if (view.count == 0 || view.data == nullptr || view.format != TOILE_F32X3 ||
        view.stride != sizeof(Vec3f) || view.count > kMostVertices)
        throw Error(std::string("the fit gives no usable ") + name);
    const auto* rows = static_cast<const Vec3f*>(view.data);
    std::vector<Vec3f> out(rows, rows + view.count);
    for (const Vec3f& row : out)
        if (!row.allFinite()) throw Error(std::string("the fit gives ") + name + " not finite");
    return out;
}

void copy_body(const toile_body& body, FittedBody& out) {
    out.model = body.model_id == nullptr ? "" : body.model_id;
    if (body.coefficients.count > 0 && body.coefficients.format == TOILE_F32 &&
        body.coefficients.stride == sizeof(float)) {
        const auto* values = static_cast<const float*>(body.coefficients.data);
        out.coefficients.assign(values, values + body.coefficients.count);
    }
    for (const double c : out.coefficients)
        if (!std::isfinite(c)) throw Error("the fit gives coefficients not finite");
    out.rest = vectors_of(body.rest.positions, "rest surface");
    const auto joints = vectors_of(body.rest_joints, "joints");
    if (joints.size() != body::kJointCount) throw Error("the fit gives a wrong number of joints");
    std::copy(joints.begin(), joints.end(), out.skeleton.rest_positions.begin());
    if (body.part_labels.count == out.rest.size() && body.part_labels.format == TOILE_U8) {
        const auto* labels = static_cast<const std::uint8_t*>(body.part_labels.data);
        out.part_labels.assign(labels, labels + body.part_labels.count);
    }
    const auto* bytes = static_cast<const char*>(body.measurements.data);
    for (std::uint32_t i = 0; i < body.measurements.count && bytes != nullptr; ++i) {
        const auto& m = *reinterpret_cast<const toile_measurement*>(
            bytes + std::size_t{i} * body.measurements.stride);
        if (m.name != nullptr && std::isfinite(m.value))
            out.measurements[m.name] = {m.value, m.confidence};
    }
}

bool takes(host::Instance& instance, std::uint32_t input) {
    auto info = host::sized<toile_body_source_info>();
    const auto& source = instance.table<toile_body_source>();
    instance.call("describe", [&](toile_instance* i) { return source.describe(i, &info); });
    return info.input == input;
}

} // namespace

BodyFit::BodyFit(host::Registry& registry, host::Services& services, const toile_limits& limits,
                 std::uint32_t input) {
    // Which of the body sources can fit is known to the libraries only; those that read recordings
    // of their own cannot.
    for (const host::Manifest& manifest : registry.manifests(TOILE_BODY_SOURCE)) {
        if (!manifest.schemes.empty()) continue;
        auto instance = std::make_unique<host::Instance>(
            registry.find(TOILE_BODY_SOURCE, manifest.id), services);
        fit_ = instance->find<toile_body_fit>();
        if (fit_ == nullptr || !takes(*instance, input)) continue;
        instance_ = std::move(instance);
        break;
    }
    if (!instance_)
        throw Error(
            "no plugin that fits bodies was found; `toile plugin list` shows what there is");
    source_ = &instance_->table<toile_body_source>();
    instance_->activate(limits);
}

void BodyFit::begin(std::span<const toile_stream> streams, host::Job& job) {
    auto setup = host::sized<toile_body_source_setup>();
    setup.uri = "";
    setup.stream_count = static_cast<std::uint32_t>(streams.size());
    setup.streams = streams.empty() ? nullptr : streams.data();
    setup.max_people = 1;
    instance_->call("begin", [&](toile_instance* instance) {
        return source_->begin(instance, &setup, job.handle());
    });
    instants_ = 0;
}

void BodyFit::feed_scan(const geometry::TriangleMesh& scan, host::Job& job,
                        std::span<const std::array<std::uint8_t, 4>> colors) {
    begin({}, job);
    auto mesh = host::sized<toile_mesh>();
    mesh.positions = host::view_of(scan.positions);
    mesh.normals = host::view_of(scan.normals);
    mesh.colors = host::view_of(colors);
    mesh.triangles = host::view_of(scan.triangles);
    mesh.topology_id = 1;
    auto input = host::sized<toile_body_source_input>();
    input.scan = &mesh;
    instance_->call("feed",
                    [&](toile_instance* instance) { return source_->feed(instance, &input); });
    instants_ = 1;
}

void BodyFit::begin_cameras(std::span<const SensorStream> streams, host::Job& job) {
    std::vector<toile_stream> told;
    for (const SensorStream& stream : streams)
        told.push_back(stream_view(stream, static_cast<std::uint32_t>(told.size())));
    begin(told, job);
}

void BodyFit::feed_frames(std::span<const SensorFrame> frames) {
    std::vector<toile_frame> given;
    for (const SensorFrame& frame : frames)
        given.push_back(frame_view(frame, static_cast<std::uint32_t>(given.size())));
    auto input = host::sized<toile_body_source_input>();
    input.frame_count = static_cast<std::uint32_t>(given.size());
    input.frames = given.data();
    instance_->call("feed",
                    [&](toile_instance* instance) { return source_->feed(instance, &input); });
    ++instants_;
}

void BodyFit::run(const FitRequest& request, host::Job& job) {
    auto options = host::sized<toile_body_fit_options>();
    options.dressed = request.dressed ? 1 : 0;
    if (request.sex)
        options.sex = *request.sex == body::Sex::female ? TOILE_SEX_FEMALE : TOILE_SEX_MALE;
    instance_->call("fit", [&](toile_instance* instance) {
        return fit_->fit(instance, &options, job.handle());
    });
}

FittedBody BodyFit::fit(const FitRequest& request, host::Job& job) {
    run(request, job);
    return take();
}

BodyFit::Surface BodyFit::fit_surface(host::Job& job) {
    run({}, job);
    Surface out = take_surface(0);
    out.report = take_report();
    return out;
}

BodyFit::Surface BodyFit::take_surface(std::uint32_t instant) {
    host::MeshSink sink(kMostVertices, kMostTriangles);
    instance_->call("surface", [&](toile_instance* instance) {
        return fit_->surface(instance, instant, sink.handle());
    });
    host::SunkMesh taken = sink.take();
    Surface out;
    for (const auto& p : taken.positions)
        out.mesh.positions.emplace_back(p[0], p[1], p[2]);
    out.mesh.triangles = std::move(taken.triangles);
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    out.colors = std::move(taken.colors);
    return out;
}

nlohmann::ordered_json BodyFit::take_report() {
    std::string text(kMostReport, '\0');
    std::uint64_t bytes = text.size();
    instance_->call("report", [&](toile_instance* instance) {
        return fit_->report(instance, text.data(), &bytes);
    });
    text.resize(std::min<std::uint64_t>(bytes, text.size()));
    auto out = nlohmann::ordered_json::parse(text, nullptr, false);
    if (out.is_discarded()) throw Error(instance_->id() + ": its report is not JSON");
    return out;
}

FittedBody BodyFit::take() {
    FittedBody out;
    JointArray joints{};
    auto person = host::sized<toile_person>();
    person.state.size = sizeof(person.state);
    person.joints = host::view_mut(joints);
    std::uint32_t count = 1;
    instance_->call("result", [&](toile_instance* instance) {
        return source_->result(instance, &person, &count);
    });
    if (count == 0 || person.body == nullptr)
        throw Error(instance_->id() + ": gave nobody after the fit");
    copy_body(*person.body, out);
    out.pose = local_pose(transforms_of(joints));
    for (std::uint32_t i = 0; i < instants_; ++i)
        out.surfaces.push_back(take_surface(i).mesh);
    out.report = take_report();
    return out;
}

} // namespace toile::pipeline
