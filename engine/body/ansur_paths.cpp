#include "body/ansur_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace toile::body {
namespace {

// The template's arm hangs loose, ANSUR's biceps are flexed: tensed arms of ordinary people are
// about 6 % larger (ISAK's phantom, of athletes: 29.41 to 26.89 cm, 9 %).
constexpr double kFlexed = 1.0 / 1.06;
constexpr float kGlutealFold = 0.02f; // below the crotch, metres
constexpr float kNever = 1e6f;
// Of the template's stature: C7 and the navel (medians of standing adults).
constexpr float kCervicalHeight = 0.858f, kNavelHeight = 0.600f;
constexpr float kSoleHeight = 0.03f; // vertices this low may touch the floor

std::uint32_t nearest_vertex(const AvatarTemplate& avatar, const Vec3f& p) {
    std::uint32_t best = 0;
    for (std::uint32_t v = 1; v < avatar.half; ++v)
        if ((avatar.mesh.positions[v] - p).squaredNorm() <
            (avatar.mesh.positions[best] - p).squaredNorm())
            best = v;
    return best;
}

/// The vertex of `candidates` that is farthest along `axis`.
std::uint32_t extreme(std::span<const Vec3f> positions, std::span<const std::uint32_t> candidates,
                      const Vec3f& axis) {
    return *std::max_element(candidates.begin(), candidates.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return positions[a].dot(axis) < positions[b].dot(axis);
                             });
}

/// Girth across a bone at the share of its length, of those tried, where it is largest or least.
Measured limb_girth(const BodyShape& body, std::span<const Triangle> triangles, Joint from,
                    Joint to, std::initializer_list<float> shares, bool largest) {
    const Vec3f start = body.skeleton.rest(from), bone = body.skeleton.rest(to) - start;
    Measured best;
    for (const float share : shares) {
        Measured tried =
            tape_girth(body.positions, triangles, start + share * bone, bone.normalized());
        if (best.slope.empty() || (tried.value > best.value) == largest) best = std::move(tried);
    }
    return best;
}

Measured plus(Measured a, const Measured& b) {
    a.value += b.value;
    a.slope.insert(a.slope.end(), b.slope.begin(), b.slope.end());
    return a;
}

Measured times(double factor, Measured a) {
    a.value *= factor;
    for (auto& [vertex, slope] : a.slope)
        slope *= static_cast<float>(factor);
    return a;
}

} // namespace

const std::vector<AnsurMeasure>& ansur_measures() {
    static const std::vector<AnsurMeasure> kMeasures = {
        {"ansur_stature", "stature", 1.0, true},
        {"ansur_weight", "weightkg", 1.0, true},
        {"ansur_chest_girth", "chestcircumference", 1.0, true},
        {"ansur_waist_girth", "waistcircumference", 1.0, true},
        {"ansur_buttock_girth", "buttockcircumference", 1.0, true},
        {"ansur_thigh_girth", "thighcircumference", 1.0, true},
        {"ansur_neck_girth", "neckcircumference", 1.0, true},
        {"ansur_biceps_girth", "bicepscircumferenceflexed", kFlexed, true},
        {"ansur_wrist_girth", "wristcircumference", 1.0, true},
        {"ansur_arm_length", "acromionradialelength+radialestylionlength", 1.0, true},
        {"ansur_crotch_height", "crotchheight", 1.0, true},
        {"ansur_biacromial_breadth", "biacromialbreadth", 1.0, true},
        {"ansur_calf_girth", "calfcircumference", 1.0, false},
        {"ansur_ankle_girth", "anklecircumference", 1.0, false},
        {"ansur_cervicale_height", "cervicaleheight", 1.0, false},
        {"ansur_acromial_height", "acromialheight", 1.0, false},
        {"ansur_omphalion_height", "waistheightomphalion", 1.0, false},
        {"ansur_patella_height", "kneeheightmidpatella", 1.0, false},
    };
    return kMeasures;
}

AnsurPaths::AnsurPaths(const AvatarTemplate& avatar, std::span<const Part> labels)
    : avatar_(avatar) {
    constexpr std::array<Part, 2> kTrunk = {Part::torso, Part::pelvis};
    constexpr std::array<Part, 4> kSeat = {Part::torso, Part::pelvis, Part::left_upper_leg,
                                           Part::right_upper_leg};
    constexpr std::array<Part, 3> kNeck = {Part::neck, Part::head, Part::torso};
    constexpr std::array<Part, 2> kArm = {Part::left_upper_arm, Part::left_lower_arm};
    constexpr std::array<Part, 3> kLeg = {Part::left_upper_leg, Part::left_lower_leg, Part::pelvis};
    trunk_ = triangles_of(kTrunk, labels, false);
    seat_ = triangles_of(kSeat, labels, false);
    neck_ = triangles_of(kNeck, labels, false);
    arm_ = triangles_of(kArm, labels, true);
    leg_ = triangles_of(kLeg, labels, true);

    const auto& positions = avatar.mesh.positions;
    find_marks(labels);
    const Vec3f elbow = avatar.skeleton.rest(Joint::left_lower_arm);
    const Vec3f wrist = avatar.skeleton.rest(Joint::left_hand);
    const Vec3f upper = (elbow - avatar.skeleton.rest(Joint::left_upper_arm)).normalized();
    const Vec3f outwards = Vec3f::UnitZ().cross(upper).normalized();
    radiale_ = nearest_vertex(avatar, elbow + 0.04f * outwards);
    stylion_ = nearest_vertex(avatar, wrist + 0.025f * Vec3f::UnitZ());
    const float hips = avatar.skeleton.rest(Joint::left_upper_leg).y();
    for (std::uint32_t v = 0; v < avatar.half; ++v) {
        const Vec3f& p = positions[v];
        if (p.y() < kSoleHeight) soles_.push_back(v);
        if (p.z() < avatar.skeleton.rest(Joint::hips).z() && std::abs(p.y() - hips) < 0.12f &&
            p.x() > 0.03f && p.x() < 0.12f)
            seat_back_.push_back(v);
    }
}

