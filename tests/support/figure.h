// A mannequin of capsules with a closed surface, a skeleton and weights; and clothes at a distance
// around it. For tests that need a whole body and no files.
#pragma once

#include "body/body_model.h"
#include "unit/body/body_fixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

namespace toile::test {

/// Level set of `field` at 0 (negative inside) on a grid of cubes cut into tetrahedra: closed and
/// manifold where it stays inside the box.
inline geometry::TriangleMesh iso_surface(const std::function<float(const Vec3f&)>& field,
                                          const Vec3f& low, const Vec3f& high, float cell) {
    const Eigen::Vector3i n = ((high - low) / cell).array().ceil().matrix().cast<int>();
    const auto id = [&n](const Eigen::Vector3i& c) {
        return static_cast<std::uint32_t>((c.z() * (n.y() + 1) + c.y()) * (n.x() + 1) + c.x());
    };
    std::vector<float> value(static_cast<std::size_t>((n.x() + 1) * (n.y() + 1) * (n.z() + 1)));
    const auto place = [&](const Eigen::Vector3i& c) {
        return Vec3f(low + cell * c.cast<float>());
    };
    for (int z = 0; z <= n.z(); ++z)
        for (int y = 0; y <= n.y(); ++y)
            for (int x = 0; x <= n.x(); ++x) {
                const float v = field(place({x, y, z}));
                value[id({x, y, z})] = std::abs(v) < 1e-5f ? 1e-5f : v; // keeps triangles fat
            }
    geometry::TriangleMesh mesh;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cut;
    const auto vertex = [&](const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
        const std::pair<std::uint32_t, std::uint32_t> key = std::minmax({id(a), id(b)});
        const auto [at, added] =
            cut.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) {
            const float va = value[id(a)];
            const float t = std::clamp(va / (va - value[id(b)]), 0.02f, 0.98f);
            mesh.positions.push_back(place(a) + t * (place(b) - place(a)));
        }
        return at->second;
    };
    const auto emit = [&](Triangle t, const Eigen::Vector3i& inside) {
        const Vec3f& a = mesh.positions[t[0]];
        const Vec3f normal = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
        if (normal.dot(a - place(inside)) < 0.0f) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
    };
    static constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
        {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
    for (int z = 0; z < n.z(); ++z)
        for (int y = 0; y < n.y(); ++y)
            for (int x = 0; x < n.x(); ++x)
                for (const auto& tetrahedron : kTetrahedra) {
                    std::vector<Eigen::Vector3i> in;
                    std::vector<Eigen::Vector3i> out;
                    for (const int corner : tetrahedron) {
                        const Eigen::Vector3i c(x + (corner & 1), y + ((corner >> 1) & 1),
                                                z + (corner >> 2));
                        (value[id(c)] < 0.0f ? in : out).push_back(c);
                    }
                    if (in.size() == 1) {
                        emit({vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[0], out[2])},
                             in[0]);
                    } else if (in.size() == 3) {
                        emit({vertex(in[0], out[0]), vertex(in[1], out[0]), vertex(in[2], out[0])},
                             in[0]);
                    } else if (in.size() == 2) {
                        const std::uint32_t a = vertex(in[0], out[0]);
                        const std::uint32_t b = vertex(in[0], out[1]);
                        const std::uint32_t c = vertex(in[1], out[1]);
                        const std::uint32_t d = vertex(in[1], out[0]);
                        emit({a, b, c}, in[0]);
                        emit({a, c, d}, in[0]);
                    }
                }
    return mesh;
}

/// One limb of the figure.
struct Capsule {
    body::Joint joint;
    Vec3f from;
    Vec3f to;
    float radius;
};

struct Figure {
    body::Skeleton skeleton;
    std::vector<Capsule> capsules;
    geometry::TriangleMesh mesh;
    body::SkinWeights skin;

    [[nodiscard]] static float distance(const Capsule& c, const Vec3f& p) {
        const Vec3f d = c.to - c.from;
        const float t = std::clamp((p - c.from).dot(d) / d.squaredNorm(), 0.0f, 1.0f);
        return (p - c.from - t * d).norm() - c.radius;
    }
    /// Rounded union of the capsules; negative inside. Metres near the surface.
    [[nodiscard]] float field(const Vec3f& p) const {
        constexpr float kRound = 0.015f;
        float sum = 0.0f;
        for (const Capsule& c : capsules)
            sum += std::exp(-distance(c, p) / kRound);
        return -kRound * std::log(std::max(sum, 1e-30f));
    }
};

