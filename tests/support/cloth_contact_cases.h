// Contact against closed forms, for every plugin of cloth: nothing inside, friction, a fast arm,
// recovery, rest. Included after a plugin's scenes.h, which names the plugin.
#pragma once

#include <gtest/gtest.h>

namespace toile::TOILE_CLOTH_PLUGIN::test {
namespace {

/// Least distance of vertices and triangle centres from a sphere's surface.
float least_height(const Stage& stage, const Vec3f& centre, float radius) {
    float least = 1e9f;
    for (const Vec3f& p : stage.positions) {
        least = std::min(least, (p - centre).norm() - radius);
    }
    for (const Triangle& t : stage.cloth.triangles) {
        const Vec3f p =
            (stage.positions[t[0]] + stage.positions[t[1]] + stage.positions[t[2]]) / 3.0f;
        least = std::min(least, (p - centre).norm() - radius);
    }
    return least;
}

TEST(Contact, DrapesOverASphere) {
    const Vec3f centre(0, 1, 0);
    Settings settings;
    settings.leash = 5.0;
    Stage stage(sphere(centre, 0.2f),
                sheet({-0.35f, 1.22f, 0.35f}, {0.7f, 0, 0}, {0, 0, -0.7f}, 35, 35), settings);
    for (int i = 0; i < 60; ++i) {
        ASSERT_EQ(stage.step(), StepResult::ok);
        ASSERT_GT(least_height(stage, centre, 0.2f), -0.002f) << "frame " << i;
    }
    // It hangs: corners well below the top, the middle still on it.
    EXPECT_LT(stage.positions[0].y(), 1.1f);
    EXPECT_GT(stage.positions[36 * 18 + 18].y(), 1.15f);
}

TEST(Contact, RestIsQuiet) {
    const Vec3f centre(0, 1, 0);
    Stage stage(sphere(centre, 0.2f),
                sheet({-0.3f, 1.22f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f}, 30, 30));
    for (int i = 0; i < 150; ++i) {
        stage.step();
    }
    EXPECT_LT(stage.root_mean_square_speed(), 0.03f);
    const std::vector<Vec3f> before = stage.positions;
    stage.step();
    float farthest = 0.0f;
    for (std::size_t v = 0; v < before.size(); ++v) {
        farthest = std::max(farthest, (stage.positions[v] - before[v]).norm());
    }
    EXPECT_LT(farthest, 0.004f);
}

/// How far a small sheet slides down a slope in a second.
float slide(float slope, float friction) {
    Fabric fabric;
    fabric.friction = friction;
    Settings settings;
    settings.leash = 5.0;
    settings.air_drag = 0.0;
    const Vec3f along(std::cos(slope), std::sin(slope), 0.0f);
    const Vec3f up(-std::sin(slope), std::cos(slope), 0.0f);
    Stage stage(plane(slope),
                sheet(Vec3f(0, 0, 0.1f) + 0.004f * up, 0.2f * along, {0, 0, -0.2f}, 10, 10),
                settings, fabric);
    for (int i = 0; i < 30; ++i) {
        stage.step();
    }
    Vec3f moved = Vec3f::Zero();
    for (std::size_t v = 0; v < stage.positions.size(); ++v) {
        moved += (stage.positions[v] - stage.cloth.positions[v]) / float(stage.positions.size());
    }
    return -moved.dot(along);
}

TEST(Contact, FrictionHoldsBelowItsAngle) {
    EXPECT_LT(slide(std::atan(0.4f) - 0.05f, 0.4f), 0.004f);
}

TEST(Contact, FrictionLosesAboveItsAngle) {
    const float angle = std::atan(0.4f) + 0.2f;
    const float expected = 0.5f * 9.81f * (std::sin(angle) - 0.4f * std::cos(angle)); // m in 1 s
    EXPECT_NEAR(slide(angle, 0.4f), expected, 0.12f * expected);
}

TEST(Contact, WithoutFrictionItSlidesFreely) {
    const float expected = 0.5f * 9.81f * std::sin(0.2f);
    EXPECT_NEAR(slide(0.2f, 0.0f), expected, 0.05f * expected);
}

// A forearm at 5 m/s goes 17 cm a frame, twice its own thickness.
TEST(Contact, AFastArmDoesNotPass) {
    const float radius = 0.04f;
    Mesh arm = capsule({-0.4f, 0.75f, -0.5f}, 0.8f, radius);
    arm.bind_to(8); // left lower arm; the cloth is bound to the hips
    Mesh hips = sphere({0.0f, 2.0f, 0.0f}, 0.1f);
    const std::size_t first = hips.positions.size();
    hips.join(arm);
    Mesh curtain = sheet({-0.25f, 0.5f, 0.0f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 25, 25);
    std::vector<float> held(curtain.positions.size(), 0.0f);
    std::fill(held.end() - 26, held.end(), 1.0f);
    Settings settings;
    settings.leash = 5.0;
    Stage stage(hips, curtain, settings, {}, held);
    std::vector<Vec3f> body = hips.positions;
    float front = -0.5f;
    for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(stage.step_to(body), StepResult::ok);
    }
    while (front < 0.1f) { // further on the cloth lies over the arm
        for (std::size_t v = first; v < body.size(); ++v) {
            body[v].z() += 5.0f / 30.0f;
        }
        front += 5.0f / 30.0f;
        ASSERT_EQ(stage.step_to(body), StepResult::ok);
        int passed = 0;
        for (const Vec3f& p : stage.positions) {
            const float distance = std::hypot(p.y() - 0.75f, p.z() - front) - radius;
            ASSERT_GT(distance, -0.002f) << "arm at " << front;
            // At the arm's height the cloth must be pushed ahead of it.
            passed += std::abs(p.y() - 0.75f) < 0.5f * radius && p.z() < front ? 1 : 0;
        }
        EXPECT_EQ(passed, 0) << "arm at " << front;
    }
    EXPECT_GT(front, 0.1f);
}

/// Cloth folded over between a trunk and an arm, one flank on each, as a sleeve meets its side
/// seam.
struct Armpit {
    static constexpr float kTrunk = 0.12f, kArm = 0.05f; ///< m, radii
    std::size_t arm_first = 0;
    Mesh body, cloth;
    std::vector<float> held, arm_share; ///< of the cloth's vertices