void AnsurPaths::find_marks(std::span<const Part> labels) {
    const auto& at = avatar_.mesh.positions;
    const Skeleton& joints = avatar_.skeleton;
    /// The vertex of the left half (or of its midline) with the least cost.
    const auto best = [&](bool midline, const std::function<float(std::uint32_t)>& cost) {
        std::uint32_t found = 0;
        float least = std::numeric_limits<float>::max();
        for (std::uint32_t v = 0; v < avatar_.half; ++v) {
            if (midline && avatar_.mirror_of[v] != v) continue;
            const float c = cost(v);
            if (c < least) {
                least = c;
                found = v;
            }
        }
        return found;
    };
    crown_ = best(true, [&](std::uint32_t v) { return -at[v].y(); });
    const float stature = at[crown_].y(), spine_z = joints.rest(Joint::neck).z();
    const auto midline_at = [&](float share, bool front) {
        return best(true, [&, share, front](std::uint32_t v) {
            return (at[v].z() > spine_z) == front ? std::abs(at[v].y() - share * stature) : kNever;
        });
    };
    cervicale_ = midline_at(kCervicalHeight, false);
    navel_ = midline_at(kNavelHeight, true);
    crotch_ = best(
        true, [&](std::uint32_t v) { return at[v].y() > 0.3f * stature ? at[v].y() : kNever; });
    const Vec3f arm = joints.rest(Joint::left_upper_arm) + Vec3f(0.01f, 0.0f, 0.0f);
    acromion_ = best(false, [&](std::uint32_t v) {
        const Vec3f d = at[v] - arm;
        return std::hypot(d.x(), d.z()) < 0.02f && d.y() > 0.0f ? -d.y() : kNever;
    });
    nipple_ = best(false, [&](std::uint32_t v) {
        const float h = at[v].y() / stature;
        const bool chest = labels[v] == Part::torso && at[v].x() > 0.05f && at[v].x() < 0.14f;
        return chest && h > 0.69f && h < 0.76f ? -at[v].z() : kNever;
    });
    const Vec3f knee = joints.rest(Joint::left_lower_leg) + Vec3f(0.0f, 0.0f, 0.08f);
    patella_ = best(false, [&](std::uint32_t v) { return (at[v] - knee).squaredNorm(); });
}

std::vector<Triangle> AnsurPaths::triangles_of(std::span<const Part> parts,
                                               std::span<const Part> labels, bool left_only) const {
    std::vector<Triangle> out;
    for (const auto& t : avatar_.mesh.triangles)
        if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
                return (!left_only || v < avatar_.half) &&
                       std::find(parts.begin(), parts.end(), labels[v]) != parts.end();
            }))
            out.push_back(t);
    return out;
}

std::vector<Measured> AnsurPaths::measure(const BodyShape& body) const {
    const auto& p = body.positions;
    const Vec3f up = Vec3f::UnitY();
    const std::uint32_t floor = extreme(p, soles_, -up);
    const std::uint32_t seat = extreme(p, seat_back_, -Vec3f::UnitZ());
    const auto level = [&](std::span<const Triangle> triangles, std::uint32_t vertex) {
        return tape_girth(p, triangles, p[vertex], up, &vertex);
    };
    const auto height = [&](std::uint32_t vertex) { return tape_rise(p, floor, vertex, up); };

    std::vector<Measured> out;
    out.push_back(height(crown_));
    out.push_back(times(kBodyDensity, tape_volume(p, avatar_.mesh.triangles)));
    out.push_back(level(trunk_, nipple_));
    out.push_back(level(trunk_, navel_));
    out.push_back(level(seat_, seat));
    out.push_back(tape_girth(p, leg_, p[crotch_] - kGlutealFold * up, up, &crotch_));
    out.push_back(
        limb_girth(body, neck_, Joint::neck, Joint::head, {0.4f, 0.5f, 0.6f, 0.7f, 0.8f}, false));
    out.push_back(limb_girth(body, arm_, Joint::left_upper_arm, Joint::left_lower_arm,
                             {0.45f, 0.5f, 0.55f, 0.6f, 0.65f}, true));
    out.push_back(limb_girth(body, arm_, Joint::left_lower_arm, Joint::left_hand,
                             {0.85f, 0.9f, 0.95f, 0.98f}, false));
    out.push_back(
        plus(tape_distance(p, acromion_, radiale_), tape_distance(p, radiale_, stylion_)));
    out.push_back(height(crotch_));
    out.push_back(times(2.0, tape_rise(p, crown_, acromion_, Vec3f::UnitX())));
    out.push_back(limb_girth(body, leg_, Joint::left_lower_leg, Joint::left_foot,
                             {0.2f, 0.25f, 0.3f, 0.35f, 0.4f}, true));
    out.push_back(limb_girth(body, leg_, Joint::left_lower_leg, Joint::left_foot,
                             {0.75f, 0.8f, 0.85f, 0.9f}, false));
    out.push_back(height(cervicale_));
    out.push_back(height(acromion_));
    out.push_back(height(navel_));
    out.push_back(height(patella_));
    return out;
}

} // namespace toile::body
