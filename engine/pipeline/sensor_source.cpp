#include "pipeline/sensor_source.h"

#include "core/error.h"
#include "host/mesh_sink.h"
#include "host/views.h"
#include "pipeline/body_frame.h"

#include <algorithm>
#include <cmath>

namespace toile::pipeline {
namespace {

constexpr std::uint32_t kMostStreams = 64;
constexpr std::uint32_t kMostPeople = 64;
constexpr std::uint32_t kMostVertices = 2'000'000;
constexpr std::uint32_t kMostTriangles = 4'000'000;

std::shared_ptr<const host::Plugin> find_sensor(const std::string& uri, host::Registry& registry) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0)
        throw UsageError("source '" + uri + "' has no scheme; write for example capture:DIR");
    auto plugin = registry.find_scheme(uri.substr(0, colon));
    if (!plugin->manifest().provides_kind(TOILE_SENSOR))
        throw Error("source '" + uri + "': " + plugin->id() + " gives no camera pictures");
    return plugin;
}

imaging::Intrinsics intrinsics_of(const toile_intrinsics& in) {
    imaging::Intrinsics out;
    out.width = static_cast<int>(std::min(in.width, 1u << 20));
    out.height = static_cast<int>(std::min(in.height, 1u << 20));
    out.fx = in.fx;
    out.fy = in.fy;
    out.cx = in.cx;
    out.cy = in.cy;
    std::copy(std::begin(in.distortion), std::end(in.distortion), out.distortion.begin());
    imaging::check_intrinsics(out);
    return out;
}

Eigen::Isometry3d pose_of(const double (&matrix)[16]) {
    const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix4d>(matrix);
    const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
    if (!m.allFinite() || !(R * R.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-4) ||
        R.determinant() < 0.0)
        throw Error("world_from_camera is not a rigid motion");
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    out.translation() = m.topRightCorner<3, 1>();
    return out;
}

bool is_packed(const toile_view& view, std::uint32_t format, std::size_t element,
               std::size_t count) {
    return view.data != nullptr && view.format == format && view.stride == element &&
           view.count == count;
}

} // namespace

SensorSource::SensorSource(const std::string& uri, host::Registry& registry,
                           host::Services& services, const toile_limits& limits, host::Job& job)
    : instance_(find_sensor(uri, registry), services), table_(instance_.table<toile_sensor>()),
      truth_(instance_.find<toile_truth>()) {
    instance_.activate(limits);
    const std::string path = uri.substr(uri.find(':') + 1);
    instance_.call("open", [&](toile_instance* instance) {
        return table_.open(instance, path.c_str(), job.handle());
    });
    describe_streams();
}

Error SensorSource::wrong(const std::string& what) {
    const std::string reported = instance_.take_error();
    return Error(instance_.id() + ": " + (reported.empty() ? what : reported));
}

void SensorSource::describe_streams() {
    const std::uint32_t count = table_.stream_count(instance_.handle());
    if (count == 0 || count > kMostStreams)
        throw wrong("has " + std::to_string(count) + " cameras");
    for (std::uint32_t i = 0; i < count; ++i) {
        auto told = host::sized<toile_stream>();
        instance_.call("describe", [&](toile_instance* instance) {
            return table_.describe(instance, i, &told);
        });
        SensorStream stream;
        stream.name = "camera" + std::to_string(i);
        try {
            stream.depth = intrinsics_of(told.depth);
            if (told.has_world != 0) stream.world_from_camera = pose_of(told.world_from_camera);
        } catch (const Error& e) {
            throw wrong(stream.name + ": " + e.what());
        }
        stream.has_color = told.color.width != 0 && told.registered != 0;
        stream.frame_period_s = told.frame_period_s;
        if (truth_ != nullptr) {
            auto known = host::sized<toile_true_camera>();
            instance_.call("truth camera", [&](toile_instance* instance) {
                return truth_->camera(instance, i, &known);
            });
            if (known.name != nullptr && *known.name != '\0') stream.name = known.name;
        }
        streams_.push_back(std::move(stream));
    }
    ended_.assign(count, false);
}

