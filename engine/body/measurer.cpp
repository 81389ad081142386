#include "body/measurer.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::body {
namespace {

bool is_arm(Part part) {
    return part >= Part::left_upper_arm && part <= Part::right_lower_arm;
}

/// Where the arm leaves the trunk: labels of the arm begin on the trunk's side of the armpit, so
/// that a plane through shoulder point and armpit parts them.
class ScyePlanes {
  public:
    ScyePlanes(const BodyModel& model, const std::array<std::uint32_t, kLandmarkCount>& landmarks)
        : positions_(model.rest.positions) {
        for (const bool left : {true, false}) {
            const auto at = [&](Landmark l) {
                return positions_[landmarks[static_cast<std::size_t>(left ? l : opposite(l))]];
            };
            const Vec3f armpit = at(Landmark::left_armpit);
            const Vec3f up = at(Landmark::left_shoulder) - armpit;
            const Vec3f out =
                left ? Vec3f(up.cross(Vec3f::UnitZ())) : Vec3f(Vec3f::UnitZ().cross(up));
            planes_[left ? 0 : 1] = geometry::Plane::through(armpit, out);
        }
    }
    /// Whether a triangle of the arm's labels lies on the trunk's side.
    [[nodiscard]] bool inside(const Triangle& t) const {
        const Vec3f middle = (positions_[t[0]] + positions_[t[1]] + positions_[t[2]]) / 3.0f;
        const geometry::Plane& plane = planes_[middle.x() > 0.0f ? 0 : 1];
        return plane.normal.dot(middle) < plane.offset;
    }

  private:
    std::span<const Vec3f> positions_;
    std::array<geometry::Plane, 2> planes_;
};

bool is_leg(Part part, bool left) {
    return left ? part == Part::left_upper_leg || part == Part::left_lower_leg
                : part == Part::right_upper_leg || part == Part::right_lower_leg;
}

bool is_below_thigh(Part part) {
    return part == Part::left_lower_leg || part == Part::right_lower_leg;
}

Regions make_regions(const BodyModel& model,
                     const std::array<std::uint32_t, kLandmarkCount>& landmarks) {
    const ScyePlanes scyes(model, landmarks);
    std::array<std::vector<Triangle>, kRegionCount> triangles;
    const auto put = [&](Region region, const Triangle& t) {
        triangles[static_cast<std::size_t>(region)].push_back(t);
    };
    for (const Triangle& t : model.rest.triangles) {
        const auto count = [&](auto&& test) {
            return std::count_if(t.begin(), t.end(),
                                 [&](std::uint32_t v) { return test(model.parts[v]); });
        };
        const bool left = model.rest.positions[t[0]].x() > 0.0f;
        if (count(is_arm) > 0 && !scyes.inside(t)) {
            put(left ? Region::left_arm : Region::right_arm, t);
            continue;
        }
        // The seat belongs to the leg too: a tape at the gluteal fold may touch it.
        if (count([left](Part p) { return is_leg(p, left) || p == Part::pelvis; }) == 3)
            put(left ? Region::left_leg : Region::right_leg, t);
        const auto head = count([](Part p) { return p == Part::head; });
        if (head + count([](Part p) { return p == Part::neck; }) == 3) put(Region::head, t);
        if (head + count(is_below_thigh) == 0) put(Region::trunk, t);
    }
    Regions out;
    for (std::size_t r = 0; r < kRegionCount; ++r)
        out[r] = geometry::SurfacePart(std::move(triangles[r]));
    return out;
}

/// Falls from 1 as joints turn away from the rest pose: skin slides and bulges then.
double trust_in(const JointTransforms& world, std::initializer_list<Joint> joints) {
    constexpr double kHalfTurned = 0.9; // radians
    double worst = 0.0;
    for (const Joint joint : joints) {
        const Quatf& own = world[static_cast<std::size_t>(joint)].rotation;
        const auto parent = joint_parent(joint);
        const Quatf before =
            parent ? world[static_cast<std::size_t>(*parent)].rotation : Quatf::Identity();
        worst = std::max(worst, static_cast<double>(before.angularDistance(own)));
    }
    return std::exp(-(worst / kHalfTurned) * (worst / kHalfTurned));
}

Limb limb(const JointTransforms& world, Joint root, Joint middle, Joint end, Joint tip) {
    const auto at = [&](Joint j) { return world[static_cast<std::size_t>(j)].translation; };
    return {at(root), at(middle), at(end), at(tip)};
}

} // namespace

