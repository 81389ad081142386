#include "evaluation/track_errors.h"

#include "body/joint_limits.h"
#include "body/motion.h"
#include "body/rotations.h"
#include "body/track_file.h"
#include "body/usual_poses.h"
#include "core/error.h"
#include "core/random.h"

#include <cstdio>
#include <fstream>
#include <unistd.h>

namespace toile::evaluation {
namespace {

namespace fs = std::filesystem;
namespace sensor = simulated_sensor;
using body::Joint;
using body::kJointCount;

constexpr float kSeenTolerance = 0.06f; // metres of noise
constexpr float kBent = 0.6f;           // radians

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

/// Angle about its bone by which a limb is turned wrongly, radians; `child` is the joint at the
/// bone's other end.
float roll_between(const body::JointTransforms& a, const body::JointTransforms& b, Joint joint,
                   Joint child, const Eigen::Quaternionf& place) {
    const auto j = static_cast<std::size_t>(joint), c = static_cast<std::size_t>(child);
    const Vec3f bone_a = (place * (a[c].translation - a[j].translation)).normalized();
    const Vec3f bone_b = (b[c].translation - b[j].translation).normalized();
    const Quatf turned = body::swing(bone_a, bone_b) * place * a[j].rotation;
    return body::rotation_vector(b[j].rotation * turned.conjugate()).dot(bone_b);
}

Joint child_of(Joint joint);

/// How far the next joint is bent: between the two bones, radians.
float bend_of(const body::JointTransforms& joints, Joint joint) {
    const Joint child = child_of(joint), end = child_of(child);
    const auto place = [&](Joint j) -> const Vec3f& {
        return joints[static_cast<std::size_t>(j)].translation;
    };
    const Vec3f one = place(child) - place(joint), other = place(end) - place(child);
    return std::atan2(one.cross(other).norm(), one.dot(other));
}

Joint child_of(Joint joint) {
    switch (joint) {
    case Joint::left_upper_arm:
        return Joint::left_lower_arm;
    case Joint::right_upper_arm:
        return Joint::right_lower_arm;
    case Joint::left_upper_leg:
        return Joint::left_lower_leg;
    case Joint::right_upper_leg:
        return Joint::right_lower_leg;
    case Joint::left_lower_arm:
        return Joint::left_hand;
    case Joint::right_lower_arm:
        return Joint::right_hand;
    case Joint::left_lower_leg:
        return Joint::left_foot;
    default:
        return Joint::right_foot;
    }
}

} // namespace

Visibility::Visibility(const body::TestPerson& person)
    : triangles_(person.rest.triangles), joint_(joints_of_vertices(person)) {
    weigh(person.rest.positions);
}

Visibility::Visibility(const body::FitLevel& level) : triangles_(level.triangles) {
    for (std::size_t v = 0; v < level.mean.size(); ++v) {
        std::array<float, kJointCount> weight{};
        for (std::size_t k = 0; k < 4; ++k)
            weight[level.skin.joints[v][k]] += level.skin.weights[v][k];
        joint_.push_back(static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) -
                                                  weight.begin()));
    }
    weigh(level.mean);
}

void Visibility::weigh(const std::vector<Vec3f>& rest) {
    area_.assign(rest.size(), 0.0f);
    for (const Triangle& t : triangles_) {
        const float third = (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).norm() / 6.0f;
        for (const auto v : t)
            area_[v] += third;
    }
    for (std::size_t v = 0; v < area_.size(); ++v)
        total_[joint_[v]] += area_[v];
}

