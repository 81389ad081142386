// A garment made anew for another body: what its flat pattern must become.
#include "garment/alter.h"
#include "garment/flatten.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace toile::garment {
namespace {

constexpr int kAround = 48, kUp = 16;
constexpr float kRadius = 0.15f, kHeight = 0.3f;

Vec3f on_tube(int i, int j, float radius, float height) {
    const float angle = 2.0f * std::numbers::pi_v<float> * float(i % kAround) / kAround;
    return {radius * std::sin(angle), height * float(j) / kUp, radius * std::cos(angle)};
}

/// A tube around the y axis, cut open at i = 0; material coordinates of a flat sheet.
GarmentSize tube() {
    GarmentSize size;
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i < kAround; ++i)
            size.simulation.positions.push_back(on_tube(i, j, kRadius, kHeight));
    const float chord = 2.0f * kRadius * std::sin(std::numbers::pi_v<float> / kAround);
    const auto vertex = [](int i, int j) { return std::uint32_t(j * kAround + i % kAround); };
    const auto flat = [&](int i, int j) {
        return Vec2f(chord * float(i), kHeight * float(j) / kUp);
    };
    const auto add = [&](std::array<std::pair<int, int>, 3> corners) {
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k) {
            t[k] = vertex(corners[k].first, corners[k].second);
            size.material_coords.push_back(flat(corners[k].first, corners[k].second));
        }
        size.simulation.triangles.push_back(t);
    };
    for (int j = 0; j < kUp; ++j)
        for (int i = 0; i < kAround; ++i) {
            add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
            add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
        }
    return size;
}

std::vector<Vec3f> carried(float girth, float height) {
    std::vector<Vec3f> out;
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i < kAround; ++i)
            out.push_back(on_tube(i, j, girth * kRadius, height * kHeight));
    return out;
}

Vec2f extent(const std::vector<Vec2f>& coords) {
    Vec2f low = coords.front(), high = coords.front();
    for (const Vec2f& c : coords) {
        low = low.cwiseMin(c);
        high = high.cwiseMax(c);
    }
    return high - low;
}

TEST(Alter, WhatIsNotMovedKeepsItsPattern) {
    const GarmentSize size = tube();
    const auto flat =
        flatten_carried(size.simulation, size.material_coords, size.simulation.positions);
    for (std::size_t i = 0; i < flat.size(); ++i)
        EXPECT_LT((flat[i] - size.material_coords[i]).norm(), 2e-6f);
}

TEST(Alter, AWiderAndLongerTubeIsCutWiderAndLonger) {
    const GarmentSize size = tube();
    const auto flat = flatten_carried(size.simulation, size.material_coords, carried(1.2f, 0.9f));
    const Vec2f before = extent(size.material_coords), after = extent(flat);
    EXPECT_NEAR(after.x() / before.x(), 1.2f, 1e-4f);
    EXPECT_NEAR(after.y() / before.y(), 0.9f, 1e-4f);
    // Grain and place stay: equal up to the stretch about the middle.
    const Vec2f middle(0.5f * before.x(), 0.5f * before.y());
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Vec2f expected =
            middle + Vec2f(1.2f, 0.9f).cwiseProduct(size.material_coords[i] - middle);
        EXPECT_LT((flat[i] - expected).norm(), 2e-4f);
    }
}

TEST(Alter, TurningTheWholeGarmentChangesNothing) {
    const GarmentSize size = tube();
    std::vector<Vec3f> turned = size.simulation.positions;
    const Quatf turn(Eigen::AngleAxisf(1.1f, Vec3f(1, 2, -1).normalized()));
    for (Vec3f& p : turned)
        p = turn * p + Vec3f(0.3f, 0.1f, -0.2f);
    const auto flat = flatten_carried(size.simulation, size.material_coords, turned);
    for (std::size_t i = 0; i < flat.size(); ++i)
        EXPECT_LT((flat[i] - size.material_coords[i]).norm(), 1e-5f);
}

TEST(Alter, AFoldIsNotCutIntoTheCloth) {
    const GarmentSize size = tube();
    std::vector<Vec3f> places = size.simulation.positions;
    places[8 * kAround + 10] *= 0.97f; // one vertex pushed in by 4 mm
    const auto flat = flatten_carried(size.simulation, size.material_coords, places);
    for (std::size_t i = 0; i < flat.size(); ++i)
        EXPECT_LT((flat[i] - size.material_coords[i]).norm(), 1.5e-3f);
}

TEST(Alter, APackageIsMadeForTheOtherBody) {
    GarmentPackage package;
    package.manifest.id = "tube";
    package.manifest.name = "Tube";
    package.sizes.push_back(tube());
    package.sizes[0].entry.chart["waist_girth"] = {0.80, 0.88};
    package.sizes[0].entry.chart["neck_girth"] = {0.3, 0.4};
    AlterOptions options;
    options.id = "annas-tube";
    options.measurements["waist_girth"] = 1.0;
    const Alteration out = alter(package, package.sizes[0], carried(1.25f, 1.0f), options);
    EXPECT_NEAR(out.mean_weft, 1.25, 1e-4);
    EXPECT_NEAR(out.mean_warp, 1.0, 1e-4);
    ASSERT_EQ(out.package.sizes.size(), 1u);
    const SizeEntry& entry = out.package.sizes[0].entry;
    ASSERT_EQ(entry.chart.size(), 1u) << "nothing is said of what was not measured";
    EXPECT_NEAR(entry.chart.at("waist_girth").minimum, 0.96, 1e-9);
    EXPECT_NEAR(entry.chart.at("waist_girth").maximum, 1.04, 1e-9);
    EXPECT_EQ(out.package.manifest.name, "Tube");
    EXPECT_THROW((void)alter(package, package.sizes[0], {}, options), Error);
}

TEST(Alter, ATriangleWithoutAreaIsRefused) {
    GarmentSize size = tube();
    size.simulation.positions[0] = size.simulation.positions[1];
    EXPECT_THROW(
        (void)flatten_carried(size.simulation, size.material_coords, size.simulation.positions),
        Error);
}

} // namespace
} // namespace toile::garment
