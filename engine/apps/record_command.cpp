// toile record: a sensor's pictures as capture folders, and the truth where the sensor knows it.
#include "apps/commands.h"
#include "apps/plugin_limits.h"
#include "apps/run_output.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/log.h"
#include "imaging/capture_folder.h"
#include "imaging/oni_writer.h"
#include "pipeline/sensor_source.h"

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct RecordOptions {
    std::string source;
    std::string out;
    std::uint64_t frames = 0;
    bool realtime = false;
    bool surfaces = true;
};

/// One camera's folder being written, with truth.jsonl and truth_camera.json where known.
class CameraRecorder {
  public:
    CameraRecorder(pipeline::SensorSource& source, std::uint32_t stream, fs::path folder)
        : source_(source), stream_(stream), folder_(std::move(folder)),
          writer_(folder_, source.streams()[stream].depth,
                  source.streams()[stream].world_from_camera) {
        if (!source_.knows_truth()) return;
        const pipeline::TrueCamera camera = source_.true_camera(stream);
        const Eigen::Matrix4d m = camera.world_from_camera.matrix();
        nlohmann::ordered_json json;
        json["world_from_camera"] = std::vector<double>(m.data(), m.data() + 16);
        json["depth_scale"] = camera.depth_scale;
        write_text(folder_ / "truth_camera.json", json.dump(2) + "\n");
    }

    /// Records one frame; false when there was none.
    bool record() {
        if (source_.ended(stream_) || !source_.next(stream_, frame_)) return false;
        if (writer_.frame_count() == 0) first_ns_ = frame_.timestamp_ns;
        const double time_s = 1e-9 * static_cast<double>(frame_.timestamp_ns - first_ns_);
        const std::uint32_t number = writer_.frame_count();
        writer_.add(time_s, frame_.depth, frame_.color.empty() ? nullptr : &frame_.color);
        if (!source_.knows_truth()) return true;
        std::ofstream truth(folder_ / "truth.jsonl", std::ios::app | std::ios::binary);
        truth << body::track_line(number, time_s, source_.true_people(frame_.sequence));
        truth.close();
        if (!truth) throw FileError((folder_ / "truth.jsonl").string(), "cannot be written");
        return true;
    }

    [[nodiscard]] const pipeline::SensorFrame& frame() const { return frame_; }
    [[nodiscard]] std::uint32_t frame_count() const { return writer_.frame_count(); }

  private:
    pipeline::SensorSource& source_;
    std::uint32_t stream_;
    fs::path folder_;
    imaging::CaptureWriter writer_;
    pipeline::SensorFrame frame_;
    std::int64_t first_ns_ = 0;
};

/// A file that OpenNI plays.
class OniRecorder {
  public:
    OniRecorder(pipeline::SensorSource& source, const fs::path& file)
        : source_(source),
          writer_(file, source.streams().front().depth, source.streams().front().has_color,
                  1.0 / std::max(1e-3, source.streams().front().frame_period_s)) {
        const imaging::Intrinsics& camera = source.streams().front().depth;
        const Eigen::Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
        if ((middle - Eigen::Vector2d(camera.cx, camera.cy)).norm() > kOffMiddle ||
            camera.distorted())
            log::warning(file.string() +
                         ": an .oni file keeps a camera's field of view alone; its "
                         "principal point or distortion is lost, a folder keeps it");
        if (source.streams().front().world_from_camera)
            log::warning(file.string() + ": an .oni file does not say where the camera stands");
    }

    bool record() {
        if (source_.ended(0) || !source_.next(0, frame_)) return false;
        if (writer_.frame_count() == 0) first_ns_ = frame_.timestamp_ns;
        writer_.add(1e-9 * static_cast<double>(frame_.timestamp_ns - first_ns_), frame_.depth,
                    frame_.color.empty() ? nullptr : &frame_.color);
        return true;
    }
    void finish() { writer_.finish(); }
    [[nodiscard]] std::uint32_t frame_count() const { return writer_.frame_count(); }

  private:
    static constexpr double kOffMiddle = 2.0; // pixels
    pipeline::SensorSource& source_;
    imaging::OniWriter writer_;
    pipeline::SensorFrame frame_;
    std::int64_t first_ns_ = 0;
};

