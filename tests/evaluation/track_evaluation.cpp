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

constexpr double kRate = 30.0;
constexpr float kSeenTolerance = 0.06f; // metres of noise
constexpr float kVisibleShare = 0.2f;

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

/// Joint whose part each vertex of a test person is: of the joints of its P4 part the one whose
/// bone is nearest.
std::vector<std::size_t> joints_of_vertices(const body::TestPerson& person) {
    const auto part_of = [](Joint joint) {
        switch (joint) {
        case Joint::hips:
            return body::Part::pelvis;
        case Joint::neck:
            return body::Part::neck;
        case Joint::head:
            return body::Part::head;
        case Joint::left_upper_arm:
            return body::Part::left_upper_arm;
        case Joint::right_upper_arm:
            return body::Part::right_upper_arm;
        case Joint::left_lower_arm:
        case Joint::left_hand:
            return body::Part::left_lower_arm;
        case Joint::right_lower_arm:
        case Joint::right_hand:
            return body::Part::right_lower_arm;
        case Joint::left_upper_leg:
            return body::Part::left_upper_leg;
        case Joint::right_upper_leg:
            return body::Part::right_upper_leg;
        case Joint::left_lower_leg:
        case Joint::left_foot:
        case Joint::left_toes:
            return body::Part::left_lower_leg;
        case Joint::right_lower_leg:
        case Joint::right_foot:
        case Joint::right_toes:
            return body::Part::right_lower_leg;
        default:
            return body::Part::torso;
        }
    };
    std::vector<std::size_t> out;
    for (std::size_t v = 0; v < person.rest.positions.size(); ++v) {
        float best = 1e9f;
        std::size_t at = 0;
        for (std::size_t j = 0; j < kJointCount; ++j) {
            if (part_of(static_cast<Joint>(j)) != person.parts[v]) continue;
            const Vec3f from = person.skeleton.rest_positions[j];
            Vec3f to = from;
            for (std::size_t c = j + 1; c < kJointCount; ++c)
                if (body::joint_parent(static_cast<Joint>(c)) == static_cast<Joint>(j) &&
                    part_of(static_cast<Joint>(c)) == person.parts[v]) {
                    to = person.skeleton.rest_positions[c];
                    break;
                }
            const Vec3f along = to - from, off = person.rest.positions[v] - from;
            const float length = along.squaredNorm();
            const float share =
                length > 0.0f ? std::clamp(off.dot(along) / length, 0.0f, 1.0f) : 0.0f;
            const float distance = (off - share * along).norm();
            if (distance < best) best = distance, at = j;
        }
        out.push_back(at);
    }
    return out;
}

/// Share of each joint's part that a camera sees.
class Visibility {
  public:
    explicit Visibility(const body::TestPerson& person)
        : person_(person), joint_(joints_of_vertices(person)) {
        for (const auto& t : person.rest.triangles) {
            const auto& p = person.rest.positions;
            const float third = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm() / 6.0f;
            area_.resize(p.size(), 0.0f);
            for (const auto v : t)
                area_[v] += third;
        }
        for (std::size_t v = 0; v < area_.size(); ++v)
            total_[joint_[v]] += area_[v];
    }
    std::array<float, kJointCount> shares(const std::vector<Vec3f>& positions,
                                          const sensor::DepthCamera& camera) const {
        std::array<float, kJointCount> seen{};
        const Eigen::Isometry3d from_world = camera.settings().world_from_camera.inverse();
        const auto& depth = camera.depth();
        std::vector<Vec3f> normals(positions.size());
        toile::geometry::vertex_normals(positions, person_.rest.triangles, normals);
        const Vec3f eye = camera.settings().world_from_camera.translation().cast<float>();
        for (std::size_t v = 0; v < positions.size(); ++v) {
            if (normals[v].dot(eye - positions[v]) <= 0.0f) continue;
            const Vec3d p = from_world * positions[v].cast<double>();
            const auto pixel = toile::imaging::project(camera.intrinsics(), p);
            if (!pixel) continue;
            const auto x = std::lround(pixel->x()), y = std::lround(pixel->y());
            if (x < 0 || y < 0 || x >= depth.width || y >= depth.height) continue;
            const float d = depth.metres[static_cast<std::size_t>(y * depth.width + x)];
            if (std::abs(d + static_cast<float>(p.z())) < kSeenTolerance)
                seen[joint_[v]] += area_[v];
        }
        for (std::size_t j = 0; j < kJointCount; ++j)
            seen[j] = total_[j] > 0.0f ? seen[j] / total_[j] : 0.0f;
        return seen;
    }

