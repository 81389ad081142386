// Follows test people seen by one simulated camera and compares the joints with the true ones.
//
//     track_evaluation MODEL_FOLDER PEOPLE_FOLDER --motions DIR [--count N] [--seconds S]
//         [--noise usual|full] [--clutter] [--pictures DIR] [--colour [--suit]] [--labels]
//     track_evaluation MODEL_FOLDER PEOPLE_FOLDER --write-motions DIR
//     track_evaluation MODEL_FOLDER PEOPLE_FOLDER --dressed CASES_FOLDER
//
// `--colour`: twice on the same frames, without and with the colour picture. `--suit`: people wear
// a printed sports suit. `--write-motions` leaves the motions of its own for each person, to dress
// people in them (scripts/track-accuracy); `--dressed` follows what that made: surface caches
// CASES/PERSON--MOTION.
#include "body/joint_limits.h"
#include "body/motion.h"
#include "body/rotations.h"
#include "body/test_person.h"
#include "body/track_file.h"
#include "body/usual_poses.h"
#include "body_tracker/body_tracking.h"
#include "body_tracker/part_painter.h"
#include "core/error.h"
#include "core/random.h"
#include "evaluation/simulated_views.h"
#include "evaluation/track_errors.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
namespace sensor = toile::simulated_sensor;
namespace body = toile::body;
namespace tracker = toile::body_tracker;
using body::Joint;
using body::kJointCount;
using toile::Vec3d;
using toile::Vec3f;
using namespace toile::evaluation;

struct Settings {
    fs::path model, people, motions, pictures, forest, dressed, write_motions;
    std::size_t count = 1000, first = 0;
    double seconds = 8.0;
    std::string noise = "usual", only;
    bool learn_shape = true, smooth = true, clutter = false, colour = false, suit = false;
    bool labels = false, frames = false;
    float colour_weight = 1.0f;
    std::uint64_t seed = 5;
    int picture_every = 15;
};

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Depth with the body drawn over it.
void save_picture(const tracker::BodyTracking& tracking, const fs::path& file) {
    const auto& grid = tracking.grid();
    const int w = grid.camera.width, h = grid.camera.height, k = 4;
    toile::imaging::Image image;
    image.width = 2 * w * k;
    image.height = h * k;
    image.pixels.assign(static_cast<std::size_t>(image.width * image.height * 4), 255);
    const auto& person = *tracking.people()[0];
    for (int y = 0; y < h * k; ++y)
        for (int x = 0; x < 2 * w * k; ++x) {
            const auto i = static_cast<std::size_t>(y / k * w + x / k % w);
            const float d = grid.depth[i];
            auto* p = image.pixels.data() + 4 * static_cast<std::size_t>(y * image.width + x);
            const auto shade = static_cast<std::uint8_t>(
                d == 0.0f ? 0.0f : std::clamp(255.0f - 45.0f * d, 20.0f, 255.0f));
            p[0] = p[1] = p[2] = shade;
            if (tracking.scene().labels()[i] != 0) p[2] = 120;
            const bool mine = const_cast<tracker::PersonTrack&>(person).mask().cells[i] != 0;
            if (mine) p[1] = 255;
            if (x >= w * k && person.active()) {
                const auto& cell = person.registration().drawing().cells[i];
                if (cell.depth != 0.0f) {
                    const auto& posed = person.registration().posed();
                    const auto& t =
                        person.body().level().triangles[static_cast<std::size_t>(cell.triangle)];
                    const float light = std::clamp(posed.normals[t[0]].z(), 0.1f, 1.0f);
                    p[0] = static_cast<std::uint8_t>(255.0f * light);
                    p[1] = static_cast<std::uint8_t>(140.0f * light);
                    p[2] = mine ? 60 : 200;
                }
            }
        }
    toile::imaging::save_image(image, file);
}

struct Case {
    std::string name;
    fs::path motion;          ///< a surface cache of somebody dressed, or a motion
    double turntable_s = 0.0; ///< seconds a turn on the spot
    double turn = 0.0;        ///< radians, of the whole motion
};

