// Depth pictures, camera model, extrinsics, OBJ import and nearest points hold together: what the
// simulated camera saw lies on the body it looked at.
#include "assets/files.h"
#include "geometry/mesh.h"
#include "geometry/nearest_surface.h"
#include "imaging/capture_folder.h"
#include "support/shared_data.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace toile::assets {
namespace {

TEST(Turntable, DepthLiesOnTheBody) {
    TOILE_SHARED_DATA_OR_SKIP(set, "turntable_full");
    TOILE_SHARED_DATA_OR_SKIP(scene_set, "cloth_scene");
    const Scene body = load_scene(scene_set / "body.obj");
    ASSERT_EQ(body.meshes.size(), 1u);
    const Primitive& p = body.meshes[0].primitives.at(0);
    Vec3f low = p.positions[0];
    Vec3f high = p.positions[0];
    for (const Vec3f& v : p.positions) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    const geometry::NearestSurface surface(p.positions, p.triangles);

    const imaging::Capture capture = imaging::open_capture(set);
    const imaging::CaptureCamera& camera = capture.cameras[0];
    const imaging::DepthUnprojector unprojector(camera.intrinsics);
    const imaging::DepthImage depth = camera.load_depth(0);
    std::vector<Vec3f> points(depth.metres.size());
    unprojector.points(depth.metres, points);
    const Eigen::Isometry3f world_from_camera = camera.world_from_camera->cast<float>();

    // The capture is centred at y = 0 (its SOURCE.txt); bring the body there.
    const Vec3f centred(0.0f, 0.5f * (low.y() + high.y()), 0.0f);
    const bool already = std::abs(centred.y()) < 0.05f;
    std::vector<float> distances;
    for (const Vec3f& q : points) {
        if (!q.allFinite()) continue;
        const Vec3f world = world_from_camera * q;
        distances.push_back(surface.nearest(already ? world : Vec3f(world + centred)).distance);
    }
    ASSERT_GT(distances.size(), 20000u);
    std::sort(distances.begin(), distances.end());
    EXPECT_LT(distances[distances.size() / 2], 0.006f);        // median: the sensor's noise
    EXPECT_LT(distances[distances.size() * 95 / 100], 0.025f); // its steps at 1.9 m
}

} // namespace
} // namespace toile::assets