  private:
    const body::TestPerson& person_;
    std::vector<std::size_t> joint_;
    std::vector<float> area_;
    std::array<float, kJointCount> total_{};
};

/// A walk through random poses within the joints' limits, as a track file.
fs::path random_walk(const body::TestPerson& person, double seconds, std::uint64_t seed) {
    toile::Random random(seed);
    const fs::path file = fs::temp_directory_path() / ("toile_walk_" + std::to_string(getpid()) +
                                                       "_" + std::to_string(seed) + ".jsonl");
    std::ofstream out(file);
    float yaw = 0.0f;
    body::Pose from = body::rest_pose(person.skeleton), to = from;
    const auto draw = [&] {
        body::Pose pose = body::random_pose(person.skeleton, random);
        yaw += static_cast<float>(random.uniform(-0.6, 0.6));
        pose.rotations[0] = body::about(Vec3f::UnitY(), yaw) * pose.rotations[0];
        pose.hips_position = Vec3f::Zero();
        pose.hips_position.y() =
            -body::lowest_sole(person.skeleton, body::forward_kinematics(person.skeleton, pose));
        return pose;
    };
    const auto frames = static_cast<int>(seconds * kRate);
    for (int f = 0; f <= frames; ++f) {
        const int within = f % 36;
        if (within == 0) from = to, to = draw();
        const float s = body::smooth_step(0.0f, 36.0f, static_cast<float>(within));
        body::Pose pose = from;
        pose.hips_position += s * (to.hips_position - from.hips_position);
        for (std::size_t j = 0; j < kJointCount; ++j)
            pose.rotations[j] = from.rotations[j].slerp(s, to.rotations[j]);
        body::TrackedPerson one;
        one.id = 1;
        one.state = body::TrackState::tracked;
        one.joints = body::forward_kinematics(person.skeleton, pose);
        one.confidence.fill(1.0f);
        out << body::track_line(static_cast<std::uint64_t>(f), f / kRate, std::span(&one, 1));
    }
    return file;
}

/// Arms hanging, for longer than anybody looks.
fs::path stand_still(const body::TestPerson& person) {
    const fs::path file =
        fs::temp_directory_path() / ("toile_stand_" + std::to_string(getpid()) + ".jsonl");
    body::Pose pose = body::usual_pose(person.skeleton, body::usual_arms().front(), 0.0f);
    pose.hips_position.y() -=
        body::lowest_sole(person.skeleton, body::forward_kinematics(person.skeleton, pose));
    body::TrackedPerson one;
    one.id = 1;
    one.state = body::TrackState::tracked;
    one.joints = body::forward_kinematics(person.skeleton, pose);
    std::ofstream out(file);
    for (const double time : {0.0, 60.0})
        out << body::track_line(time > 0.0 ? 1 : 0, time, std::span(&one, 1));
    return file;
}

struct Sums {
    double visible = 0, all = 0;
    std::size_t visible_count = 0, all_count = 0, near = 0;
    std::size_t frames = 0, called = 0, good_frames = 0, failed_frames = 0;
    std::array<double, kJointCount> joint{};
    std::array<std::size_t, kJointCount> joint_count{};
    std::size_t swapped = 0, longest_swap = 0; ///< frames in which left and right are exchanged
    std::vector<double> ms;
    void add(const Sums& o) {
        visible += o.visible, all += o.all, visible_count += o.visible_count;
        all_count += o.all_count, near += o.near, frames += o.frames, called += o.called;
        good_frames += o.good_frames, failed_frames += o.failed_frames;
        swapped += o.swapped;
        longest_swap = std::max(longest_swap, o.longest_swap);
        for (std::size_t j = 0; j < kJointCount; ++j)
            joint[j] += o.joint[j], joint_count[j] += o.joint_count[j];
        ms.insert(ms.end(), o.ms.begin(), o.ms.end());
    }
};

double share(std::size_t a, std::size_t b) {
    return 100.0 * static_cast<double>(a) / static_cast<double>(std::max<std::size_t>(1, b));
}

