// Follows test people seen by one simulated camera and compares the joints with the true ones.
//
//     track_evaluation MODEL_FOLDER PEOPLE_FOLDER --motions DIR [--count N] [--seconds S]
//         [--noise usual|full] [--json FILE] [--pictures DIR]
#include "body/joint_limits.h"
#include "body/motion.h"
#include "body/rotations.h"
#include "body/test_person.h"
#include "body/track_file.h"
#include "body/usual_poses.h"
#include "body_tracker/body_tracking.h"
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
    fs::path model, people, motions, json, pictures, forest;
    std::size_t count = 1000, first = 0;
    double seconds = 8.0;
    std::string noise = "usual", only;
    bool learn_shape = true, smooth = true;
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
    fs::path motion;
    double turntable_s = 0.0; ///< seconds a turn on the spot
    double turn = 0.0;        ///< radians, of the whole motion
};

class Evaluation {
  public:
    explicit Evaluation(const Settings& settings) : settings_(settings), model_(settings.model) {
        if (!settings.forest.empty())
            forest_ = std::make_shared<tracker::Forest>(tracker::load_forest(settings.forest));
    }

    TrackSums run(const fs::path& folder, const body::TestPerson& person, const Case& one,
                  std::uint64_t seed) {
        toile::Random random(seed);
        sensor::Scenario scenario = toile::evaluation::empty_room();
        scenario.seed = seed;
        scenario.frames_per_second = kTrackRate;
        const body::Motion motion = body::load_motion(one.motion, person.skeleton);
        scenario.frames = static_cast<std::uint32_t>(
            std::max(2.0, std::min(settings_.seconds, motion.duration()) * kTrackRate));
        sensor::PersonSettings who;
        who.kind = sensor::BodyKind::test_person;
        who.source = folder;
        who.motion = one.motion;
        Vec3f middle = Vec3f::Zero();
        for (std::uint32_t f = 0; f < scenario.frames; ++f)
            middle += body::sample(motion, f / kTrackRate).hips_position /
                      static_cast<float>(scenario.frames);
        who.position = Vec3f(-middle.x(), 0.0f, -middle.z());
        who.turn = one.turn + random.uniform(-0.5, 0.5);
        who.turntable_s = one.turntable_s;
        who.position = body::about(Vec3f::UnitY(), static_cast<float>(who.turn)) * who.position;
        scenario.people.push_back(who);
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
        tracker::BodyTracking tracking(model_, simulator.camera(0).intrinsics(),
                                       simulator.camera(0).reported_pose(), options);
        const Visibility visibility(person);
        TrackSums sums;
        std::size_t swaps = 0;
        for (std::uint32_t f = 0; f < scenario.frames; ++f) {
            simulator.show(f);
            simulator.see(0);
            const double began = cpu_ms();
            tracking.update(simulator.camera(0).depth().metres.data(),
                            static_cast<std::int64_t>(1e9 * scenario.time_of(f)));
            sums.ms.push_back(cpu_ms() - began);
            (void)compare(simulator, 0, *tracking.people()[0], visibility, sums);
            swaps = swapped(simulator, *tracking.people()[0]) ? swaps + 1 : 0;
            sums.swapped += swaps > 0 ? 1 : 0;
            sums.longest_swap = std::max(sums.longest_swap, swaps);
            if (!settings_.pictures.empty() &&
                f % static_cast<std::uint32_t>(settings_.picture_every) == 0)
                save_picture(tracking,
                             settings_.pictures / (one.name + "_" + std::to_string(seed) + "_" +
                                                   std::to_string(1000 + f) + ".png"));
        }
        return sums;
    }

  private:
    const Settings& settings_;
    body::FitModel model_;
    std::shared_ptr<const tracker::Forest> forest_;
};

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
    TrackSums all;
    std::size_t done = 0;
    for (std::size_t n = settings.first; n < people.size() && done < settings.count; ++n, ++done) {
        const body::TestPerson person = body::load_test_person(people[n]);
        std::vector<Case> cases;
        for (const fs::path& file : motions)
            cases.push_back({file.stem().string(), file});
        const fs::path walk = random_walk(person, settings.seconds, settings.seed + n);
        cases.push_back({"random", walk});
        const fs::path standing = stand_still(person);
        cases.push_back({"turn", standing, 6.0});
        if (!motions.empty()) cases.push_back({"away", motions.front(), 0.0, std::numbers::pi});
        for (const Case& one : cases) {
            if (!settings.only.empty() && one.name != settings.only) continue;
            TrackSums sums = evaluation.run(people[n], person, one, settings.seed + n);
            print(person.id + " " + one.name, sums);
            all.add(sums);
        }
        fs::remove(walk);
        fs::remove(standing);
    }
    print("all", all);
    std::printf("  stated confidence: share of joints within 10 cm (joints)\n");
    for (std::size_t t = 0; t < all.stated.size(); ++t)
        std::printf("  %.1f  %5.1f %% (%zu)\n", 0.1 * static_cast<double>(t),
                    percent(all.kept[t], all.stated[t]), all.stated[t]);
    for (std::size_t j = 0; j < kJointCount; ++j)
        std::printf("  %-16s %5.1f\n", std::string(body::joint_name(static_cast<Joint>(j))).c_str(),
                    all.joint[j] /
                        static_cast<double>(std::max<std::size_t>(1, all.joint_count[j])));
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
    app.add_option("--json", settings.json);
    app.add_option("--pictures", settings.pictures);
    app.add_option("--picture-every", settings.picture_every);
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