std::array<float, kJointCount> Visibility::shares(const std::vector<Vec3f>& positions,
                                                  const sensor::DepthCamera& camera) const {
    std::array<float, kJointCount> seen{};
    const Eigen::Isometry3d from_world = camera.settings().world_from_camera.inverse();
    const auto& depth = camera.depth();
    std::vector<Vec3f> normals(positions.size());
    toile::geometry::vertex_normals(positions, triangles_, normals);
    const Vec3f eye = camera.settings().world_from_camera.translation().cast<float>();
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (normals[v].dot(eye - positions[v]) <= 0.0f) continue;
        const Vec3d p = from_world * positions[v].cast<double>();
        const auto pixel = toile::imaging::project(camera.intrinsics(), p);
        if (!pixel) continue;
        const auto x = std::lround(pixel->x()), y = std::lround(pixel->y());
        if (x < 0 || y < 0 || x >= depth.width || y >= depth.height) continue;
        const float d = depth.metres[static_cast<std::size_t>(y * depth.width + x)];
        if (std::abs(d + static_cast<float>(p.z())) < kSeenTolerance) seen[joint_[v]] += area_[v];
    }
    for (std::size_t j = 0; j < kJointCount; ++j)
        seen[j] = total_[j] > 0.0f ? seen[j] / total_[j] : 0.0f;
    return seen;
}

void TrackSums::add(const TrackSums& o) {
    visible += o.visible, all += o.all, visible_count += o.visible_count;
    all_count += o.all_count, near += o.near, frames += o.frames, called += o.called;
    good_frames += o.good_frames, failed_frames += o.failed_frames;
    swapped += o.swapped, flagged += o.flagged, alarms += o.alarms;
    for (std::size_t b = 0; b < 2; ++b)
        roll[b] += o.roll[b], roll_count[b] += o.roll_count[b], wander[b] += o.wander[b];
    for (std::size_t l = 0; l < marks.size(); ++l)
        for (std::size_t k = 0; k < 2; ++k)
            limb_off[l][k] += o.limb_off[l][k], limb_seen[l][k] += o.limb_seen[l][k],
                marks[l][k] += o.marks[l][k];
    labelled += o.labelled, labels_right += o.labels_right, unlabelled += o.unlabelled;
    labels_beside += o.labels_beside;
    for (std::size_t t = 0; t < stated.size(); ++t)
        stated[t] += o.stated[t], kept[t] += o.kept[t];
    longest_swap = std::max(longest_swap, o.longest_swap);
    for (std::size_t j = 0; j < kJointCount; ++j)
        joint[j] += o.joint[j], joint_count[j] += o.joint_count[j], off[j] += o.off[j],
            lean[j] += o.lean[j];
    ms.insert(ms.end(), o.ms.begin(), o.ms.end());
}

void TrackSums::end_case() {
    for (std::size_t b = 0; b < 2; ++b)
        for (const auto& [count, sum, squares] : {limb[0][b], limb[1][b], limb[2][b], limb[3][b]})
            if (count > 0.0) wander[b] += squares - sum * sum / count;
}

double TrackSums::limb_roll(std::size_t first, std::size_t bent) const {
    return (limb_off[first][bent] + limb_off[first + 1][bent]) /
           static_cast<double>(std::max<std::size_t>(1, limb_count(first, bent)));
}

std::size_t TrackSums::limb_count(std::size_t first, std::size_t bent) const {
    return limb_seen[first][bent] + limb_seen[first + 1][bent];
}

double percent(std::size_t a, std::size_t b) {
    return 100.0 * static_cast<double>(a) / static_cast<double>(std::max<std::size_t>(1, b));
}

