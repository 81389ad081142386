#include "host/contract_figure.h"

#include "host/views.h"

#include <cmath>
#include <numbers>

namespace toile::host {
namespace {

constexpr int kAround = 10;
constexpr int kRings = 7; // along one capsule, without its two tips

// Rest positions of the joints on the left and in the middle; the right is the mirror image.
constexpr std::array<Float3, TOILE_JOINT_COUNT> kRest{{
    {0, 0.92f, 0},      {0, 1.02f, 0},         {0, 1.14f, 0},      {0, 1.26f, 0},
    {0, 1.42f, 0},      {0, 1.50f, 0},         {0.06f, 1.36f, 0},  {0.17f, 1.36f, 0},
    {0.36f, 1.17f, 0},  {0.53f, 1.00f, 0},     {-0.06f, 1.36f, 0}, {-0.17f, 1.36f, 0},
    {-0.36f, 1.17f, 0}, {-0.53f, 1.00f, 0},    {0.10f, 0.88f, 0},  {0.11f, 0.48f, 0},
    {0.12f, 0.07f, 0},  {0.12f, 0.03f, 0.1f},  {-0.10f, 0.88f, 0}, {-0.11f, 0.48f, 0},
    {-0.12f, 0.07f, 0}, {-0.12f, 0.03f, 0.1f},
}};

struct Bone {
    std::uint32_t joint;
    Float3 to; ///< from the joint to here
    float radius;
    std::uint8_t part;
};

constexpr std::array kBones{
    Bone{TOILE_JOINT_HIPS, {0, 1.04f, 0}, 0.13f, TOILE_PART_PELVIS},
    Bone{TOILE_JOINT_CHEST, {0, 1.30f, 0}, 0.13f, TOILE_PART_TORSO},
    Bone{TOILE_JOINT_NECK, {0, 1.50f, 0}, 0.05f, TOILE_PART_NECK},
    Bone{TOILE_JOINT_HEAD, {0, 1.60f, 0}, 0.09f, TOILE_PART_HEAD},
    Bone{TOILE_JOINT_LEFT_UPPER_ARM, kRest[TOILE_JOINT_LEFT_LOWER_ARM], 0.045f,
         TOILE_PART_LEFT_UPPER_ARM},
    Bone{TOILE_JOINT_LEFT_LOWER_ARM, kRest[TOILE_JOINT_LEFT_HAND], 0.035f,
         TOILE_PART_LEFT_LOWER_ARM},
    Bone{TOILE_JOINT_RIGHT_UPPER_ARM, kRest[TOILE_JOINT_RIGHT_LOWER_ARM], 0.045f,
         TOILE_PART_RIGHT_UPPER_ARM},
    Bone{TOILE_JOINT_RIGHT_LOWER_ARM, kRest[TOILE_JOINT_RIGHT_HAND], 0.035f,
         TOILE_PART_RIGHT_LOWER_ARM},
    Bone{TOILE_JOINT_LEFT_UPPER_LEG, kRest[TOILE_JOINT_LEFT_LOWER_LEG], 0.075f,
         TOILE_PART_LEFT_UPPER_LEG},
    Bone{TOILE_JOINT_LEFT_LOWER_LEG, kRest[TOILE_JOINT_LEFT_FOOT], 0.055f,
         TOILE_PART_LEFT_LOWER_LEG},
    Bone{TOILE_JOINT_RIGHT_UPPER_LEG, kRest[TOILE_JOINT_RIGHT_LOWER_LEG], 0.075f,
         TOILE_PART_RIGHT_UPPER_LEG},
    Bone{TOILE_JOINT_RIGHT_LOWER_LEG, kRest[TOILE_JOINT_RIGHT_FOOT], 0.055f,
         TOILE_PART_RIGHT_LOWER_LEG},
};

Vec3f vec(const Float3& a) {
    return {a[0], a[1], a[2]};
}

Float3 row(const Vec3f& a) {
    return {a.x(), a.y(), a.z()};
}

Float4 quaternion_about_y(double angle) {
    return {0, static_cast<float>(std::sin(angle / 2)), 0, static_cast<float>(std::cos(angle / 2))};
}

} // namespace

CapsuleFigure::CapsuleFigure() : rest_joints_(kRest) {
    for (const Bone& bone : kBones)
        add_capsule(bone.joint, kRest[bone.joint], bone.to, bone.radius, bone.part);
    body_.size = sizeof(toile_body);
    body_.revision = 1;
    body_.model_id = "contract-figure";
    body_.rest.size = sizeof(toile_mesh);
    body_.rest.positions = view_of(positions_);
    body_.rest.normals = view_of(normals_);
    body_.rest.triangles = view_of(triangles_);
    body_.rest.topology_id = 1;
    body_.rest_joints = view_of(rest_joints_);
    body_.joint_indices = view_of(joint_indices_);
    body_.joint_weights = view_of(joint_weights_);
    body_.part_labels = view_of(parts_);
}

void CapsuleFigure::add_capsule(std::uint32_t joint, const Float3& from, const Float3& to,
                                float radius, std::uint8_t part) {
    const Vec3f a = vec(from);
    const Vec3f axis = (vec(to) - a).normalized();
    const float length = (vec(to) - a).norm();
    const Vec3f u = axis.unitOrthogonal();
    const Vec3f v = axis.cross(u);
    const auto first = static_cast<std::uint32_t>(positions_.size());
    const auto add = [&](const Vec3f& center, const Vec3f& normal) {
        positions_.push_back(row(center + radius * normal));
        normals_.push_back(row(normal));
        joint_indices_.push_back({static_cast<std::uint16_t>(joint), 0, 0, 0});
        joint_weights_.push_back({1, 0, 0, 0});
        parts_.push_back(part);
    };
    add(a, -axis);
    // Rings over both half spheres and the cylinder between them.
    for (int ring = 0; ring < kRings; ++ring) {
        constexpr std::array<float, kRings> latitude{-1.05f, -0.52f, 0, 0, 0, 0.52f, 1.05f};
        constexpr std::array<float, kRings> along{0, 0, 0, 0.5f, 1, 1, 1};
        const auto at = static_cast<std::size_t>(ring);
        for (int i = 0; i < kAround; ++i) {
            const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
            const Vec3f side = std::cos(angle) * u + std::sin(angle) * v;
            add(a + along[at] * length * axis,
                std::cos(latitude[at]) * side + std::sin(latitude[at]) * axis);
        }
    }
    add(a + length * axis, axis);
    const std::uint32_t last = static_cast<std::uint32_t>(positions_.size()) - 1;
    const auto vertex = [&](int ring, int i) {
        return first + 1 + static_cast<std::uint32_t>(ring * kAround + i % kAround);
    };
    for (int i = 0; i < kAround; ++i) {
        triangles_.push_back({first, vertex(0, i + 1), vertex(0, i)});
        triangles_.push_back({last, vertex(kRings - 1, i), vertex(kRings - 1, i + 1)});
        for (int ring = 0; ring + 1 < kRings; ++ring) {
            triangles_.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
            triangles_.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
        }
    }
}

Joints CapsuleFigure::joints(double yaw_rad, const Float3& move) const {
    const Float4 rotation = quaternion_about_y(yaw_rad);
    const Quatf q(rotation[3], rotation[0], rotation[1], rotation[2]);
    Joints out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Vec3f at = q * vec(rest_joints_[i]) + vec(move);
        toile_joint& joint = out[i];
        for (int axis = 0; axis < 3; ++axis)
            joint.position[axis] = at[axis];
        for (std::size_t k = 0; k < 4; ++k)
            joint.rotation[k] = rotation[k];
        joint.confidence = 1;
    }
    return out;
}

