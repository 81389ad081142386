#include "scan/deformation_graph.h"

#include "core/error.h"
#include "scan/template_motion.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::scan {
namespace {

/// Two balls side by side, 2 cm apart.
geometry::TriangleMesh two_balls() {
    geometry::TriangleMesh out = test::sphere(0.1f, 4);
    const auto count = static_cast<std::uint32_t>(out.positions.size());
    const std::size_t triangles = out.triangles.size();
    for (std::uint32_t v = 0; v < count; ++v)
        out.positions.emplace_back(out.positions[v] + Vec3f(0.22f, 0.0f, 0.0f));
    for (std::size_t t = 0; t < triangles; ++t) {
        const Triangle& of = out.triangles[t];
        out.triangles.push_back({of[0] + count, of[1] + count, of[2] + count});
    }
    return out;
}

Pose some_motion() {
    Pose out = Pose::Identity();
    out.rotate(Eigen::AngleAxisd(0.7, Vec3d(1.0, 2.0, -0.5).normalized()));
    out.translation() = Vec3d(0.3, -0.2, 0.1);
    return out;
}

std::vector<Vec3f> moved(const Pose& motion, std::span<const Vec3f> points) {
    std::vector<Vec3f> out;
    for (const Vec3f& p : points)
        out.push_back((motion * p.cast<double>()).cast<float>());
    return out;
}

TEST(DeformationGraph, WeightsSumToOneAndNodesHoldTheirOwnPlace) {
    const auto mesh = two_balls();
    const DeformationGraph graph(mesh, 24);
    ASSERT_EQ(graph.nodes().size(), 24u);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const NodeBinding& binding = graph.bindings()[v];
        float sum = 0.0f;
        for (const float w : binding.weights)
            sum += w;
        EXPECT_NEAR(sum, 1.0f, 1e-5f);
        const auto nearest = std::min_element(
            graph.nodes().begin(), graph.nodes().end(), [&](const Vec3f& a, const Vec3f& b) {
                return (a - mesh.positions[v]).norm() < (b - mesh.positions[v]).norm();
            });
        if ((*nearest - mesh.positions[v]).norm() > 1e-6f) continue;
        EXPECT_EQ(binding.nodes[0], nearest - graph.nodes().begin());
    }
}

TEST(DeformationGraph, WhatIsNearButNotAlongTheSurfaceIsApart) {
    const auto mesh = two_balls();
    const DeformationGraph graph(mesh, 24);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        for (std::size_t k = 0; k < NodeBinding::kMost; ++k)
            if (graph.bindings()[v].weights[k] > 0.0f) {
                const Vec3f& node = graph.nodes()[graph.bindings()[v].nodes[k]];
                EXPECT_EQ(node.x() > 0.11f, mesh.positions[v].x() > 0.11f);
            }
    for (const auto& [a, b] : graph.links())
        EXPECT_EQ(graph.nodes()[a].x() > 0.11f, graph.nodes()[b].x() > 0.11f);
}

TEST(DeformationGraph, ARigidMotionStaysOne) {
    const auto mesh = two_balls();
    const DeformationGraph graph(mesh, 24);
    const Pose motion = some_motion();
    const auto there = moved(motion, mesh.positions);
    std::vector<Warp> warps;
    for (const Pose& node : node_motions(graph, mesh.positions, there)) {
        EXPECT_LT((node.matrix() - motion.matrix()).norm(), 1e-5);
        warps.emplace_back(node.matrix().topRows<3>().cast<float>());
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 17) {
        const Triangle& corners = mesh.triangles[t];
        const Vec3f bary(0.2f, 0.5f, 0.3f);
        Vec3f from = Vec3f::Zero(), to = Vec3f::Zero();
        for (int c = 0; c < 3; ++c) {
            from += bary[c] * mesh.positions[corners[static_cast<std::size_t>(c)]];
            to += bary[c] * there[corners[static_cast<std::size_t>(c)]];
        }
        EXPECT_LT((warped(blended(graph.at(corners, bary), warps), from) - to).norm(), 1e-5f);
    }
}

TEST(DeformationGraph, RefusesWhatItCannotHave) {
    const auto mesh = test::sphere(0.1f, 2);
    EXPECT_THROW(DeformationGraph({}, 4), Error);
    EXPECT_THROW(DeformationGraph(mesh, 0), Error);
    EXPECT_THROW(DeformationGraph(mesh, 256), Error);
    EXPECT_THROW(DeformationGraph(mesh, mesh.positions.size() + 1), Error);
}

TEST(TemplateMotion, TurnsEvenlyBetweenInstants) {
    const auto mesh = two_balls();
    const DeformationGraph graph(mesh, 12);
    const auto turned = [&](double angle) {
        // About a vertical line through the middle of both.
        const Vec3d middle(0.11, 0.0, 0.0);
        Pose out = Pose::Identity();
        out.translate(middle);
        out.rotate(Eigen::AngleAxisd(angle, Vec3d::UnitY()));
        out.translate(-middle);
        return out;
    };
    constexpr double kStep = 0.5;
    TemplatePoses poses;
    poses[4] = mesh.positions;
    poses[8] = moved(turned(kStep), mesh.positions);
    const TemplateMotion motion(graph, poses);
    for (const std::uint32_t number : {4u, 5u, 6u, 8u, 11u}) {
        const double angle = kStep * std::min(1.0, (number - 4.0) / 4.0);
        for (const Pose& node : motion.at(number))
            EXPECT_LT((node.matrix() - turned(angle).inverse().matrix()).norm(), 1e-5) << number;
    }
    poses[9].resize(3);
    EXPECT_THROW(TemplateMotion(graph, poses), Error);
}

} // namespace
} // namespace toile::scan