void print(const std::string& name, TrackSums& s) {
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
        percent(s.called, s.frames), percent(s.near, s.visible_count),
        percent(s.good_frames, s.frames), percent(s.failed_frames, s.frames), s.longest_swap,
        at(0.5), at(0.95), at(1.0));
    const auto roll = [&](std::size_t bent) {
        return s.roll[bent] / static_cast<double>(std::max<std::size_t>(1, s.roll_count[bent]));
    };
    const auto wander = [&](std::size_t bent) {
        return std::sqrt(s.wander[bent] /
                         static_cast<double>(std::max<std::size_t>(1, s.roll_count[bent])));
    };
    const auto marks = [&](std::size_t a, std::size_t k) {
        return static_cast<double>(s.marks[a][k] + s.marks[a + 1][k]) /
               static_cast<double>(std::max<std::size_t>(1, s.frames));
    };
    std::printf("    roll wanders: bent %.1f, straight %.1f degrees; marks a frame sought / found: "
                "upper arms %.1f / %.1f, thighs %.1f / %.1f\n",
                wander(1), wander(0), marks(0, 0), marks(0, 1), marks(2, 0), marks(2, 1));
    for (std::size_t b = 0; b < 2; ++b)
        std::printf("    roll %s: upper arms %.1f (%zu), thighs %.1f (%zu) degrees\n",
                    b == 0 ? "straight" : "bent", s.limb_roll(0, b), s.limb_count(0, b),
                    s.limb_roll(2, b), s.limb_count(2, b));
    if (s.labelled > 0)
        std::printf("    labels: %.1f %% of the person's pixels right, %.1f %% without one, "
                    "%.2f %% of the labels beside the person\n",
                    percent(s.labels_right, s.labelled), percent(s.unlabelled, s.labelled),
                    percent(s.labels_beside, s.labelled));
    std::printf(
        "    roll: bent %.1f, straight %.1f degrees; failed frames flagged %zu of %zu, false "
        "alarms %.1f %%\n",
        roll(1), roll(0), s.flagged, s.failed_frames, percent(s.alarms, s.good_frames));
    std::fflush(stdout);
}

bool swapped(const sensor::Simulator& simulator, const body_tracker::PersonTrack& person) {
    if (!person.active()) return false;
    const auto& truth = *simulator.figures()[0]->joints();
    const Eigen::Isometry3f place = simulator.camera(0).reported_pose().cast<float>();
    float as_is = 0.0f, exchanged = 0.0f;
    for (const Joint joint : kRolled) {
        const Vec3f at = place * person.joints()[static_cast<std::size_t>(joint)].translation;
        as_is += (at - truth[static_cast<std::size_t>(joint)].translation).norm();
        exchanged +=
            (at - truth[static_cast<std::size_t>(body::opposite_joint(joint))].translation).norm();
    }
    return exchanged < as_is;
}

namespace {

void add_roll(const sensor::Simulator& simulator, const body::JointTransforms& truth,
              const body_tracker::PersonTrack& person, const std::array<float, kJointCount>& shares,
              TrackSums& sums) {
    const Quatf place(simulator.camera(0).reported_pose().linear().cast<float>());
    for (std::size_t limb = 0; limb < kRolled.size(); ++limb) {
        const Joint joint = kRolled[limb];
        const auto& counts = person.marks().counts();
        sums.marks[limb][0] += counts.sought[static_cast<std::size_t>(joint)];
        sums.marks[limb][1] += counts.found[static_cast<std::size_t>(joint)];
        if (shares[static_cast<std::size_t>(joint)] < kVisibleShare) continue;
        const Joint child = child_of(joint);
        const std::size_t bent = bend_of(truth, joint) > kBent ? 1 : 0;
        const double off = static_cast<double>(
            roll_between(person.joints(), truth, joint, child, place) * 180.0f / body::kPi);
        sums.roll[bent] += std::abs(off);
        ++sums.roll_count[bent];
        sums.limb_off[limb][bent] += std::abs(off);
        ++sums.limb_seen[limb][bent];
        auto& [count, sum, squares] = sums.limb[limb][bent];
        count += 1.0, sum += off, squares += off * off;
    }
}

} // namespace