/// `girth` scales all radii; 1.70 m tall, legs 3 cm apart.
inline Figure figure(float girth = 1.0f, float height = 1.0f, float cell = 0.025f) {
    using enum body::Joint;
    Figure out;
    out.skeleton = adult_skeleton();
    for (Vec3f& p : out.skeleton.rest_positions)
        p *= height;
    const auto at = [&out](body::Joint j) { return out.skeleton.rest(j); };
    const auto add = [&](body::Joint j, const Vec3f& a, const Vec3f& b, float r) {
        out.capsules.push_back({j, a, b, girth * r});
    };
    for (const float side : {0.05f, -0.05f}) {
        const Vec3f s(side, 0.0f, 0.0f);
        add(hips, at(hips) + s, at(spine) + s, 0.11f);
        add(spine, at(spine) + s, at(chest) + s, 0.105f);
        add(upper_chest, at(chest) + s, at(upper_chest) + s, 0.115f);
    }
    add(neck, at(upper_chest), at(head), 0.05f);
    add(head, at(head), at(head) + Vec3f(0, 0.08f, 0.02f), 0.085f);
    const auto limb = [&](body::Joint a, body::Joint b, float r) { add(a, at(a), at(b), r); };
    limb(left_shoulder, left_upper_arm, 0.05f);
    limb(left_upper_arm, left_lower_arm, 0.045f);
    limb(left_lower_arm, left_hand, 0.036f);
    add(left_hand, at(left_hand), at(left_hand) + Vec3f(0.07f, -0.06f, 0.0f), 0.03f);
    limb(right_shoulder, right_upper_arm, 0.05f);
    limb(right_upper_arm, right_lower_arm, 0.045f);
    limb(right_lower_arm, right_hand, 0.036f);
    add(right_hand, at(right_hand), at(right_hand) + Vec3f(-0.07f, -0.06f, 0.0f), 0.03f);
    limb(left_upper_leg, left_lower_leg, 0.075f);
    limb(left_lower_leg, left_foot, 0.052f);
    limb(left_foot, left_toes, 0.035f);
    limb(right_upper_leg, right_lower_leg, 0.075f);
    limb(right_lower_leg, right_foot, 0.052f);
    limb(right_foot, right_toes, 0.035f);
    out.mesh =
        iso_surface([&out](const Vec3f& p) { return out.field(p); },
                    height * Vec3f(-0.82f, -0.1f, -0.3f), height * Vec3f(0.82f, 1.8f, 0.3f), cell);
    for (const Vec3f& p : out.mesh.positions) {
        std::array<double, body::kJointCount> near{};
        for (const Capsule& c : out.capsules)
            near[static_cast<std::size_t>(c.joint)] += std::exp(-Figure::distance(c, p) / 0.02f);
        std::array<std::uint16_t, body::kJointCount> order{};
        for (std::size_t j = 0; j < order.size(); ++j)
            order[j] = static_cast<std::uint16_t>(j);
        std::stable_sort(order.begin(), order.end(),
                         [&near](std::size_t a, std::size_t b) { return near[a] > near[b]; });
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
            sum += near[order[k]];
        std::array<std::uint16_t, 4> joints{};
        std::array<float, 4> weights{};
        for (std::size_t k = 0; k < 4; ++k) {
            joints[k] = order[k];
            weights[k] = static_cast<float>(near[order[k]] / sum);
        }
        out.skin.joints.push_back(joints);
        out.skin.weights.push_back(weights);
    }
    return out;
}

/// The triangles all of whose vertices pass `keep`, with unused vertices dropped.
inline geometry::TriangleMesh part_of(const geometry::TriangleMesh& mesh,
                                      const std::function<bool(const Vec3f&)>& keep) {
    geometry::TriangleMesh out;
    std::map<std::uint32_t, std::uint32_t> number;
    for (const Triangle& t : mesh.triangles) {
        if (!std::all_of(t.begin(), t.end(), [&](auto v) { return keep(mesh.positions[v]); }))
            continue;
        Triangle mapped{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [at, added] =
                number.try_emplace(t[k], static_cast<std::uint32_t>(out.positions.size()));
            if (added) out.positions.push_back(mesh.positions[t[k]]);
            mapped[k] = at->second;
        }
        out.triangles.push_back(mapped);
    }
    return out;
}

/// A short-sleeved shirt `ease` metres around the figure.
inline geometry::TriangleMesh shirt_on(const Figure& body, float ease, float cell = 0.02f) {
    const auto mesh = iso_surface([&](const Vec3f& p) { return body.field(p) - ease; },
                                  Vec3f(-0.9f, 0.7f, -0.35f), Vec3f(0.9f, 1.7f, 0.35f), cell);
    return part_of(mesh, [](const Vec3f& p) {
        const bool neckline = p.y() > 1.41f && std::abs(p.x()) < 0.1f;
        return p.y() > 0.88f && std::abs(p.x()) < 0.30f && !neckline;
    });
}

/// A knee-length skirt, cut like a bell: 0.17 m at the waist, wider at the hem.
inline geometry::TriangleMesh skirt_on(float hem_radius, int around = 64, int rows = 26) {
    geometry::TriangleMesh mesh;
    const float pi = std::numbers::pi_v<float>;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < around; ++i) {
            const float t = static_cast<float>(j) / static_cast<float>(rows);
            const float radius = hem_radius + (0.175f - hem_radius) * t;
            const float angle = 2.0f * pi * static_cast<float>(i) / static_cast<float>(around);
            mesh.positions.emplace_back((radius + 0.03f * t) * std::sin(angle), 0.45f + 0.6f * t,
                                        radius * std::cos(angle));
        }
    const auto at = [around](int i, int j) {
        return static_cast<std::uint32_t>(j * around + i % around);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

} // namespace toile::test