bool SensorSource::next(std::uint32_t stream, SensorFrame& out) {
    const SensorStream& described = streams_.at(stream);
    auto frame = host::sized<toile_frame>();
    const toile_status status = instance_.frame(
        [&](toile_instance* instance) { return table_.poll(instance, stream, &frame); });
    if (status < 0) throw wrong("poll failed without telling why");
    ended_[stream] = status == TOILE_END_OF_STREAM;
    if (status != TOILE_OK) return false;
    const auto pixels = static_cast<std::size_t>(described.depth.width) *
                        static_cast<std::size_t>(described.depth.height);
    const bool color = frame.color.count != 0 && described.has_color;
    const bool sound = is_packed(frame.depth_m, TOILE_F32, sizeof(float), pixels) &&
                       (!color || is_packed(frame.color, TOILE_U8X4, 4, pixels));
    if (sound) {
        out.sequence = frame.sequence;
        out.timestamp_ns = frame.timestamp_ns;
        out.depth.width = out.color.width = described.depth.width;
        out.depth.height = out.color.height = described.depth.height;
        const auto* depth = static_cast<const float*>(frame.depth_m.data);
        out.depth.metres.assign(depth, depth + pixels);
        const auto* bytes = static_cast<const std::uint8_t*>(frame.color.data);
        if (color)
            out.color.pixels.assign(bytes, bytes + 4 * pixels);
        else
            out.color = {};
    }
    table_.release(instance_.handle(), &frame);
    if (!sound) throw wrong("gives pictures of another size than it describes");
    return true;
}

TrueCamera SensorSource::true_camera(std::uint32_t stream) {
    auto known = host::sized<toile_true_camera>();
    instance_.call("truth camera", [&](toile_instance* instance) {
        return truth_->camera(instance, stream, &known);
    });
    return {pose_of(known.world_from_camera), known.depth_scale};
}

std::vector<body::TrackedPerson> SensorSource::true_people(std::uint32_t sequence) {
    std::vector<JointArray> joints(kMostPeople);
    std::vector<toile_person> people(kMostPeople, host::sized<toile_person>());
    for (std::size_t p = 0; p < people.size(); ++p) {
        people[p].state.size = sizeof(people[p].state);
        people[p].joints = host::view_mut(joints[p]);
    }
    auto count = kMostPeople;
    instance_.call("truth people", [&](toile_instance* instance) {
        return truth_->people(instance, sequence, people.data(), &count);
    });
    std::vector<body::TrackedPerson> out(std::min(count, kMostPeople));
    for (std::size_t p = 0; p < out.size(); ++p) {
        out[p].id = people[p].state.person_id;
        out[p].state = static_cast<body::TrackState>(people[p].state.tracking);
        out[p].joints = transforms_of(joints[p]);
        for (std::size_t j = 0; j < body::kJointCount; ++j)
            out[p].confidence[j] = joints[p][j].confidence;
    }
    return out;
}

std::vector<TrueSurface> SensorSource::true_surfaces(std::uint32_t sequence) {
    std::vector<TrueSurface> out;
    const std::uint32_t count = truth_->surface_count(instance_.handle());
    for (std::uint32_t i = 0; i < count; ++i) {
        host::MeshSink sink(kMostVertices, kMostTriangles);
        auto about = host::sized<toile_true_surface>();
        instance_.call("truth surface", [&](toile_instance* instance) {
            return truth_->surface(instance, sequence, i, &about, sink.handle());
        });
        const host::SunkMesh taken = sink.take();
        TrueSurface surface;
        surface.name = about.name == nullptr ? "" : about.name;
        if (about.role < TOILE_SURFACE_BODY || about.role > TOILE_SURFACE_OTHER)
            throw wrong("gives a surface of an unknown role");
        surface.role = static_cast<body::SurfaceRole>(about.role);
        surface.person_id = about.person_id;
        for (const auto& p : taken.positions)
            surface.mesh.positions.emplace_back(p[0], p[1], p[2]);
        surface.mesh.triangles = taken.triangles;
        out.push_back(std::move(surface));
    }
    return out;
}

} // namespace toile::pipeline
