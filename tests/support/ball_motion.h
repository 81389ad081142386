// A ball on a stick that is moved about, as a surface cache that a simulated sensor shows.
#pragma once

#include "body/surface_cache.h"
#include "core/random.h"
#include "support/meshes.h"

#include <numbers>

namespace toile::test {

struct BallMotion {
    float radius_m = 0.1f;
    int frames = 60;
    Vec3f low{-0.7f, 0.5f, -0.7f}, high{0.7f, 1.6f, 0.7f}; ///< where the centre goes
    std::uint64_t seed = 1;
    bool straight = false; ///< along one line only
};

/// Centres, one a frame.
inline std::vector<Vec3f> ball_places(const BallMotion& motion) {
    Random random(motion.seed);
    std::vector<Vec3f> out;
    const Vec3f size = motion.high - motion.low;
    for (int k = 0; k < motion.frames; ++k) {
        Vec3f share;
        for (int i = 0; i < 3; ++i)
            share[i] = static_cast<float>(random.uniform());
        if (motion.straight) share = Vec3f::Constant(share.x());
        out.push_back(motion.low + size.cwiseProduct(share));
    }
    return out;
}

/// The stick is 16 mm thick and half a metre long. 30 frames a second.
inline void write_ball_motion(const std::filesystem::path& folder, const BallMotion& motion) {
    const geometry::TriangleMesh ball = sphere(motion.radius_m, 6);
    const float under = -0.9f * motion.radius_m;
    const geometry::TriangleMesh stick =
        box({-0.008f, under - 0.5f, -0.008f}, {0.008f, under, 0.008f});
    assets::Scene scene;
    for (const auto& [name, mesh] : {std::pair{"ball", &ball}, std::pair{"stick", &stick}}) {
        assets::Primitive primitive;
        primitive.positions = mesh->positions;
        primitive.triangles = mesh->triangles;
        assets::Node node;
        node.name = name;
        node.mesh = static_cast<int>(scene.meshes.size());
        scene.meshes.push_back({name, {std::move(primitive)}, {}});
        scene.nodes.push_back(node);
    }
    body::SurfaceCacheWriter writer(folder, scene,
                                    {body::SurfaceRole::other, body::SurfaceRole::other});
    double time_s = 0.0;
    for (const Vec3f& centre : ball_places(motion)) {
        std::array<std::vector<Vec3f>, 2> moved = {ball.positions, stick.positions};
        for (auto& positions : moved)
            for (Vec3f& p : positions)
                p += centre;
        const std::array<std::span<const Vec3f>, 2> spans = {moved[0], moved[1]};
        writer.add(time_s, {}, spans);
        time_s += 1.0 / 30.0;
    }
}

} // namespace toile::test
