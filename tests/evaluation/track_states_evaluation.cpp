// What a tracker says of itself when it goes wrong, how still it stands, and how many people it
// follows at once.
//
//     track_states_evaluation MODEL_FOLDER PEOPLE_FOLDER [--forest FILE] [--failures N] [--seed N]
#include "body/rotations.h"
#include "core/error.h"
#include "core/random.h"
#include "evaluation/simulated_views.h"
#include "evaluation/track_errors.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>

namespace {

namespace fs = std::filesystem;
namespace sensor = toile::simulated_sensor;
namespace body = toile::body;
namespace tracker = toile::body_tracker;
using namespace toile::evaluation;
using body::kJointCount;
using toile::Vec3d;
using toile::Vec3f;

constexpr std::uint32_t kKnown = 145;    // frames until somebody and the shape are known
constexpr std::uint32_t kPerEvent = 225; // frames of a motion for each induced failure
constexpr std::uint32_t kAfter = 3;      // frames after the gap until the pose is judged
constexpr std::uint32_t kRecovered = 10; // and until it should be right again
constexpr std::uint32_t kRestKnown = 150, kRestFrames = 150;

struct Settings {
    fs::path model, people, forest;
    std::size_t failures = 300;
    float share = tracker::TrackOptions{}.failed_share;
    std::uint64_t seed = 5;
};

double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Bench {
    explicit Bench(const Settings& wanted) : settings(wanted), model(wanted.model) {
        if (!settings.forest.empty())
            forest = std::make_shared<tracker::Forest>(tracker::load_forest(settings.forest));
        for (const auto& entry : fs::directory_iterator(settings.people))
            if (fs::exists(entry.path() / "person.json")) people.push_back(entry.path());
        std::sort(people.begin(), people.end());
    }

    static sensor::Scenario scenario(std::uint64_t seed, double distance) {
        sensor::Scenario out = empty_room();
        out.seed = seed;
        out.frames_per_second = kTrackRate;
        sensor::CameraSettings camera = sensor::camera_of(sensor::CameraModel::kinect_v1);
        camera.world_from_camera =
            sensor::look_at(Vec3d(0.0, 1.3, distance), Vec3d(0.0, 0.95, 0.0));
        camera.noise = sensor::usual_noise(camera.model);
        out.cameras.push_back(camera);
        return out;
    }

    static sensor::PersonSettings person(const fs::path& folder, const fs::path& motion, float x,
                                         float z, double turn) {
        sensor::PersonSettings out;
        out.kind = sensor::BodyKind::test_person;
        out.source = folder;
        out.motion = motion;
        out.position = Vec3f(x, 0.0f, z);
        out.turn = turn;
        return out;
    }

    std::unique_ptr<tracker::BodyTracking> tracking(const sensor::Simulator& simulator,
                                                    std::size_t most, bool recover) const {
        tracker::TrackingOptions options;
        options.most_people = most;
        options.person.forest = forest;
        options.person.recover = recover;
        options.person.failed_share = settings.share;
        return std::make_unique<tracker::BodyTracking>(
            model, simulator.camera(0).intrinsics(), simulator.camera(0).reported_pose(), options);
    }

    const Settings& settings;
    body::FitModel model;
    std::shared_ptr<const tracker::Forest> forest;
    std::vector<fs::path> people;
};

/// Neck to hips and thigh: how wrongly they are measured, relative.
double length_error(const tracker::PersonTrack& person, const body::JointTransforms& truth) {
    const auto length = [](const body::JointTransforms& joints, body::Joint a, body::Joint b) {
        return (joints[static_cast<std::size_t>(a)].translation -
                joints[static_cast<std::size_t>(b)].translation)
            .norm();
    };
    const auto error = [&](body::Joint a, body::Joint b) {
        return std::abs(length(person.joints(), a, b) / length(truth, a, b) - 1.0f);
    };
    using body::Joint;
    return 50.0 * static_cast<double>(error(Joint::hips, Joint::neck) +
                                      error(Joint::left_upper_leg, Joint::left_lower_leg));
}

/// Between two frames a person takes another pose and steps aside: what the camera saw last is of
/// no use. Judged after `kAfter` more frames. Only where the person was tracked rightly before.
void induce_failures(const Bench& bench) {
    std::array<TrackSums, 2> sums;
    std::array<std::size_t, 2> failed{}, flagged{}, good{}, alarms{}, all{}, right{};
    std::array<double, 2> mm{}, lengths{};
    const std::size_t per_person = 20;
    for (std::size_t n = 0; n * per_person < bench.settings.failures; ++n) {
        const fs::path folder = bench.people[n % bench.people.size()];
        const body::TestPerson who = body::load_test_person(folder);
        const std::uint64_t seed = bench.settings.seed + n;
        const fs::path walk = random_walk(who, per_person * kPerEvent / kTrackRate, seed);
        sensor::Scenario scenario = Bench::scenario(seed, 2.6);
        scenario.frames = static_cast<std::uint32_t>(per_person) * kPerEvent;
        scenario.people.push_back(Bench::person(folder, walk, 0.0f, 0.0f, 0.0));
        sensor::Simulator simulator(scenario, &rows_on_all_cores);
        const Visibility visibility(who);
        for (std::uint32_t event = 0; event < per_person; ++event) {
            std::array<std::unique_ptr<tracker::BodyTracking>, 2> trackings{
                bench.tracking(simulator, 1, false), bench.tracking(simulator, 1, true)};
            const std::uint32_t first = event * kPerEvent;
            std::array<bool, 2> known{};
            for (std::uint32_t f = 0; f < kKnown + kRecovered; ++f) {
                const std::uint32_t gap = f < kKnown ? 0 : 40 + event % 20;
                simulator.show(std::min(first + f + gap, scenario.frames - 1));
                simulator.see(0);
                for (std::size_t r = 0; r < 2; ++r) {
                    trackings[r]->update(simulator.camera(0).depth().metres.data(),
                                         static_cast<std::int64_t>(1e9 * f / kTrackRate));
                    const FrameErrors errors =
                        compare(simulator, 0, *trackings[r]->people()[0], visibility, sums[r]);
                    if (f + 1 == kKnown) known[r] = errors.good && errors.called_tracked;
                    if (!errors.in_view || !known[r]) continue;
                    if (f + 1 == kKnown + kRecovered) {
                        mm[r] += errors.visible_mm;
                        lengths[r] += length_error(*trackings[r]->people()[0],
                                                   *simulator.figures()[0]->joints());
                        right[r] += errors.failed ? 0 : 1;
                    }
                    if (f + 1 != kKnown + kAfter) continue;
                    ++all[r];
                    failed[r] += errors.failed ? 1 : 0;
                    flagged[r] += errors.failed && !errors.called_tracked ? 1 : 0;
                    good[r] += errors.good ? 1 : 0;
                    alarms[r] += errors.good && !errors.called_tracked ? 1 : 0;
                }
            }
        }
        fs::remove(walk);
    }
    for (std::size_t r = 0; r < 2; ++r)
        std::printf(
            "induced failures, recovery %s: %zu gaps, %zu failed, of them flagged %zu (%.1f "
            "%%); good %zu, false alarms %zu (%.1f %%); ten frames after the gap %.1f %% are "
            "right, visible "
            "joints %.0f mm, lengths %.1f %%\n",
            r == 0 ? "off" : "on", all[r], failed[r], flagged[r], percent(flagged[r], failed[r]),
            good[r], alarms[r], percent(alarms[r], good[r]), percent(right[r], all[r]),
            mm[r] / static_cast<double>(std::max<std::size_t>(1, all[r])),
            lengths[r] / static_cast<double>(std::max<std::size_t>(1, all[r])));
}

/// How far joints of people who stand still move about: the deviation from their own mean.
void stand_at_rest(const Bench& bench) {
    double sum = 0.0, worst = 0.0;
    std::size_t count = 0;
    for (std::size_t n = 0; n < std::min<std::size_t>(4, bench.people.size()); ++n) {
        const body::TestPerson who = body::load_test_person(bench.people[n]);
        const fs::path standing = stand_still(who);
        sensor::Scenario scenario = Bench::scenario(bench.settings.seed + n, 2.6);
        scenario.frames = kRestKnown + kRestFrames;
        scenario.people.push_back(Bench::person(bench.people[n], standing, 0.0f, 0.0f, 0.3));
        sensor::Simulator simulator(scenario, &rows_on_all_cores);
        const auto tracking = bench.tracking(simulator, 1, true);
        std::array<Vec3d, kJointCount> mean{};
        std::array<double, kJointCount> squares{};
        mean.fill(Vec3d::Zero());
        for (std::uint32_t f = 0; f < scenario.frames; ++f) {
            simulator.show(f);
            simulator.see(0);
            tracking->update(simulator.camera(0).depth().metres.data(),
                             static_cast<std::int64_t>(1e9 * f / kTrackRate));
            if (f < kRestKnown) continue;
            for (std::size_t j = 0; j < kJointCount; ++j) {
                const Vec3d at = tracking->people()[0]->joints()[j].translation.cast<double>();
                mean[j] += at / kRestFrames;
                squares[j] += at.squaredNorm() / kRestFrames;
            }
        }
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const double deviation =
                1e3 * std::sqrt(std::max(0.0, squares[j] - mean[j].squaredNorm()));
            sum += deviation;
            worst = std::max(worst, deviation);
            ++count;
        }
        fs::remove(standing);
    }
    std::printf("at rest: deviation %.1f mm on average, worst joint %.1f mm\n",
                sum / static_cast<double>(count), worst);
}