void print(const std::string& name, Sums& s) {
    std::sort(s.ms.begin(), s.ms.end());
    const auto at = [&](double q) {
        return s.ms.empty()
                   ? 0.0
                   : s.ms[static_cast<std::size_t>(q * static_cast<double>(s.ms.size() - 1))];
    };
    std::printf(
        "%-34s n %4zu vis %5.1f all %5.1f mm, tracked %5.1f %%, <10cm %5.1f %%, frames %5.1f %%, "
        "failed %5.1f %%, swap %zu, ms %.1f p95 %.1f max %.1f\n",
        name.c_str(), s.frames,
        s.visible / static_cast<double>(std::max<std::size_t>(1, s.visible_count)),
        s.all / static_cast<double>(std::max<std::size_t>(1, s.all_count)),
        share(s.called, s.frames), share(s.near, s.visible_count), share(s.good_frames, s.frames),
        share(s.failed_frames, s.frames), s.longest_swap, at(0.5), at(0.95), at(1.0));
    std::fflush(stdout);
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

    Sums run(const fs::path& folder, const body::TestPerson& person, const Case& one,
             std::uint64_t seed) {
        toile::Random random(seed);
        sensor::Scenario scenario = toile::evaluation::empty_room();
        scenario.seed = seed;
        scenario.frames_per_second = kRate;
        const body::Motion motion = body::load_motion(one.motion, person.skeleton);
        scenario.frames = static_cast<std::uint32_t>(
            std::max(2.0, std::min(settings_.seconds, motion.duration()) * kRate));
        sensor::PersonSettings who;
        who.kind = sensor::BodyKind::test_person;
        who.source = folder;
        who.motion = one.motion;
        Vec3f middle = Vec3f::Zero();
        for (std::uint32_t f = 0; f < scenario.frames; ++f)
            middle +=
                body::sample(motion, f / kRate).hips_position / static_cast<float>(scenario.frames);
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
        Sums sums;
        std::size_t swaps = 0;
        for (std::uint32_t f = 0; f < scenario.frames; ++f) {
            simulator.show(f);
            simulator.see(0);
            const double began = cpu_ms();
            tracking.update(simulator.camera(0).depth().metres.data(),
                            static_cast<std::int64_t>(1e9 * scenario.time_of(f)));
            sums.ms.push_back(cpu_ms() - began);
            compare(simulator, tracking, visibility, sums);
            swaps = swapped(simulator, tracking) ? swaps + 1 : 0;
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
    /// Are hips and shoulders nearer to the truth with left and right exchanged?
    static bool swapped(const sensor::Simulator& simulator, const tracker::BodyTracking& tracking) {
        const auto& person = *tracking.people()[0];
        if (!person.active()) return false;
        const auto& truth = *simulator.figures()[0]->joints();
        const Eigen::Isometry3f place = simulator.camera(0).reported_pose().cast<float>();
        float as_is = 0.0f, exchanged = 0.0f;
        for (const Joint joint : {Joint::left_upper_arm, Joint::right_upper_arm,
                                  Joint::left_upper_leg, Joint::right_upper_leg}) {
            const Vec3f at = place * person.joints()[static_cast<std::size_t>(joint)].translation;
            as_is += (at - truth[static_cast<std::size_t>(joint)].translation).norm();
            exchanged +=
                (at - truth[static_cast<std::size_t>(body::opposite_joint(joint))].translation)
                    .norm();
        }
        return exchanged < as_is;
    }

    static void compare(const sensor::Simulator& simulator, const tracker::BodyTracking& tracking,
                        const Visibility& visibility, Sums& sums) {
        const auto& figure = *simulator.figures()[0];
        const auto shares = visibility.shares(figure.surfaces()[0].positions, simulator.camera(0));
        const auto& truth = *figure.joints();
        std::size_t visible = 0;
        for (const float s : shares)
            visible += s >= kVisibleShare ? 1 : 0;
        if (visible == 0) return; // not in view
        ++sums.frames;
        const auto& person = *tracking.people()[0];
        const bool called = person.active() && person.following() != tracker::Following::lost;
        sums.called += called && person.following() != tracker::Following::uncertain ? 1 : 0;
        const Eigen::Isometry3f place = simulator.camera(0).reported_pose().cast<float>();
        bool good = true, failed = false;
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const double off =
                called ? 1000.0 * static_cast<double>((place * person.joints()[j].translation -
                                                       truth[j].translation)
                                                          .norm())
                       : 500.0;
            sums.all += off;
            ++sums.all_count;
            sums.joint[j] += off;
            ++sums.joint_count[j];
            if (shares[j] < kVisibleShare) continue;
            sums.visible += off;
            ++sums.visible_count;
            sums.near += off < 100.0 ? 1 : 0;
            good = good && off < 100.0;
            failed = failed || off > 150.0;
        }
        sums.good_frames += good ? 1 : 0;
        sums.failed_frames += failed ? 1 : 0;
    }

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
    Sums all;
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
            Sums sums = evaluation.run(people[n], person, one, settings.seed + n);
            print(person.id + " " + one.name, sums);
            all.add(sums);
        }
        fs::remove(walk);
        fs::remove(standing);
    }
    print("all", all);
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