Measurer::Measurer(const BodyModel& model) : triangles_(model.rest.triangles), skin_(model.skin) {
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
        const std::string name(landmark_name(static_cast<Landmark>(i)));
        const auto found = model.landmarks.find(name);
        if (found == model.landmarks.end())
            throw Error("body model '" + model.id + "' lacks the landmark '" + name +
                        "'; make it again with toile avatar train");
        landmarks_[i] = found->second;
    }
    regions_ = make_regions(model, landmarks_);
}

Figure Measurer::figure(std::span<const Vec3f> positions, const JointTransforms& world) const {
    using enum Joint;
    Figure out;
    out.positions = positions;
    out.triangles = triangles_;
    out.regions = &regions_;
    for (std::size_t i = 0; i < kLandmarkCount; ++i)
        out.landmarks[i] = positions[landmarks_[i]];
    out.landmark_trust.fill(1.0);
    const double trunk = trust_in(world, {spine, chest, upper_chest});
    const double legs = trust_in(world, {left_upper_leg, right_upper_leg});
    out.region_trust = {trunk,
                        trust_in(world, {neck, head}),
                        trust_in(world, {left_upper_arm, left_lower_arm, left_hand}),
                        trust_in(world, {right_upper_arm, right_lower_arm, right_hand}),
                        trust_in(world, {left_upper_leg, left_lower_leg, left_foot}),
                        trust_in(world, {right_upper_leg, right_lower_leg, right_foot})};
    out.standing = std::min({trunk, legs, trust_in(world, {left_lower_leg, right_lower_leg})});

    const auto axes = [&](Joint joint) -> Axes {
        const Quatf& turn = world[static_cast<std::size_t>(joint)].rotation;
        return {turn * Vec3f::UnitY(), turn * Vec3f::UnitZ(), turn * Vec3f::UnitX()};
    };
    const auto at = [&](Joint j) { return world[static_cast<std::size_t>(j)].translation; };
    out.hips = axes(hips);
    out.waist = axes(spine);
    out.chest = axes(chest);
    out.neck_up = (at(head) - at(neck)).normalized();
    out.right_arm = limb(world, right_upper_arm, right_lower_arm, right_hand, right_hand);
    out.right_leg = limb(world, right_upper_leg, right_lower_leg, right_foot, right_toes);
    return out;
}

Figure Measurer::figure(std::span<const Vec3f> positions, const Skeleton& skeleton) const {
    return figure(positions, forward_kinematics(skeleton, rest_pose(skeleton)));
}

std::vector<Vec3f> Measurer::unposed(std::span<const Vec3f> positions, const Skeleton& skeleton,
                                     const JointTransforms& world) const {
    const JointTransforms skinning = skinning_transforms(skeleton, world);
    std::array<Mat3f, kJointCount> turns;
    for (std::size_t j = 0; j < kJointCount; ++j)
        turns[j] = skinning[j].rotation.toRotationMatrix();
    std::vector<Vec3f> out;
    out.reserve(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        Mat3f turn = Mat3f::Zero();
        Vec3f shift = Vec3f::Zero();
        for (std::size_t k = 0; k < skin_.joints[v].size(); ++k) {
            const float w = skin_.weights[v][k];
            turn += w * turns[skin_.joints[v][k]];
            shift += w * skinning[skin_.joints[v][k]].translation;
        }
        out.emplace_back(turn.inverse() * (positions[v] - shift));
    }
    return out;
}

Measurements Measurer::measure(std::span<const Vec3f> positions, const Skeleton& skeleton) const {
    std::vector<const MeasurementDefinition*> all;
    for (const MeasurementDefinition& d : measurement_definitions())
        all.push_back(&d);
    return measure(positions, skeleton, all);
}

Measurements Measurer::measure(std::span<const Vec3f> positions, const Skeleton& skeleton,
                               std::span<const MeasurementDefinition* const> definitions) const {
    return body::measure(figure(positions, skeleton), definitions);
}

std::map<std::string, double> as_map(const Measurements& measurements, double least_confidence) {
    std::map<std::string, double> out;
    for (const Measurement& m : measurements)
        if (m.confidence >= least_confidence && m.value_m > 0.0)
            out[std::string(m.name)] = m.value_m;
    return out;
}

} // namespace toile::body