void stand_together(const Bench& bench) {
    sensor::Scenario scenario = Bench::scenario(bench.settings.seed, 3.4);
    scenario.frames = 90;
    std::vector<fs::path> standing;
    for (std::size_t n = 0; n < 6; ++n) {
        const fs::path& folder = bench.people[n % bench.people.size()];
        standing.push_back(stand_still(body::load_test_person(folder)));
        // Three in front, three behind in the gaps.
        const float x = -1.2f + 1.1f * static_cast<float>(n % 3) - (n < 3 ? 0.0f : 0.55f);
        scenario.people.push_back(
            Bench::person(folder, standing.back(), x, n < 3 ? -0.1f : -1.2f, 0.0));
    }
    sensor::Simulator simulator(scenario, &rows_on_all_cores);
    const auto tracking = bench.tracking(simulator, 6, true);
    std::vector<double> ms;
    for (std::uint32_t f = 0; f < scenario.frames; ++f) {
        simulator.show(f);
        simulator.see(0);
        const double began = cpu_ms();
        tracking->update(simulator.camera(0).depth().metres.data(),
                         static_cast<std::int64_t>(1e9 * f / kTrackRate));
        if (f >= 60) ms.push_back(cpu_ms() - began);
    }
    std::sort(ms.begin(), ms.end());
    const auto truth = simulator.people();
    const Eigen::Isometry3f place = simulator.camera(0).reported_pose().cast<float>();
    std::size_t followed = 0;
    double far = 0.0;
    for (const auto& person : tracking->people()) {
        if (!person->active() || person->following() == tracker::Following::lost) continue;
        float nearest = 1e9f;
        for (const auto& one : truth)
            nearest = std::min(
                nearest,
                (place * person->joints()[0].translation - one.joints[0].translation).norm());
        followed += nearest < 0.2f ? 1 : 0;
        far = std::max(far, 1e3 * static_cast<double>(nearest));
    }
    std::printf(
        "six people standing: %zu followed, hips at most %.0f mm off, %.1f ms a frame, %.1f "
        "a person\n",
        followed, far, ms[ms.size() / 2], ms[ms.size() / 2] / 6.0);
    for (const fs::path& file : standing)
        fs::remove(file);
}

} // namespace

int main(int argc, char** argv) {
    Settings settings;
    CLI::App app("Failures, rest and crowds of tracking on simulated cameras");
    app.add_option("model", settings.model)->required();
    app.add_option("people", settings.people)->required();
    app.add_option("--forest", settings.forest, "plugins/body_tracker/adult.forest");
    app.add_option("--failures", settings.failures);
    app.add_option("--failed-share", settings.share);
    app.add_option("--seed", settings.seed);
    CLI11_PARSE(app, argc, argv);
    try {
        const Bench bench(settings);
        stand_at_rest(bench);
        stand_together(bench);
        induce_failures(bench);
    } catch (const std::exception& e) {
        return std::fprintf(stderr, "%s\n", e.what()), 1;
    }
    return 0;
}