void record_oni(const RecordOptions& options, pipeline::SensorSource& source) {
    if (source.streams().size() != 1)
        throw UsageError("record --out '" + options.out + "': an .oni file holds one camera, and " +
                         options.source + " has " + std::to_string(source.streams().size()) +
                         "; name a folder");
    OniRecorder recorder(source, options.out);
    RunProgress progress;
    while (!source.ended(0) && !host::interrupt_flag()) {
        if (options.frames > 0 && recorder.frame_count() >= options.frames) break;
        if (recorder.record())
            progress.frame();
        else if (!source.ended(0))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    recorder.finish();
    if (recorder.frame_count() == 0) {
        fs::remove(options.out);
        throw Error(options.source + ": gave no frame");
    }
    std::cout << options.out << ": " << recorder.frame_count() << " frames of 1 camera\n";
}

/// DIR/truth: the people's true surfaces, frame by frame, as a surface cache.
class SurfaceRecorder {
  public:
    SurfaceRecorder(pipeline::SensorSource& source, fs::path folder)
        : source_(source), folder_(std::move(folder)) {}

    void record(const pipeline::SensorFrame& frame) {
        const auto surfaces = source_.true_surfaces(frame.sequence);
        if (surfaces.empty()) return;
        if (!writer_) begin(surfaces, frame.timestamp_ns);
        std::vector<std::span<const Vec3f>> positions;
        for (const pipeline::TrueSurface& surface : surfaces)
            positions.emplace_back(surface.mesh.positions);
        writer_->add(1e-9 * static_cast<double>(frame.timestamp_ns - first_ns_),
                     source_.true_people(frame.sequence), positions);
    }

  private:
    void begin(const std::vector<pipeline::TrueSurface>& surfaces, std::int64_t first_ns) {
        assets::Scene scene;
        std::vector<body::SurfaceRole> roles;
        for (const pipeline::TrueSurface& surface : surfaces) {
            assets::Node node;
            node.name = "person" + std::to_string(surface.person_id) + "/" + surface.name;
            node.mesh = static_cast<int>(scene.meshes.size());
            assets::Primitive primitive;
            primitive.positions = surface.mesh.positions;
            primitive.triangles = surface.mesh.triangles;
            scene.meshes.push_back({node.name, {std::move(primitive)}, {}});
            scene.nodes.push_back(node);
            roles.push_back(surface.role);
        }
        writer_.emplace(folder_, scene, roles);
        first_ns_ = first_ns;
    }

    pipeline::SensorSource& source_;
    fs::path folder_;
    std::optional<body::SurfaceCacheWriter> writer_;
    std::int64_t first_ns_ = 0;
};

void record(const RecordOptions& options, const GlobalOptions& global) {
    host::catch_interrupts();
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    host::Job job({}, &host::interrupt_flag());
    pipeline::SensorSource source(options.source, registry, services,
                                  limits_of(global, services, kSensedScene, options.realtime), job);

    const fs::path out(options.out);
    if (out.extension() == ".oni") {
        record_oni(options, source);
        return;
    }
    const auto count = static_cast<std::uint32_t>(source.streams().size());
    std::vector<std::unique_ptr<CameraRecorder>> cameras;
    for (std::uint32_t i = 0; i < count; ++i)
        cameras.push_back(std::make_unique<CameraRecorder>(
            source, i, count == 1 ? out : out / source.streams()[i].name));
    SurfaceRecorder surfaces(source, out / "truth");
    RunProgress progress;
    const auto all_ended = [&] {
        for (std::uint32_t i = 0; i < count; ++i)
            if (!source.ended(i)) return false;
        return true;
    };
    while (!all_ended() && !host::interrupt_flag()) {
        if (options.frames > 0 && cameras.front()->frame_count() >= options.frames) break;
        bool any = false;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!cameras[i]->record()) continue;
            any = true;
            if (i == 0) progress.frame();
            if (i == 0 && options.surfaces && source.knows_truth())
                surfaces.record(cameras[i]->frame());
        }
        if (!any && !all_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (cameras.front()->frame_count() == 0) throw Error(options.source + ": gave no frame");
    std::cout << options.out << ": " << cameras.front()->frame_count() << " frames of " << count
              << (count == 1 ? " camera\n" : " cameras\n");
}

} // namespace

void add_record_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("record", "Records a sensor's pictures");
    const auto options = std::make_shared<RecordOptions>();
    command
        ->add_option("--source", options->source,
                     "Where the pictures come from: openni2: (a camera, its number or FILE.oni), "
                     "capture:DIR, simulated:SCENARIO.json")
        ->type_name("URI")
        ->required();
    command
        ->add_option(
            "--out", options->out,
            "Capture folder; of several cameras each gets a folder below it. Or a file that "
            "OpenNI plays, of one camera")
        ->type_name("DIR|FILE.oni")
        ->required();
    command->add_option("--frames", options->frames, "Stops after this many");
    command->add_flag("--realtime", options->realtime, "Keeps to the source's time");
    command->add_flag("!--no-surfaces", options->surfaces,
                      "Of a simulated sensor: leaves out the true surfaces (DIR/truth)");
    command->footer("Example: toile record --source openni2: --frames 300 --out captures/anna\n"
                    "         toile record --source capture:captures/anna --out anna.oni");
    command->callback([options, &global] { record(*options, global); });
}

} // namespace toile::apps
