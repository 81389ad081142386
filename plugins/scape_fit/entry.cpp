// Kind toile.body_source/1, fed with a scan or with frames of cameras, and toile.body_fit/1.
#include "body/body_model.h"
#include "boundary/shaped_body.h"
#include "boundary/stream_camera.h"
#include "core/error.h"
#include "scape_fit/fit_session.h"
#include "sdk/body_fit.h"
#include "sdk/body_source.h"
#include "sdk/plugin.h"
#include "sdk/thread_pool.h"
#include "sdk/views.h"

#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace body = toile::body;
namespace fit = toile::scape_fit;
using toile::Vec3f;

constexpr const char* kModel = "adult";
using Rgba = std::array<std::uint8_t, 4>;

std::vector<Vec3f> vectors(const toile_view& view, const char* name) {
    std::vector<Vec3f> out;
    for (const auto& row : sdk::span_of<sdk::Float3>(view, name))
        out.emplace_back(row[0], row[1], row[2]);
    return out;
}

void check(toile_status status) {
    if (status < 0) throw sdk::Failure(status, "the mesh sink refused the surface");
}

class ScapeFit {
  public:
    static constexpr sdk::Info info{.id = "toile.scape_fit",
                                    .name = "Body from a scan or depth pictures",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::BodySource>;
    using Extensions = sdk::Kinds<sdk::BodyFit>;

    explicit ScapeFit(sdk::Host host) : host_(host), pool_(host) {}

    toile_body_source_info describe() {
        return {sizeof(toile_body_source_info), TOILE_SOURCE_FRAMES, nullptr};
    }

    void begin(const toile_body_source_setup& setup, sdk::Job job) {
        end();
        try {
            if (!model_) model_ = std::make_unique<fit::FitModel>(body::find_avatar(kModel));
            job.progress(0.5);
            session_ = std::make_unique<fit::FitSession>(*model_);
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        std::vector<fit::FitCamera> cameras;
        for (std::uint32_t i = 0; i < setup.stream_count; ++i)
            cameras.push_back(camera_of(setup.streams[i]));
        session_->begin(std::move(cameras));
        job.progress(1.0);
    }

    toile_status feed(const toile_body_source_input& input) {
        fit::FitSession& session = begun();
        person_.reset();
        try {
            if (input.scan != nullptr)
                session.add_scan(mesh_of(*input.scan), colors_of(*input.scan));
            else if (input.frame_count > 0)
                add_frames(session, input);
            else
                return TOILE_NO_NEW_DATA;
        } catch (const toile::Error& e) {
            throw sdk::bad_argument(e.what());
        }
        return TOILE_OK;
    }

    void fit(const toile_body_fit_options& options, sdk::Job job) {
        fit::FitSession& session = begun();
        person_.reset();
        fit::SessionOptions wish;
        if (options.sex == TOILE_SEX_FEMALE) wish.sex = body::Sex::female;
        if (options.sex == TOILE_SEX_MALE) wish.sex = body::Sex::male;
        wish.dressed = options.dressed != 0;
        wish.progress = [&](double share) { return job.cancelled(share, "fitting the body"); };
        const auto rows = [this](std::uint32_t count, std::uint32_t grain, const auto& work) {
            pool_.parallel_for(count, grain, work);
        };
        try {
            session.fit(wish, rows);
        } catch (const fit::Cancelled&) {
            throw sdk::Failure(TOILE_CANCELLED, "cancelled");
        } catch (const toile::Error& e) {
            throw sdk::Failure(TOILE_E_NUMERIC, e.what());
        }
        const auto& shape = session.result().state.shape.coefficients;
        person_ = std::make_unique<toile::boundary::ShapedBody>(
            session.model().space().model(), session.rest(),
            std::span(shape.data(), static_cast<std::size_t>(shape.size())), session.measurements(),
            ++revision_);
    }

    std::uint32_t result(const sdk::SizedArray<toile_person>& people) {
        if (!person_ || people.size() == 0) return 0;
        toile_person& person = people[0];
        const std::size_t last = session_->instant_count() - 1;
        const fit::PosedLevel posed = session_->surface(last);
        person.has_new_body = 1;
        person.body = &person_->abi();
        person.state.person_id = 1;
        person.state.tracking = TOILE_TRACKING_TRACKED;
        person.state.sequence = sequence_;
        person.state.timestamp_ns = timestamp_ns_;
        person.state.body_revision = person_->abi().revision;
        const auto joints =
            sdk::span_of<toile_joint>(person.joints, "people.joints", TOILE_JOINT_COUNT);
        for (std::size_t i = 0; i < joints.size(); ++i) {
            joints[i] = {};
            const auto& world = posed.world[i];
            std::copy_n(world.translation.data(), 3, joints[i].position);
            std::copy_n(world.rotation.coeffs().data(), 4, joints[i].rotation);
            joints[i].confidence = 1.0f;
        }
        return 1;
    }

    void fitted_surface(std::uint32_t instant, toile_mesh_sink& sink) {
        const fit::FitSession& session = begun();
        if (!session.fitted() || instant >= session.instant_count())
            throw sdk::bad_argument("instant: nothing is fitted for it");
        const fit::PosedLevel posed = session.surface(instant);
        const auto& triangles = session.model().level(0).triangles;
        toile_mesh_buffers out{};
        out.size = sizeof(out);
        check(sink.begin(&sink, static_cast<std::uint32_t>(posed.positions.size()),
                         static_cast<std::uint32_t>(triangles.size()), &out));
        const auto positions = sdk::span_of<sdk::Float3>(out.positions, "sink.positions");
        const auto normals = sdk::span_of<sdk::Float3>(out.normals, "sink.normals");
        const auto corners = sdk::span_of<sdk::Triangle>(out.triangles, "sink.triangles");
        for (std::size_t v = 0; v < positions.size(); ++v) {
            std::copy_n(posed.positions[v].data(), 3, positions[v].data());
            std::copy_n(posed.normals[v].data(), 3, normals[v].data());
        }
        std::copy(triangles.begin(), triangles.end(), corners.begin());
        check(sink.commit(&sink));
    }

    std::string fit_report() {
        if (!begun().fitted()) throw sdk::bad_argument("report: nothing is fitted");
        return session_->report().dump();
    }

    void end() {
        person_.reset();
        session_.reset();
    }

  private:
    fit::FitSession& begun() {
        if (!session_) throw sdk::bad_argument("called before begin");
        return *session_;
    }

    static fit::FitCamera camera_of(const toile_stream& stream) {
        const toile::boundary::StreamCamera camera = toile::boundary::camera_of(stream);
        return {camera.intrinsics, camera.world_from_camera};
    }

    static toile::geometry::TriangleMesh mesh_of(const toile_mesh& scan) {
        toile::geometry::TriangleMesh out;
        out.positions = vectors(scan.positions, "scan.positions");
        if (scan.normals.count > 0) out.normals = vectors(scan.normals, "scan.normals");
        if (!out.normals.empty() && out.normals.size() != out.positions.size())
            throw sdk::bad_argument("scan.normals: not as many as positions");
        for (const auto& t : sdk::span_of<sdk::Triangle>(scan.triangles, "scan.triangles")) {
            for (const auto v : t)
                if (v >= out.positions.size())
                    throw sdk::bad_argument("scan.triangles: an index is out of range");
            out.triangles.push_back(t);
        }
        return out;
    }

    static std::vector<Rgba> colors_of(const toile_mesh& scan) {
        const auto rows = sdk::span_of<Rgba>(scan.colors, "scan.colors");
        return {rows.begin(), rows.end()};
    }

    void add_frames(fit::FitSession& session, const toile_body_source_input& input) {
        std::vector<toile::imaging::DepthImage> depths(input.frame_count);
        std::vector<toile::imaging::Image> colors(input.frame_count);
        const sdk::SizedArray<const toile_frame> frames(input.frames, input.frame_count, "frames");
        for (std::uint32_t i = 0; i < input.frame_count; ++i) {
            const toile_frame& frame = frames[i];
            if (frame.camera >= input.frame_count)
                throw sdk::bad_argument("frames: a camera that was not announced");
            const auto depth = sdk::span_of<float>(frame.depth_m, "frame.depth_m");
            toile::imaging::DepthImage& image = depths[frame.camera];
            const auto& size = session.camera(frame.camera).intrinsics;
            image.width = size.width;
            image.height = size.height;
            if (depth.size() !=
                static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height))
                throw sdk::bad_argument("frame.depth_m: not of the camera's size");
            image.metres.assign(depth.begin(), depth.end());
            const auto color = sdk::span_of<Rgba>(frame.color, "frame.color");
            if (color.size() != depth.size() && !color.empty())
                throw sdk::bad_argument("frame.color: not of the depth picture's size");
            toile::imaging::Image& shown = colors[frame.camera];
            if (!color.empty()) {
                shown.width = size.width;
                shown.height = size.height;
            }
            for (const Rgba& pixel : color)
                shown.pixels.insert(shown.pixels.end(), pixel.begin(), pixel.end());
            sequence_ = frame.sequence;
            timestamp_ns_ = frame.timestamp_ns;
        }
        session.add_instant(std::move(depths), std::move(colors));
    }

    sdk::Host host_;
    sdk::ThreadPool pool_;
    std::unique_ptr<fit::FitModel> model_;
    std::unique_ptr<fit::FitSession> session_;
    std::unique_ptr<toile::boundary::ShapedBody> person_;
    std::uint64_t revision_ = 0;
    std::uint32_t sequence_ = 0;
    std::int64_t timestamp_ns_ = 0;
};

} // namespace

TOILE_PLUGIN(scape_fit, ScapeFit)
