// Kind toile.sensor/1: simulated:SCENARIO.json, and toile.truth/1 beside it.
#include "core/error.h"
#include "sdk/plugin.h"
#include "sdk/sensor.h"
#include "sdk/thread_pool.h"
#include "sdk/truth.h"
#include "sdk/views.h"
#include "simulated_sensor/simulator.h"

#include <chrono>
#include <memory>

namespace {

namespace sdk = toile::sdk;
namespace sensor = toile::simulated_sensor;
using toile::Vec3f;

void copy(const Eigen::Isometry3d& from, double* to) {
    std::copy_n(from.matrix().data(), 16, to);
}

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class SimulatedSensor {
  public:
    static constexpr sdk::Info info{.id = "toile.simulated_sensor",
                                    .name = "A simulated Kinect",
                                    .version = "0.1.0",
                                    .vendor = "Toile"};
    using Kinds = sdk::Kinds<sdk::Sensor>;
    using Extensions = sdk::Kinds<sdk::Truth>;

    explicit SimulatedSensor(sdk::Host host) : pool_(host) {}

    void activate(const toile_limits& limits) { live_ = limits.live_clock != 0; }
    void reset() {
        std::fill(next_.begin(), next_.end(), 0u);
        started_s_ = -1.0;
    }

    void open(const char* uri, sdk::Job job) {
        simulator_.reset();
        if (*uri == '\0') throw sdk::bad_argument("simulated: names no scenario (simulated:FILE)");
        const auto rows = [pool = pool_](std::uint32_t count, std::uint32_t grain,
                                         const auto& body) {
            pool.parallel_for(count, grain, body);
        };
        try {
            auto scenario = sensor::load_scenario(uri);
            job.progress(0.1);
            simulator_ = std::make_unique<sensor::Simulator>(std::move(scenario), rows);
            simulator_->show(0); // what is wrong with a motion or a cache is said now
        } catch (const toile::Error& e) {
            simulator_.reset();
            throw sdk::Failure(TOILE_E_IO, e.what());
        }
        next_.assign(simulator_->camera_count(), 0);
        started_s_ = -1.0;
        job.progress(1.0);
    }

    std::uint32_t stream_count() { return static_cast<std::uint32_t>(next_.size()); }

    toile_stream describe(std::uint32_t stream) {
        const sensor::DepthCamera& camera = of(stream);
        toile_stream out{};
        out.size = sizeof(out);
        out.camera = stream;
        const toile::imaging::Intrinsics& in = camera.intrinsics();
        out.depth = {static_cast<std::uint32_t>(in.width),
                     static_cast<std::uint32_t>(in.height),
                     in.fx,
                     in.fy,
                     in.cx,
                     in.cy,
                     {}};
        if (simulator_->scenario().color) out.color = out.depth;
        copy(Eigen::Isometry3d::Identity(), out.color_from_depth);
        copy(camera.reported_pose(), out.world_from_camera);
        out.has_world = 1;
        out.registered = 1;
        out.frame_period_s = 1.0 / simulator_->scenario().frames_per_second;
        return out;
    }

    toile_status poll(std::uint32_t stream, toile_frame& out) {
        const sensor::DepthCamera& camera = of(stream);
        const sensor::Scenario& scenario = simulator_->scenario();
        std::uint32_t frame = next_[stream];
        if (live_ && frame < scenario.frames) {
            if (started_s_ < 0.0) started_s_ = wall_seconds();
            const double due = (wall_seconds() - started_s_) * scenario.frames_per_second;
            if (due < frame) return TOILE_NO_NEW_DATA;
            frame = std::min(scenario.frames - 1, static_cast<std::uint32_t>(due));
        }
        if (frame >= scenario.frames) return TOILE_END_OF_STREAM;
        simulator_->show(frame);
        simulator_->see(stream);
        next_[stream] = frame + 1;
        out.camera = stream;
        out.sequence = frame;
        out.timestamp_ns = static_cast<std::int64_t>(std::llround(1e9 * scenario.time_of(frame)));
        out.depth_m = sdk::view_of<float>(camera.depth().metres);
        const toile::imaging::Image& picture = simulator_->picture(stream);
        out.color =
            sdk::view_of<sdk::Byte4>({reinterpret_cast<const sdk::Byte4*>(picture.pixels.data()),
                                      picture.pixels.size() / 4});
        return TOILE_OK;
    }

    void release(const toile_frame&) {}

    // ---- toile.truth/1

    std::uint32_t true_people(std::uint32_t sequence, const sdk::SizedArray<toile_person>& people) {
        show(sequence);
        const auto truth = simulator_->people();
        if (truth.size() > people.size())
            throw sdk::Failure(TOILE_E_CAPACITY, "people: no room for all");
        for (std::uint32_t p = 0; p < truth.size(); ++p) {
            toile_person& person = people[p];
            person.has_new_body = 0;
            person.body = nullptr;
            person.state.person_id = truth[p].id;
            person.state.tracking = TOILE_TRACKING_TRACKED;
            person.state.sequence = sequence;
            person.state.timestamp_ns = static_cast<std::int64_t>(
                std::llround(1e9 * simulator_->scenario().time_of(sequence)));
            const auto joints =
                sdk::span_of<toile_joint>(person.joints, "people.joints", TOILE_JOINT_COUNT);
            for (std::size_t j = 0; j < joints.size(); ++j) {
                joints[j] = {};
                std::copy_n(truth[p].joints[j].translation.data(), 3, joints[j].position);
                std::copy_n(truth[p].joints[j].rotation.coeffs().data(), 4, joints[j].rotation);
                joints[j].confidence = 1.0f;
            }
        }
        return static_cast<std::uint32_t>(truth.size());
    }

    toile_true_camera true_camera(std::uint32_t stream) {
        toile_true_camera out{};
        out.size = sizeof(out);
        copy(of(stream).settings().world_from_camera, out.world_from_camera);
        out.depth_scale = of(stream).errors().depth_scale;
        out.name = of(stream).settings().name.c_str();
        return out;
    }

    std::uint32_t true_surface_count() {
        std::uint32_t count = 0;
        if (simulator_)
            for (const auto& figure : simulator_->figures())
                count += static_cast<std::uint32_t>(figure->surfaces().size());
        return count;
    }

    toile_true_surface true_surface(std::uint32_t sequence, std::uint32_t index,
                                    toile_mesh_sink& sink) {
        if (index >= true_surface_count()) throw sdk::bad_argument("index: no such surface");
        show(sequence);
        std::uint32_t person = 0;
        while (index >= simulator_->figures()[person]->surfaces().size())
            index -= static_cast<std::uint32_t>(simulator_->figures()[person++]->surfaces().size());
        const sensor::FigureSurface& found = simulator_->figures()[person]->surfaces()[index];
        give(found, sink);
        return {sizeof(toile_true_surface), static_cast<std::uint32_t>(found.role), person + 1, 0,
                found.surface.name.c_str()};
    }

  private:
    const sensor::DepthCamera& of(std::uint32_t stream) const {
        if (!simulator_) throw sdk::bad_argument("the sensor is not open");
        if (stream >= next_.size()) throw sdk::bad_argument("stream: there is no such camera");
        return simulator_->camera(stream);
    }

    void show(std::uint32_t sequence) {
        if (!simulator_) throw sdk::bad_argument("the sensor is not open");
        if (sequence >= simulator_->scenario().frames)
            throw sdk::bad_argument("sequence: there is no such frame");
        simulator_->show(sequence);
    }

    static void give(const sensor::FigureSurface& surface, toile_mesh_sink& sink) {
        toile_mesh_buffers buffers{};
        buffers.size = sizeof(buffers);
        const auto check = [](toile_status status) {
            if (status < 0) throw sdk::Failure(status, "the surface was not taken");
        };
        const auto& triangles = surface.surface.triangles;
        check(sink.begin(&sink, static_cast<std::uint32_t>(surface.positions.size()),
                         static_cast<std::uint32_t>(triangles.size()), &buffers));
        const auto positions =
            sdk::span_of<sdk::Float3>(buffers.positions, "positions", surface.positions.size());
        for (std::size_t v = 0; v < positions.size(); ++v)
            std::copy_n(surface.positions[v].data(), 3, positions[v].data());
        const auto out =
            sdk::span_of<sdk::Triangle>(buffers.triangles, "triangles", triangles.size());
        std::copy(triangles.begin(), triangles.end(), out.begin());
        check(sink.commit(&sink));
    }

    sdk::ThreadPool pool_;
    std::unique_ptr<sensor::Simulator> simulator_;
    std::vector<std::uint32_t> next_; // frame that each stream gives next
    bool live_ = false;
    double started_s_ = -1.0; // live clock: when the first frame was given
};

} // namespace

TOILE_PLUGIN(simulated_sensor, SimulatedSensor)