/// What moves in a case, and how its joints are seen.
struct Subject {
    sensor::BodyKind kind = sensor::BodyKind::test_person;
    fs::path source;
    double seconds = 0.0;
    Vec3f middle = Vec3f::Zero(); ///< of the hips' way
    Visibility visibility;
};

/// Boxes of a table, a chair and a shelf, as triangles of one mesh: middle of the foot at 0.
toile::geometry::TriangleMesh boxes(std::span<const std::array<float, 6>> all) {
    toile::geometry::TriangleMesh out;
    for (const auto& [x0, y0, z0, x1, y1, z1] : all) {
        const auto at = static_cast<std::uint32_t>(out.positions.size());
        for (std::uint32_t corner = 0; corner < 8; ++corner)
            out.positions.emplace_back((corner & 1U) != 0 ? x1 : x0, (corner & 2U) != 0 ? y1 : y0,
                                       (corner & 4U) != 0 ? z1 : z0);
        constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
            {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
        for (const auto& f : kFaces) {
            out.triangles.push_back({at + f[0], at + f[1], at + f[2]});
            out.triangles.push_back({at + f[0], at + f[2], at + f[3]});
        }
    }
    return out;
}

/// A table behind the person, a chair beside, a shelf of a person's size, and a low stool before
/// one leg.
void add_clutter(sensor::SceneSettings& scene, toile::Random& random) {
    using Box = std::array<float, 6>;
    const std::vector<std::pair<const char*, std::vector<Box>>> things{
        {"table",
         {Box{-0.6f, 0.71f, -0.4f, 0.6f, 0.75f, 0.4f},
          Box{-0.55f, 0.0f, -0.35f, -0.5f, 0.71f, -0.3f},
          Box{0.5f, 0.0f, -0.35f, 0.55f, 0.71f, -0.3f},
          Box{-0.55f, 0.0f, 0.3f, -0.5f, 0.71f, 0.35f},
          Box{0.5f, 0.0f, 0.3f, 0.55f, 0.71f, 0.35f}}},
        {"chair",
         {Box{-0.2f, 0.42f, -0.2f, 0.2f, 0.46f, 0.2f}, Box{-0.2f, 0.46f, -0.2f, 0.2f, 0.9f, -0.17f},
          Box{-0.2f, 0.0f, -0.2f, -0.16f, 0.42f, -0.16f},
          Box{0.16f, 0.0f, -0.2f, 0.2f, 0.42f, -0.16f},
          Box{-0.2f, 0.0f, 0.16f, -0.16f, 0.42f, 0.2f},
          Box{0.16f, 0.0f, 0.16f, 0.2f, 0.42f, 0.2f}}},
        {"shelf", {Box{-0.25f, 0.0f, -0.15f, 0.25f, 1.7f, 0.15f}}},
        {"stool", {Box{-0.18f, 0.0f, -0.18f, 0.18f, 0.4f, 0.18f}}}};
    const std::array<Vec3f, 4> places{Vec3f(-0.7f, 0.0f, -1.6f), Vec3f(1.15f, 0.0f, -0.2f),
                                      Vec3f(-1.35f, 0.0f, -0.3f), Vec3f(0.25f, 0.0f, 0.75f)};
    for (std::size_t i = 0; i < things.size(); ++i) {
        const fs::path file = fs::temp_directory_path() / ("toile_" + std::to_string(getpid()) +
                                                           "_" + things[i].first + ".glb");
        toile::assets::Scene mesh;
        add_mesh(mesh, boxes(things[i].second), Vec3f::Constant(0.3f));
        toile::assets::save_scene(mesh, file);
        sensor::ObjectSettings object;
        object.mesh = file;
        const auto somewhere = [&] { return static_cast<float>(random.uniform(-0.1, 0.1)); };
        object.position = places[i] + Vec3f(somewhere(), 0.0f, somewhere());
        object.turn = random.uniform(-0.5, 0.5);
        scene.objects.push_back(object);
    }
}

/// One frame's joints that are seen and far off.
void list(std::uint32_t frame, const FrameErrors& errors, const tracker::PersonTrack& person) {
    std::printf("  %4u %s unexplained %4.1f %%, %4.1f mm:", frame,
                errors.called_tracked ? "tracked  " : "uncertain",
                100.0 * static_cast<double>(person.agreement().unexplained),
                1e3 * static_cast<double>(person.agreement().error_m));
    std::printf(errors.failed ? " FAILED" : errors.good ? " good" : "");
    for (std::size_t j = 0; j < kJointCount; ++j)
        if (errors.off_mm[j] >= 100.0f)
            std::printf(" %s %.0f", std::string(body::joint_name(static_cast<Joint>(j))).c_str(),
                        static_cast<double>(errors.off_mm[j]));
    std::printf("\n");
}

class Evaluation {
  public:
    explicit Evaluation(const Settings& settings) : settings_(settings), model_(settings.model) {
        if (!settings.forest.empty())
            forest_ = std::make_shared<tracker::Forest>(tracker::load_forest(settings.forest));
    }

    /// \param folder of the test person, who wears clothes when the case is of dressed people
    /// \return one, or with colour two: without and with it
    std::vector<TrackSums> run(const fs::path& folder, const body::TestPerson& person,
                               const Case& one, std::uint64_t seed) {
        toile::Random random(seed);
        sensor::Scenario scenario = toile::evaluation::empty_room();
        scenario.seed = seed;
        scenario.color = settings_.colour;
        scenario.frames_per_second = kTrackRate;
        const Subject subject = subject_of(folder, person, one);
        scenario.frames = static_cast<std::uint32_t>(
            std::max(2.0, std::min(settings_.seconds, subject.seconds) * kTrackRate));
        sensor::PersonSettings who;
        who.kind = subject.kind;
        who.source = subject.source;
        if (who.kind == sensor::BodyKind::test_person) who.motion = one.motion;
        who.suit = settings_.suit && who.kind == sensor::BodyKind::test_person;
        who.position = Vec3f(-subject.middle.x(), 0.0f, -subject.middle.z());
        who.turn = one.turn + random.uniform(-0.5, 0.5);
        who.turntable_s = one.turntable_s;
        who.position = body::about(Vec3f::UnitY(), static_cast<float>(who.turn)) * who.position;
        scenario.people.push_back(who);
        if (settings_.clutter) add_clutter(scenario.scene, random);
        sensor::CameraSettings camera = sensor::camera_of(sensor::CameraModel::kinect_v1);
        const double distance = random.uniform(2.2, 3.3), height = random.uniform(0.8, 1.8);
        camera.world_from_camera = sensor::look_at(Vec3d(0.0, height, distance),
                                                   Vec3d(random.uniform(-0.15, 0.15), 0.95, 0.0));
        camera.noise = settings_.noise == "full" ? sensor::full_noise(camera.model)
                                                 : sensor::usual_noise(camera.model);
        scenario.cameras.push_back(camera);
        sensor::Simulator simulator(scenario, &toile::evaluation::rows_on_all_cores);
        tracker::TrackingOptions options;
        options.person.learn_shape = settings_.learn_shape;
        options.person.smoothing.on = settings_.smooth;
        options.person.forest = forest_;
        std::vector<std::unique_ptr<tracker::BodyTracking>> ways;
        for (std::size_t w = 0; w < (settings_.colour ? 2U : 1U); ++w) {
            options.person.marks.weight = w == 0 ? 0.0f : settings_.colour_weight;
            ways.push_back(std::make_unique<tracker::BodyTracking>(
                model_, simulator.camera(0).intrinsics(), simulator.camera(0).reported_pose(),
                options));
        }
        std::vector<TrackSums> sums(ways.size());
        std::vector<std::size_t> swaps(ways.size(), 0);
        tracker::PartPainter painter(ways.back()->people()[0]->body(), forest_.get(),
                                     simulator.camera(0).intrinsics());
        for (std::uint32_t f = 0; f < scenario.frames; ++f) {
            simulator.show(f);
            simulator.see(0);
            const auto* colour = settings_.colour ? simulator.picture(0).pixels.data() : nullptr;
            for (std::size_t w = 0; w < ways.size(); ++w) {
                const double began = cpu_ms();
                ways[w]->update(simulator.camera(0).depth().metres.data(),
                                static_cast<std::int64_t>(1e9 * scenario.time_of(f)), colour);
                sums[w].ms.push_back(cpu_ms() - began);
                const tracker::PersonTrack& track = *ways[w]->people()[0];
                const FrameErrors errors =
                    compare(simulator, 0, track, subject.visibility, sums[w]);
                if (settings_.frames) list(f, errors, track);
                swaps[w] = swapped(simulator, track) ? swaps[w] + 1 : 0;
                sums[w].swapped += swaps[w] > 0 ? 1 : 0;
                sums[w].longest_swap = std::max(sums[w].longest_swap, swaps[w]);
            }
            if (settings_.labels)
                rate_labels(simulator, *ways.back(), person, painter, sums.back());
            if (!settings_.pictures.empty() &&
                f % static_cast<std::uint32_t>(settings_.picture_every) == 0)
                save_picture(*ways.back(),
                             settings_.pictures / (one.name + "_" + std::to_string(seed) + "_" +
                                                   std::to_string(1000 + f) + ".png"));
        }
        for (TrackSums& one_way : sums)
            one_way.end_case();
        return sums;
    }

  private:
    [[nodiscard]] Subject subject_of(const fs::path& folder, const body::TestPerson& person,
                                     const Case& one) const {
        if (!settings_.dressed.empty()) {
            const body::SurfaceCache cache = body::open_surface_cache(one.motion);
            Subject out{sensor::BodyKind::surfaces, one.motion,
                        cache.frames.back().time_s - cache.frames.front().time_s, Vec3f::Zero(),
                        Visibility(model_.level(0))};
            // Who stands turns for as long as asked.
            if (one.turntable_s > 0.0) out.seconds = 1e9;
            for (const body::TrackFrame& frame : cache.frames)
                out.middle += frame.people.front().joints[0].translation /
                              static_cast<float>(cache.frames.size());
            return out;
        }
        const body::Motion motion = body::load_motion(one.motion, person.skeleton);
        Subject out{sensor::BodyKind::test_person, folder, motion.duration(), Vec3f::Zero(),
                    Visibility(person)};
        const auto frames = static_cast<std::uint32_t>(
            std::max(2.0, std::min(settings_.seconds, motion.duration()) * kTrackRate));
        for (std::uint32_t f = 0; f < frames; ++f)
            out.middle +=
                body::sample(motion, f / kTrackRate).hips_position / static_cast<float>(frames);
        return out;
    }

    const Settings& settings_;
    body::FitModel model_;
    std::shared_ptr<const tracker::Forest> forest_;
};

constexpr std::array kWays{"", " with colour"};

void print_all(const std::string& name, TrackSums& sums) {
    if (sums.frames == 0) return;
    print(name, sums);
    std::printf("  stated confidence: share of joints within 10 cm (joints)\n");
    for (std::size_t t = 0; t < sums.stated.size(); ++t)
        std::printf("  %.1f  %5.1f %% (%zu)\n", 0.1 * static_cast<double>(t),
                    percent(sums.kept[t], sums.stated[t]), sums.stated[t]);
    for (std::size_t j = 0; j < kJointCount; ++j)
        std::printf(
            "  %-16s %5.1f mm, seen and beyond 10 cm in %4.1f %% of the frames; "
            "mean right %.0f, up %.0f, to the camera %.0f mm\n",
            std::string(body::joint_name(static_cast<Joint>(j))).c_str(),
            sums.joint[j] / static_cast<double>(std::max<std::size_t>(1, sums.joint_count[j])),
            percent(sums.off[j], sums.frames), sums.lean[j].x() / static_cast<double>(sums.frames),
            sums.lean[j].y() / static_cast<double>(sums.frames),
            sums.lean[j].z() / static_cast<double>(sums.frames));
}

void run(const Settings& settings) {
    Evaluation evaluation(settings);
    std::vector<fs::path> people;
    for (const auto& entry : fs::directory_iterator(settings.people))
        if (fs::exists(entry.path() / "person.json")) people.push_back(entry.path());
    std::sort(people.begin(), people.end());
    std::vector<fs::path> motions;
    if (!settings.motions.empty())
        for (const char* name : {"02_01.bvh", "Boxing_Toes.bvh"})
            motions.push_back(settings.motions / name);
    std::vector<TrackSums> all(settings.colour ? 2 : 1);
    std::size_t done = 0;
    for (std::size_t n = settings.first; n < people.size() && done < settings.count; ++n, ++done) {
        const body::TestPerson person = body::load_test_person(people[n]);
        const fs::path walk = random_walk(person, settings.seconds, settings.seed + n);
        const fs::path standing = stand_still(person);
        if (!settings.write_motions.empty()) {
            fs::create_directories(settings.write_motions);
            for (const auto& [file, name] :
                 {std::pair(walk, "random"), std::pair(standing, "turn")}) {
                fs::copy_file(file, settings.write_motions / (person.id + "--" + name + ".jsonl"),
                              fs::copy_options::overwrite_existing);
                fs::remove(file);
            }
            continue;
        }
        const auto file_of = [&](const std::string& name, const fs::path& bare) {
            return settings.dressed.empty()
                       ? bare
                       : settings.dressed / (person.id + "--" + name) / "cache";
        };
        std::vector<Case> cases;
        for (const fs::path& file : motions)
            cases.push_back({file.stem().string(), file_of(file.stem().string(), file)});
        cases.push_back({"random", file_of("random", walk)});
        cases.push_back({"turn", file_of("turn", standing), 6.0});
        if (!motions.empty())
            cases.push_back({"away", cases.front().motion, 0.0, std::numbers::pi});
        for (const Case& one : cases) {
            if (!settings.only.empty() && one.name != settings.only) continue;
            std::vector<TrackSums> sums = evaluation.run(people[n], person, one, settings.seed + n);
            for (std::size_t w = 0; w < sums.size(); ++w) {
                print(person.id + " " + one.name + kWays[w], sums[w]);
                all[w].add(sums[w]);
            }
        }
        fs::remove(walk);
        fs::remove(standing);
    }
    for (std::size_t w = 0; w < all.size(); ++w)
        print_all(std::string("all") + kWays[w], all[w]);
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Accuracy of tracking on simulated cameras");
    app.add_option("model", settings.model)->required();
    app.add_option("people", settings.people)->required();
    app.add_option("--motions", settings.motions);
    app.add_option("--count", settings.count);
    app.add_option("--first", settings.first);
    app.add_option("--seconds", settings.seconds);
    app.add_option("--noise", settings.noise);
    app.add_option("--only", settings.only);
    app.add_option("--seed", settings.seed);
    app.add_option("--forest", settings.forest, "plugins/body_tracker/adult.forest");
    app.add_option("--dressed", settings.dressed);
    app.add_option("--write-motions", settings.write_motions);
    app.add_flag("--clutter", settings.clutter, "furniture beside, behind and before the person");
    app.add_flag("--frames", settings.frames, "each frame's joints that are seen and 10 cm off");
    app.add_option("--pictures", settings.pictures);
    app.add_option("--picture-every", settings.picture_every);
    app.add_flag("--colour", settings.colour, "without and with the colour picture");
    app.add_option("--colour-weight", settings.colour_weight);
    app.add_flag("--labels", settings.labels, "the part of each pixel (undressed people only)");
    app.add_flag("--suit", settings.suit, "a printed sports suit on undressed people");
    app.add_flag("!--no-shape", settings.learn_shape);
    app.add_flag("!--no-smoothing", settings.smooth);
    CLI11_PARSE(app, argc, argv);
    try {
        run(settings);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
