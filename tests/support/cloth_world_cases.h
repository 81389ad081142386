// A world of cloth as its callers may treat it, for every plugin of it: same bytes, garments in and
// out, hostile input. Included after a plugin's scenes.h, which names the plugin.
#pragma once

#include "core/error.h"

#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

namespace toile::TOILE_CLOTH_PLUGIN::test {
namespace {

Stage draped() {
    return {sphere({0, 1, 0}, 0.2f),
            sheet({-0.3f, 1.22f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f}, 24, 24)};
}

std::vector<Vec3f> shifted(std::vector<Vec3f> points, const Vec3f& by) {
    for (Vec3f& p : points) {
        p += by;
    }
    return points;
}

bool same_bytes(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

TEST(World, SameInputSameBytes) {
    Stage first = draped();
    Stage second = draped();
    for (int i = 0; i < 20; ++i) {
        const std::vector<Vec3f> body = shifted(first.body_now, {0.01f, 0.0f, 0.003f});
        first.step_to(body);
        second.step_to(body);
        ASSERT_TRUE(same_bytes(first.positions, second.positions)) << "frame " << i;
        ASSERT_TRUE(same_bytes(first.normals, second.normals)) << "frame " << i;
    }
}

TEST(World, ResetForgetsTheHistory) {
    Stage moved = draped();
    Stage fresh = draped();
    for (int i = 0; i < 20; ++i) {
        moved.step_to(shifted(moved.body_now, {0.02f, 0.0f, 0.0f}));
    }
    moved.body_now = fresh.body_now;
    moved.begun = false;
    for (int i = 0; i < 5; ++i) {
        moved.step();
        fresh.step();
        ASSERT_TRUE(same_bytes(moved.positions, fresh.positions)) << "frame " << i;
    }
}

TEST(World, ANewBodyIsBoundAndBeginsAnew) {
    Stage stage = draped();
    stage.step();
    const Mesh bigger = sphere({0, 1, 0}, 0.21f);
    stage.world.set_body(bigger.body());
    stage.body_now = bigger.positions;
    for (int i = 0; i < 10; ++i) {
        ASSERT_EQ(stage.step(), StepResult::ok);
    }
    for (const Vec3f& p : stage.positions) {
        EXPECT_GT((p - Vec3f(0, 1, 0)).norm(), 0.208f);
    }
}

TEST(World, EveryBadStepHasItsOwnAnswerAndChangesNothing) {
    Stage stage = draped();
    stage.step();
    const std::vector<Vec3f> before = stage.positions;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto try_step = [&](const std::function<void(StepInput&, GarmentFrame&)>& spoil) {
        GarmentFrame frame{stage.handle, stage.targets, stage.positions, stage.normals};
        StepInput input{stage.body_now, stage.body_now, 1.0 / 30.0, false, std::span(&frame, 1)};
        spoil(input, frame);
        return stage.world.step(input);
    };
    std::vector<Vec3f> bad_body = stage.body_now;
    bad_body[7].y() = nan;
    std::vector<Vec3f> bad_targets = stage.targets;
    bad_targets[3].x() = std::numeric_limits<float>::infinity();
    std::set<StepResult> answers;
    const auto expect = [&](StepResult wanted, StepResult got) {
        EXPECT_EQ(wanted, got) << step_result_text(got);
        EXPECT_GT(std::strlen(step_result_text(got)), 10u);
        answers.insert(got);
    };
    expect(StepResult::body_values, try_step([&](auto& in, auto&) { in.body_after = bad_body; }));
    expect(StepResult::body_count,
           try_step([&](auto& in, auto&) { in.body_before = in.body_before.first(5); }));
    expect(StepResult::time, try_step([&](auto& in, auto&) { in.dt_s = 0.0; }));
    expect(StepResult::time, try_step([&](auto& in, auto&) { in.dt_s = 10.0; }));
    expect(StepResult::time, try_step([&](auto& in, auto&) { in.dt_s = nan; }));
    expect(StepResult::time, try_step([&](auto& in, auto&) { in.dt_s = -1.0; }));
    expect(StepResult::target_values, try_step([&](auto&, auto& f) { f.targets = bad_targets; }));
    expect(StepResult::target_count, try_step([&](auto&, auto& f) { f.targets = {}; }));
    expect(StepResult::output_count,
           try_step([&](auto&, auto& f) { f.normals = f.normals.first(1); }));
    expect(StepResult::unknown_garment, try_step([&](auto&, auto& f) { f.garment = 99; }));
    expect(StepResult::garment_count, try_step([&](auto& in, auto&) { in.garments = {}; }));
    EXPECT_EQ(answers.size(), 8u);
    EXPECT_TRUE(same_bytes(before, stage.positions));

    ClothWorld empty;
    EXPECT_EQ(empty.step({}), StepResult::no_body);

    // And it goes on as if nothing had been asked.
    Stage undisturbed = draped();
    undisturbed.step();
    undisturbed.step();
    stage.step();
    EXPECT_TRUE(same_bytes(undisturbed.positions, stage.positions));
}

/// What a garment or body with one fault is told; "" when it was taken.
template <class Spoil>
std::string refusal(const Spoil& spoil) {
    const Mesh body = sphere({0, 1, 0}, 0.2f);
    Mesh mesh = sheet({-0.1f, 1.3f, 0.1f}, {0.2f, 0, 0}, {0, 0, -0.2f}, 4, 4);
    std::vector<float> attachment(mesh.positions.size(), 0.0f);
    std::vector<std::array<std::uint32_t, 2>> seams{{0, 24}};
    Fabric fabric;
    spoil(mesh, attachment, seams, fabric);
    ClothWorld world;
    world.set_body(body.body());
    GarmentInput input;
    input.mesh = {mesh.positions, mesh.triangles, mesh.corner_coords, seams};
    input.fabric = fabric;
    input.joints = mesh.joints;
    input.weights = mesh.weights;
    input.attachment = attachment;
    try {
        world.add_garment(input);
    } catch (const Error& error) {
        EXPECT_EQ(world.garment_count(), 0u);
        return error.what();
    }
    return "";
}

TEST(World, EveryBadGarmentHasItsOwnRefusal) {
    using Seams = std::vector<std::array<std::uint32_t, 2>>;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    using Spoil = std::function<void(Mesh&, std::vector<float>&, Seams&, Fabric&)>;
    const std::vector<Spoil> faults{
        [&](Mesh& m, auto&, auto&, auto&) { m.positions[3].z() = nan; },
        [&](Mesh& m, auto&, auto&, auto&) { m.triangles[5][1] = 4000; },
        [&](Mesh& m, auto& a, auto&, auto&) {
            m = Mesh{};
            a.clear();
        },
        [&](Mesh& m, auto&, auto&, auto&) { m.corner_coords.pop_back(); },
        [&](Mesh& m, auto&, auto&, auto&) { m.corner_coords[7] = m.corner_coords[6]; },
        [&](Mesh& m, auto&, auto&, auto&) { m.corner_coords[7].x() = nan; },
        [&](Mesh& m, auto&, auto&, auto&) { m.joints.pop_back(); },
        [&](Mesh& m, auto&, auto&, auto&) { m.joints[4][0] = 77; },
        [&](Mesh& m, auto&, auto&, auto&) { m.weights[5][0] = nan; },
        [&](Mesh&, auto& a, auto&, auto&) { a.resize(3); },
        [&](Mesh&, auto& a, auto&, auto&) { a[1] = 1.5f; },
        [&](Mesh&, auto&, Seams& s, auto&) { s[0][1] = 4000; },
        [&](Mesh&, auto&, auto&, Fabric& f) { f.density = 0.0f; },
        [&](Mesh&, auto&, auto&, Fabric& f) { f.friction = -1.0f; },
    };
    EXPECT_EQ(refusal([](auto&&...) {}), "");
    std::set<std::string> texts;
    for (std::size_t i = 0; i < faults.size(); ++i) {
        const std::string text = refusal(faults[i]);
        EXPECT_GT(text.size(), 20u) << "fault " << i;
        EXPECT_THAT(text, testing::Not(testing::HasSubstr("\n")));
        texts.insert(text);
    }
    EXPECT_EQ(texts.size(), faults.size()); // each its own
}

TEST(World, BadBodiesAreRefusedAndTheOldOneStays) {
    Stage stage = draped();
    stage.step();
    Mesh body = stage.body;
    body.positions[0].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(stage.world.set_body(body.body()), Error);
    body = stage.body;
    body.triangles[0][0] = 1u << 30;
    EXPECT_THROW(stage.world.set_body(body.body()), Error);
    body = stage.body;
    body.weights.pop_back();
    EXPECT_THROW(stage.world.set_body(body.body()), Error);
    EXPECT_THROW(stage.world.set_body({}), Error);
    // No surface at the joints of the garment on it.
    body = stage.body;
    body.bind_to(20);
    EXPECT_THROW(stage.world.set_body(body.body()), Error);
    EXPECT_EQ(stage.step(), StepResult::ok);
}

TEST(World, ExtremesStayFinite) {
    Stage stage = draped();
    stage.step();
    std::vector<Vec3f> body = shifted(stage.body_now, {0.0f, 300.0f, 0.0f});
    EXPECT_NE(stage.step_to(body), StepResult::time);
    for (int i = 0; i < 3; ++i) {
        (void)stage.step_to(stage.body.positions, 1e-4);
        (void)stage.step(1.0);
    }
    for (const Vec3f& p : stage.positions) {
        ASSERT_TRUE(p.allFinite());
        ASSERT_LT((p - Vec3f(0, 1, 0)).norm(), 1.0f);
    }
}

} // namespace
} // namespace toile::TOILE_CLOTH_PLUGIN::test