    /// The body with its arm this much lower; the cloth's targets follow.
    [[nodiscard]] std::vector<Vec3f> lowered(float by, std::vector<Vec3f>& targets) const {
        std::vector<Vec3f> out = body.positions;
        for (std::size_t v = arm_first; v < out.size(); ++v) {
            out[v].z() -= by;
        }
        for (std::size_t v = 0; v < targets.size(); ++v) {
            targets[v] = cloth.positions[v] - Vec3f(0, 0, arm_share[v] * by);
        }
        return out;
    }

    explicit Armpit(float gap) {
        body = capsule({-0.4f, 1.0f, 0.0f}, 0.8f, kTrunk);
        body.bind_to(2);
        Mesh arm = capsule({-0.4f, 1.0f, kTrunk + gap + kArm}, 0.8f, kArm);
        arm.bind_to(7);
        arm_first = body.positions.size();
        body.join(arm);
        cloth = sheet({-0.15f, -0.2f, 0.0f}, {0.3f, 0, 0}, {0, 0.4f, 0}, 20, 26);
        for (std::size_t v = 0; v < cloth.positions.size(); ++v) {
            Vec3f& p = cloth.positions[v];
            const float along = p.y(); // from the fold
            const float beside = std::clamp(along, -0.4f * gap, 0.4f * gap);
            p = Vec3f(p.x(), 1.1f - std::abs(along), kTrunk + 0.5f * gap + beside);
            arm_share.push_back(0.5f + beside / (0.8f * gap));
            held.push_back(std::abs(along) < 1e-4f ? 1.0f : 0.0f);
            cloth.joints[v] = {2, 7, 0, 0};
            cloth.weights[v] = {1.0f - arm_share[v], arm_share[v], 0.0f, 0.0f};
        }
    }
};

float longest_stretch(const Stage& stage) {
    float most = 0.0f;
    for (std::size_t t = 0; t < stage.cloth.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& corner = stage.cloth.triangles[t];
            const float rest = (stage.cloth.corner_coords[3 * t + (k + 1) % 3] -
                                stage.cloth.corner_coords[3 * t + k])
                                   .norm();
            const float now =
                (stage.positions[corner[(k + 1) % 3]] - stage.positions[corner[k]]).norm();
            most = std::max(most, now / rest - 1.0f);
        }
    }
    return most;
}

// The arm comes down until it runs 15 mm into the trunk, where no place is left for the cloth: it
// must neither be torn between the two nor gather speed, and it hangs again when the arm is gone.
TEST(Contact, ClothBetweenLimbsThatRunIntoEachOtherStaysWhole) {
    constexpr float kGap = 0.06f;
    constexpr int kFrames = 20;
    const Armpit scene(kGap);
    Stage stage(scene.body, scene.cloth, {}, {}, scene.held);
    const auto move_to = [&](float closed) {
        ASSERT_EQ(stage.step_to(scene.lowered(closed, stage.targets)), StepResult::ok);
        EXPECT_LT(longest_stretch(stage), 0.4f) << "closed by " << closed;
    };
    const float whole = kGap + 0.015f;
    for (int i = 0; i < 3 * kFrames; ++i) {
        move_to(whole * std::min(1.0f, float(i) / kFrames));
    }
    EXPECT_LT(stage.root_mean_square_speed(), 0.2f);
    for (int i = 0; i < 3 * kFrames; ++i) {
        move_to(whole * std::max(0.0f, 1.0f - float(i) / kFrames));
    }
    EXPECT_LT(longest_stretch(stage), 0.2f);
}

// A hand between a skirt and the thigh is drawn out upwards: the skirt stays down.
TEST(Contact, AHandBeneathTheClothDoesNotCarryItOff) {
    const float radius = 0.03f;
    Mesh hand = capsule({-0.1f, 0.85f, 0.13f}, 0.2f, radius); // lies across, in front of the thigh
    hand.bind_to(8);
    Mesh thigh = sphere({0.0f, 0.8f, 0.0f}, 0.1f);
    const std::size_t first = thigh.positions.size();
    thigh.join(hand);
    Mesh apron = sheet({-0.15f, 0.6f, 0.17f}, {0.3f, 0, 0}, {0, 0.4f, 0}, 20, 26);
    std::vector<float> held(apron.positions.size(), 0.0f);
    std::fill(held.end() - 21, held.end(), 1.0f);
    Stage stage(thigh, apron, {}, {}, held);
    std::vector<Vec3f> body = thigh.positions;
    for (int i = 0; i < 10; ++i) {
        ASSERT_EQ(stage.step_to(body), StepResult::ok);
    }
    for (int i = 0; i < 20; ++i) { // outwards and up, to above where the apron is held
        for (std::size_t v = first; v < body.size(); ++v) {
            body[v] += Vec3f(0.0f, 0.015f, 0.01f);
        }
        ASSERT_EQ(stage.step_to(body), StepResult::ok);
    }
    for (int i = 0; i < 15; ++i) {
        ASSERT_EQ(stage.step_to(body), StepResult::ok);
    }
    float lowest = 1.0f;
    for (const Vec3f& p : stage.positions) {
        lowest = std::min(lowest, p.y());
    }
    EXPECT_LT(lowest, 0.62f);
    for (const Vec3f& p : stage.positions) {
        EXPECT_LT(p.z(), 0.27f) << "carried off at " << p.transpose();
    }
}

TEST(Contact, StartInsideTheBodyRecovers) {
    const Vec3f centre(0, 1, 0);
    // A tube that fits an 18 cm body, put over one of 20 cm.
    Mesh tube = sheet({0, 0.9f, 0}, {1.13f, 0, 0}, {0, 0.2f, 0}, 56, 10);
    for (Vec3f& p : tube.positions) {
        const float angle = p.x() / 1.13f * 6.2f;
        p = Vec3f(0.18f * std::cos(angle), p.y(), -0.18f * std::sin(angle));
    }
    tube.corner_coords.clear();
    Fabric stretchy;
    stretchy.stretch_warp = stretchy.stretch_weft = 100.0f;
    stretchy.shear = 50.0f;
    Settings settings;
    settings.limit_edges = 0.0;
    Stage stage(sphere(centre, 0.2f), tube, settings, stretchy);
    for (int i = 0; i < 15; ++i) {
        ASSERT_EQ(stage.step(), StepResult::ok);
    }
    EXPECT_GT(least_height(stage, centre, 0.2f), -0.002f);
    EXPECT_LT(stage.root_mean_square_speed(), 1.0f);
}

TEST(Contact, TheLeashHolds) {
    Settings settings;
    settings.leash = 0.05;
    Stage stage(far_away(), sheet({0, 1, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}, 8, 8), settings);
    for (int i = 0; i < 60; ++i) {
        stage.step();
    }
    for (std::size_t v = 0; v < stage.positions.size(); ++v) {
        EXPECT_LT((stage.positions[v] - stage.targets[v]).norm(), 0.0505f);
    }
}

TEST(Contact, HeldVerticesFollowTheirTargetsExactly) {
    Mesh mesh = sheet({0, 1, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}, 8, 8);
    std::vector<float> held(mesh.positions.size(), 0.0f);
    held[80] = 1.0f;
    held[72] = 0.7f;
    Stage stage(far_away(), mesh, {}, {}, held);
    for (int i = 0; i < 60; ++i) {
        for (Vec3f& p : stage.targets) {
            p.x() += 0.01f;
        }
        stage.step();
        ASSERT_EQ(stage.positions[80], stage.targets[80]);
    }
    EXPECT_LT((stage.positions[72] - stage.targets[72]).norm(), 0.05f);
}

} // namespace
} // namespace toile::TOILE_CLOTH_PLUGIN::test
