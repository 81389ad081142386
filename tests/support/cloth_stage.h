// Small bodies and cloths for tests: everything about them is known in closed form.
#pragma once

#include "cloth/garment_input.h"
#include "cloth/step.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

namespace toile::test::cloth_stage {

using cloth::BodyRest;
using cloth::Fabric;
using cloth::GarmentFrame;
using cloth::GarmentInput;
using cloth::StepResult;

using Joints = std::array<std::uint16_t, 4>;
using Weights = std::array<float, 4>;

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    std::vector<Vec2f> corner_coords;
    std::vector<Joints> joints;
    std::vector<Weights> weights;

    void bind_to(std::uint16_t joint) {
        joints.assign(positions.size(), {joint, 0, 0, 0});
        weights.assign(positions.size(), {1.0f, 0.0f, 0.0f, 0.0f});
    }
    /// Adds a mesh to this one.
    void join(const Mesh& other) {
        const auto base = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), other.positions.begin(), other.positions.end());
        joints.insert(joints.end(), other.joints.begin(), other.joints.end());
        weights.insert(weights.end(), other.weights.begin(), other.weights.end());
        for (const Triangle& t : other.triangles) {
            triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
    }
    [[nodiscard]] BodyRest body() const { return {positions, triangles, joints, weights}; }
};

/// A rectangle of cloth: u (weft) runs along `across`, v (warp) along `up`; nu x nv quads.
inline Mesh sheet(const Vec3f& corner, const Vec3f& across, const Vec3f& up, std::uint32_t nu,
                  std::uint32_t nv) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= nv; ++j) {
        for (std::uint32_t i = 0; i <= nu; ++i) {
            mesh.positions.push_back(corner + across * (float(i) / float(nu)) +
                                     up * (float(j) / float(nv)));
        }
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.push_back({a, b, c});
        for (const std::uint32_t v : {a, b, c}) {
            mesh.corner_coords.emplace_back(across.norm() * float(v % (nu + 1)) / float(nu),
                                            up.norm() * float(v / (nu + 1)) / float(nv));
        }
    };
    for (std::uint32_t j = 0; j < nv; ++j) {
        for (std::uint32_t i = 0; i < nu; ++i) {
            const std::uint32_t a = j * (nu + 1) + i;
            const std::uint32_t b = a + nu + 1;
            if ((i + j) % 2 == 0) {
                add(a, a + 1, b + 1);
                add(a, b + 1, b);
            } else {
                add(a, a + 1, b);
                add(a + 1, b + 1, b);
            }
        }
    }
    mesh.bind_to(0);
    return mesh;
}

/// A closed surface of rings about an axis: point(s, angle), s from 0 to 1; poles at both ends.
inline Mesh lathe(std::uint32_t rings, std::uint32_t around,
                  const std::function<Vec3f(float, float)>& point) {
    Mesh mesh;
    mesh.positions.push_back(point(0.0f, 0.0f));
    for (std::uint32_t r = 1; r < rings; ++r) {
        for (std::uint32_t k = 0; k < around; ++k) {
            mesh.positions.push_back(
                point(float(r) / float(rings),
                      2.0f * std::numbers::pi_v<float> * float(k) / float(around)));
        }
    }
    mesh.positions.push_back(point(1.0f, 0.0f));
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    const auto at = [&](std::uint32_t r, std::uint32_t k) {
        return 1 + (r - 1) * around + k % around;
    };
    for (std::uint32_t k = 0; k < around; ++k) {
        mesh.triangles.push_back({0, at(1, k + 1), at(1, k)});
        for (std::uint32_t r = 1; r + 1 < rings; ++r) {
            mesh.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k)});
            mesh.triangles.push_back({at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
        }
        mesh.triangles.push_back({last, at(rings - 1, k), at(rings - 1, k + 1)});
    }
    mesh.bind_to(0);
    return mesh;
}

inline Mesh sphere(const Vec3f& centre, float radius) {
    return lathe(40, 80, [=](float s, float angle) {
        const float polar = s * std::numbers::pi_v<float>;
        return Vec3f(centre + radius * Vec3f(std::sin(polar) * std::cos(angle), std::cos(polar),
                                             std::sin(polar) * std::sin(angle)));
    });
}

/// Along x from `from` to `to`.
inline Mesh capsule(const Vec3f& from, float length, float radius) {
    return lathe(60, 24, [=](float s, float angle) {
        const float along = (length + 2.0f * radius) * s - radius;
        const float beyond = along < 0.0f ? -along : std::max(0.0f, along - length);
        const float r = std::sqrt(std::max(0.0f, radius * radius - beyond * beyond));
        return Vec3f(from + Vec3f(along, r * std::cos(angle), r * std::sin(angle)));
    });
}

/// A big box-like slab whose top is y = 0, turned about z by `slope`.
inline Mesh plane(float slope) {
    Mesh mesh = sheet({-2.0f, 0.0f, 1.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f}, 80, 40);
    for (Vec3f& p : mesh.positions) {
        p = Vec3f(p.x() * std::cos(slope), p.x() * std::sin(slope), p.z());
    }
    mesh.corner_coords.clear();
    return mesh;
}

/// One garment over a body that may move, in a plugin's world; targets are where the garment began.
template <class ClothWorld, class Settings>
struct ClothStage {
    Mesh body, cloth;
    std::vector<float> attachment;
    Fabric fabric;
    Settings settings;
    ClothWorld world;
    std::uint32_t handle = 0;
    std::vector<Vec3f> body_now, targets, positions, normals;
    bool begun = false;

    ClothStage(Mesh on, Mesh garment, const Settings& s = {}, const Fabric& f = {},
               std::vector<float> held = {})
        : body(std::move(on)), cloth(std::move(garment)), attachment(std::move(held)), fabric(f),
          settings(s), world(s), body_now(body.positions), targets(cloth.positions),
          positions(cloth.positions), normals(cloth.positions) {
        world.set_body(body.body());
        handle = world.add_garment(input());
    }

    [[nodiscard]] GarmentInput input() const {
        GarmentInput in;
        in.mesh = {cloth.positions, cloth.triangles, cloth.corner_coords, {}};
        in.fabric = fabric;
        in.joints = cloth.joints;
        in.weights = cloth.weights;
        in.attachment = attachment;
        return in;
    }

    StepResult step(double dt_s = 1.0 / 30.0) { return step_to(body_now, dt_s); }

    StepResult step_to(const std::vector<Vec3f>& body_after, double dt_s = 1.0 / 30.0) {
        const GarmentFrame frame{handle, targets, positions, normals};
        const StepResult result =
            world.step({body_now, body_after, dt_s, !begun, std::span(&frame, 1)});
        begun = true;
        body_now = body_after;
        return result;
    }

    [[nodiscard]] float root_mean_square_speed() const {
        float sum = 0.0f;
        for (const Vec4f& v : world.garment(handle).velocities()) {
            sum += v.squaredNorm();
        }
        return std::sqrt(sum / static_cast<float>(positions.size()));
    }
};

/// A body too far away to matter.
inline Mesh far_away() {
    return sphere({0.0f, -500.0f, 0.0f}, 0.1f);
}

} // namespace toile::test::cloth_stage