FrameErrors compare(const sensor::Simulator& simulator, std::size_t figure,
                    const body_tracker::PersonTrack& person, const Visibility& visibility,
                    TrackSums& sums) {
    using body_tracker::Following;
    FrameErrors out;
    const auto& shown = *simulator.figures()[figure];
    const auto body = std::find_if(
        shown.surfaces().begin(), shown.surfaces().end(),
        [](const sensor::FigureSurface& s) { return s.role == body::SurfaceRole::body; });
    if (body == shown.surfaces().end()) throw Error("a person without a body");
    const auto shares = visibility.shares(body->positions, simulator.camera(0));
    const auto& truth = *shown.joints();
    std::size_t visible = 0;
    for (const float s : shares)
        visible += s >= kVisibleShare ? 1 : 0;
    if (visible == 0) return out;
    out.in_view = true;
    ++sums.frames;
    const bool called = person.active() && person.following() != Following::lost;
    out.called_tracked = called && person.following() != Following::uncertain;
    sums.called += out.called_tracked ? 1 : 0;
    const Eigen::Isometry3f place = simulator.camera(0).reported_pose().cast<float>();
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const double off =
            called ? 1000.0 *
                         static_cast<double>(
                             (place * person.joints()[j].translation - truth[j].translation).norm())
                   : 500.0;
        sums.all += off;
        ++sums.all_count;
        sums.joint[j] += off;
        ++sums.joint_count[j];
        if (called) {
            sums.lean[j] +=
                1e3 * (person.joints()[j].translation - place.inverse() * truth[j].translation)
                          .cast<double>();
            const auto tenth =
                std::min<std::size_t>(9, static_cast<std::size_t>(10.0f * person.confidence()[j]));
            ++sums.stated[tenth];
            sums.kept[tenth] += off < 100.0 ? 1 : 0;
        }
        if (shares[j] < kVisibleShare) continue;
        sums.visible += off;
        out.off_mm[j] = static_cast<float>(off);
        out.visible_mm += off / static_cast<double>(visible);
        ++sums.visible_count;
        sums.near += off < 100.0 ? 1 : 0;
        sums.off[j] += off < 100.0 ? 0 : 1;
        out.good = out.good && off < 100.0;
        out.failed = out.failed || off > 150.0;
    }
    sums.good_frames += out.good ? 1 : 0;
    sums.failed_frames += out.failed ? 1 : 0;
    sums.flagged += out.failed && !out.called_tracked ? 1 : 0;
    sums.alarms += out.good && !out.called_tracked ? 1 : 0;
    if (called) add_roll(simulator, truth, person, shares, sums);
    return out;
}

void rate_labels(const sensor::Simulator& simulator, const body_tracker::BodyTracking& tracking,
                 const body::TestPerson& person, body_tracker::PartPainter& painter,
                 TrackSums& sums) {
    const sensor::DepthCamera& camera = simulator.camera(0);
    const std::vector<float>& metres = camera.depth().metres;
    std::vector<std::uint8_t> parts(metres.size());
    painter.paint(tracking, metres, parts, {});
    const sensor::HitMap& hits = camera.hits();
    for (std::size_t i = 0; i < metres.size(); ++i) {
        if (!(metres[i] > 0.0f)) continue;
        const bool on_person =
            hits.depth[i] < 100.0f && simulator.stage().surface(hits.surface[i]).name == person.id;
        if (!on_person || std::abs(hits.depth[i] - metres[i]) > kSeenTolerance) {
            // A reading off what the ray hit is of an outline: whose is not known.
            if (!on_person && parts[i] != 0 && std::abs(hits.depth[i] - metres[i]) < kSeenTolerance)
                ++sums.labels_beside;
            continue;
        }
        const Triangle& t = person.rest.triangles[hits.triangle[i]];
        const auto& [v, w] = hits.place[i];
        const std::size_t corner = v > w ? (v > 1.0f - v - w ? 1 : 0) : (w > 1.0f - v - w ? 2 : 0);
        ++sums.labelled;
        sums.unlabelled += parts[i] == 0 ? 1 : 0;
        sums.labels_right += parts[i] == static_cast<std::uint8_t>(person.parts[t[corner]]) ? 1 : 0;
    }
}

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
    const auto frames = static_cast<int>(seconds * kTrackRate);
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
        out << body::track_line(static_cast<std::uint64_t>(f), f / kTrackRate, std::span(&one, 1));
    }
    return file;
}

/// Arms hanging, for longer than anybody looks.
fs::path stand_still(const body::TestPerson& person) {
    const fs::path file = fs::temp_directory_path() /
                          ("toile_stand_" + std::to_string(getpid()) + "_" + person.id + ".jsonl");
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

} // namespace toile::evaluation
