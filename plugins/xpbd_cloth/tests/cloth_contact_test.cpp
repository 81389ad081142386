// Cloth against cloth: what falls on a held sheet stays on it, layers keep their order, tangles
// mend.
#include "scenes.h"

#include <gtest/gtest.h>

namespace toile::xpbd_cloth::test {
namespace {

/// A small sheet above a larger one that is held along its rim; `gap` apart.
struct TwoSheets {
    Mesh lower = sheet({-0.2f, 1, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, 20, 20);
    Mesh upper;
    ClothWorld world;
    std::array<std::uint32_t, 2> handles{};
    std::vector<Vec3f> body, out[2], normals[2];
    bool begun = false;

    explicit TwoSheets(float gap, unsigned upper_layer = 0, const Settings& settings = free())
        : upper(sheet({-0.1f, 1.0f + gap, 0.1f}, {0.2f, 0, 0}, {0, 0, -0.2f}, 12, 12)),
          world(settings) {
        const Mesh far = far_away();
        body = far.positions;
        world.set_body(far.body());
        std::vector<float> rim(lower.positions.size(), 0.0f);
        for (std::size_t v = 0; v < rim.size(); ++v) {
            const Vec3f& p = lower.positions[v];
            rim[v] = std::max(std::abs(p.x()), std::abs(p.z())) > 0.199f ? 1.0f : 0.0f;
        }
        handles = {add(lower, rim, 0), add(upper, {}, upper_layer)};
        out[0] = normals[0] = lower.positions;
        out[1] = normals[1] = upper.positions;
    }
    static Settings free() {
        Settings settings;
        settings.leash = 5.0;
        return settings;
    }
    std::uint32_t add(const Mesh& mesh, std::span<const float> attachment, unsigned layer) {
        GarmentInput input;
        input.mesh = {mesh.positions, mesh.triangles, mesh.corner_coords, {}};
        input.joints = mesh.joints;
        input.weights = mesh.weights;
        input.attachment = attachment;
        input.layer = layer;
        return world.add_garment(input);
    }
    StepResult step() {
        const std::array<GarmentFrame, 2> frames{
            GarmentFrame{handles[0], lower.positions, out[0], normals[0]},
            GarmentFrame{handles[1], upper.positions, out[1], normals[1]}};
        const StepResult result = world.step({body, body, 1.0 / 60.0, !begun, frames});
        begun = true;
        return result;
    }
    /// Least height of the upper sheet's vertices over the lower one, found by its columns.
    [[nodiscard]] float least_gap() const {
        float least = 1e9f;
        for (const Vec3f& p : out[1]) {
            float beneath = -1e9f;
            float nearest = 1e9f;
            for (const Vec3f& q : out[0]) {
                const float beside = std::hypot(p.x() - q.x(), p.z() - q.z());
                if (beside < nearest) {
                    nearest = beside;
                    beneath = q.y();
                }
            }
            least = std::min(least, p.y() - beneath);
        }
        return least;
    }
};

TEST(ClothContact, WhatFallsOnAHeldSheetStaysOnIt) {
    TwoSheets sheets(0.02f);
    for (int i = 0; i < 120; ++i) {
        ASSERT_EQ(sheets.step(), StepResult::ok);
    }
    EXPECT_GT(sheets.least_gap(), -0.003f); // the column's place is half an edge away
}

TEST(ClothContact, WithoutItTheSheetFallsThrough) {
    Settings settings = TwoSheets::free();
    settings.self_contact = 0.0;
    TwoSheets sheets(0.02f, 0, settings);
    for (int i = 0; i < 60; ++i) {
        sheets.step();
    }
    EXPECT_LT(sheets.least_gap(), -0.5f);
}

TEST(ClothContact, AnOuterLayerThatBeginsBeneathComesOut) {
    TwoSheets sheets(-0.003f, 1);
    for (int i = 0; i < 120; ++i) {
        ASSERT_EQ(sheets.step(), StepResult::ok);
    }
    EXPECT_GT(sheets.least_gap(), -0.003f);
}

TEST(ClothContact, SameBytesEveryTime) {
    TwoSheets first(0.02f);
    TwoSheets second(0.02f);
    for (int i = 0; i < 40; ++i) {
        first.step();
        second.step();
        ASSERT_EQ(first.out[1], second.out[1]) << "frame " << i;
    }
}

} // namespace
} // namespace toile::xpbd_cloth::test
