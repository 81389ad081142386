#include "people.h"

namespace toile::scape_fit {
namespace {

/// normal . x of a vertex after the unknowns moved by `step`.
double moved_along(const FitLevel& level, const Somebody& who, const Eigen::VectorXd& step,
                   std::uint32_t vertex, const Vec3f& normal) {
    const int k = adult().component_count();
    FitShape shape = who.shape;
    shape.coefficients += step.head(k);
    PosedLevel posed;
    pose_level(adult(), level, shape, moved_pose(who.pose, step.data() + k), posed);
    return normal.cast<double>().dot(posed.positions[vertex].cast<double>());
}

TEST(FitModel, MotionRowsAgreeWithDifferences) {
    const Somebody who;
    FitLevel level = adult().level(2);
    // The pose's correctives count as fixed in the derivative.
    for (auto& weights : level.correctives.weights)
        weights.setZero();
    PosedLevel posed;
    pose_level(adult(), level, who.shape, who.pose, posed);
    const int k = adult().component_count(), size = k + kPoseUnknowns;
    std::vector<float> row(static_cast<std::size_t>(size));
    int tested = 0;
    for (std::uint32_t v = 0; v < level.vertices.size(); v += 31) {
        const auto& weights = level.skin.weights[v];
        // Where bones share a vertex the blend of rotations adds what the row leaves out.
        if (*std::max_element(weights.begin(), weights.end()) < 0.999f) continue;
        ++tested;
        const Vec3f normal = Vec3f(0.3f, -0.5f, 0.8f).normalized();
        motion_row(adult(), level, posed, v, normal, row.data());
        for (int i = 0; i < size; ++i) {
            Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
            const double h = 5e-3;
            step[i] = h;
            const double ahead = moved_along(level, who, step, v, normal);
            const double behind = moved_along(level, who, -step, v, normal);
            EXPECT_NEAR(row[static_cast<std::size_t>(i)], (ahead - behind) / (2.0 * h), 2e-4)
                << "vertex " << v << ", unknown " << i;
        }
    }
    EXPECT_GT(tested, 3);
}

TEST(FitModel, LevelsPoseLikeTheFullSurface) {
    const Somebody who;
    PosedLevel full, coarse;
    pose_level(adult(), adult().level(0), who.shape, who.pose, full);
    for (std::size_t l = 1; l < adult().level_count(); ++l) {
        pose_level(adult(), adult().level(l), who.shape, who.pose, coarse);
        for (std::size_t v = 0; v < coarse.positions.size(); ++v)
            ASSERT_LT((coarse.positions[v] - full.positions[adult().level(l).vertices[v]]).norm(),
                      1e-6f);
    }
}

TEST(FitModel, OffsetsMoveTheSurfaceAndNotTheJoints) {
    Somebody who;
    const body::BodyShape plain = rest_shape(adult(), who.shape);
    who.shape.offsets.assign(adult().level(0).vertices.size(), 0.01f);
    const body::BodyShape fuller = rest_shape(adult(), who.shape);
    const auto hips_height = [](const body::BodyShape& s) {
        return s.skeleton.rest_positions[0].y();
    };
    EXPECT_NEAR(hips_height(fuller), hips_height(plain) + 0.01f, 1e-3f) << "it stands on its soles";
    geometry::TriangleMesh a{plain.positions, {}, adult().level(0).triangles};
    geometry::TriangleMesh b{fuller.positions, {}, adult().level(0).triangles};
    EXPECT_NEAR(geometry::volume(b) - geometry::volume(a), 0.01 * geometry::surface_area(a), 2e-3);
}

TEST(CameraCorrection, IsUndone) {
    CameraCorrection camera;
    camera.turn = Vec3d(0.02, -0.01, 0.03);
    camera.shift = Vec3d(0.01, 0.02, -0.005);
    camera.scale = 1.004;
    const Vec3f place(0.3f, 1.0f, 2.4f), point(0.1f, 0.7f, 0.2f);
    EXPECT_LT((camera.undo(camera.apply(point, place), place) - point).norm(), 1e-5f);
    EXPECT_GT((camera.apply(point, place) - point).norm(), 0.01f);
}

} // namespace
} // namespace toile::scape_fit