void CapsuleFigure::pose(const Joints& joints, std::vector<Float3>& positions,
                         std::vector<Float3>& normals) const {
    positions.resize(positions_.size());
    normals.resize(normals_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        const std::size_t j = joint_indices_[i][0];
        const float* r = joints[j].rotation;
        const float* p = joints[j].position;
        const Quatf q(r[3], r[0], r[1], r[2]);
        positions[i] =
            row(q * (vec(positions_[i]) - vec(rest_joints_[j])) + Vec3f(p[0], p[1], p[2]));
        normals[i] = row(q * vec(normals_[i]));
    }
}

toile_body_state CapsuleFigure::state(const Joints& joints, std::uint32_t sequence,
                                      const std::vector<Float3>* positions,
                                      const std::vector<Float3>* normals) const {
    auto out = sized<toile_body_state>();
    out.person_id = 1;
    out.tracking = TOILE_TRACKING_TRACKED;
    out.sequence = sequence;
    out.timestamp_ns = std::int64_t{sequence} * 33'333'333;
    out.body_revision = body_.revision;
    out.joints = view_of(joints);
    if (positions != nullptr) out.positions = view_of(*positions);
    if (normals != nullptr) out.normals = view_of(*normals);
    return out;
}

ClothTube::ClothTube(const CapsuleFigure& figure) {
    constexpr int around = 24;
    constexpr int along = 14;
    constexpr float radius = 0.165f;
    constexpr float top = 1.28f;
    constexpr float height = 0.42f;
    const float edge = 2.0f * radius * std::sin(std::numbers::pi_v<float> / around);
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < around; ++i) {
            const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / around;
            positions_.push_back({radius * std::cos(angle),
                                  top - height * static_cast<float>(j) / along,
                                  radius * std::sin(angle)});
            const bool chest = positions_.back()[1] > 1.09f;
            joint_indices_.push_back(
                {static_cast<std::uint16_t>(chest ? TOILE_JOINT_CHEST : TOILE_JOINT_HIPS), 0, 0,
                 0});
            joint_weights_.push_back({1, 0, 0, 0});
            pins_.push_back(j == 0 ? 1.0f : 0.0f);
        }
    const auto vertex = [](int j, int i) {
        return static_cast<std::uint32_t>(j * around + i % around);
    };
    const auto add = [&](std::array<std::array<int, 2>, 3> corners) {
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [j, i] = corners[k];
            t[k] = vertex(j, i);
            corner_coords_.push_back(
                {static_cast<float>(i) * edge, -height * static_cast<float>(j) / along});
        }
        triangles_.push_back(t);
    };
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i) {
            add({{{j, i}, {j, i + 1}, {j + 1, i + 1}}});
            add({{{j, i}, {j + 1, i + 1}, {j + 1, i}}});
        }

    toile_fabric fabric = sized<toile_fabric>();
    fabric.density_kg_m2 = 0.16f;
    fabric.thickness_m = 0.0006f;
    fabric.stretch_warp_n_m = fabric.stretch_weft_n_m = 600.0f;
    fabric.shear_n_m = 60.0f;
    fabric.bend_warp_nm = fabric.bend_weft_nm = 1e-5f;
    fabric.friction = 0.4f;
    fabric.damping = 2.0f;

    package_ = sized<toile_garment_package>();
    package_.id = "contract-tube";
    package_.version = "1.0.0";
    package_.size_name = "M";
    package_.simulation = sized<toile_mesh>();
    package_.simulation.positions = view_of(positions_);
    package_.simulation.triangles = view_of(triangles_);
    package_.simulation.corner_coords = view_of(corner_coords_);
    package_.simulation.topology_id = 2;
    package_.pins = view_of(pins_);
    package_.made_on = &figure.abi();
    package_.fabric = fabric;
    package_.ease_m = 0.01f;

    garment_ = sized<toile_cloth_garment>();
    garment_.rest = package_.simulation;
    garment_.joint_indices = view_of(joint_indices_);
    garment_.joint_weights = view_of(joint_weights_);
    garment_.attachment = view_of(pins_);
    garment_.fabric = fabric;
}

} // namespace toile::host
