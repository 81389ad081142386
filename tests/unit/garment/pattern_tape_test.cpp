// Tubes of known girth around cylinders, worn wide, stretched, folded and open.
#include "garment/pattern_tape.h"

#include "support/garments.h"
#include "support/meshes.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::garment {
namespace {

constexpr int kAround = 48;

/// Perimeter of the tube's 48 sides.
double girth_of(double radius) {
    return 2.0 * kAround * radius * std::sin(std::numbers::pi / kAround);
}

/// A closed part of a body around x = `x`, from y = 0 to 1.2, and a tape on it.
struct Limb {
    geometry::TriangleMesh mesh;
    explicit Limb(float radius, float x = 0.0f) : mesh(test::sphere(1.0f, 4)) {
        for (Vec3f& p : mesh.positions) {
            // Sphere to cylinder with rounded ends: straight between y = 0.2 and 1.
            const Vec2f flat = Vec2f(p.x(), p.z());
            const float out = flat.norm() > 0.0f ? std::min(1.0f, 2.0f * flat.norm()) : 0.0f;
            const Vec2f ring = out * flat.normalized();
            p = Vec3f(x + radius * (flat.norm() > 0.0f ? ring.x() : 0.0f), 0.6f + 0.6f * p.y(),
                      radius * (flat.norm() > 0.0f ? ring.y() : 0.0f));
        }
    }
    [[nodiscard]] body::Reading tape(float height) const {
        body::Reading out;
        out.cut = geometry::Plane{Vec3f::UnitY(), height};
        auto loops = geometry::slice(mesh.positions, mesh.triangles, *out.cut);
        out.value_m = loops.front().length();
        out.tapes = std::move(loops);
        return out;
    }
    [[nodiscard]] ClothSurface surface() const { return {mesh.positions, mesh.triangles}; }
};

std::optional<double> girth(const Limb& limb, const GarmentSize& size,
                            const std::vector<Vec3f>& worn, float height, float reach_m = 0.0f) {
    const auto tape =
        lay_around(limb.tape(height), limb.surface(), {worn, size.simulation.triangles},
                   size.material_coords, {reach_m});
    if (!tape) return std::nullopt;
    return tape->flat_length(size.material_coords);
}

TEST(PatternTape, ATubeAroundACylinderHasItsOwnGirth) {
    const Limb limb(0.15f);
    const auto size = test::tube_size("M", 0.17f, 0.4f, 0.8f, kAround, 20);
    const auto found = girth(limb, size, size.simulation.positions, 0.6f);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, girth_of(0.17), 1e-5);
}

TEST(PatternTape, StretchAndFoldsDoNotChangeIt) {
    const Limb limb(0.15f);
    const auto size = test::tube_size("M", 0.14f, 0.4f, 0.8f, kAround, 20);
    std::vector<Vec3f> stretched = size.simulation.positions, wavy = stretched;
    for (Vec3f& p : stretched)
        p = Vec3f(p.x() * 1.1f, p.y(), p.z() * 1.1f);
    for (Vec3f& p : wavy) { // flutes that run down
        const float angle = std::atan2(p.x(), p.z());
        const float out = 1.2f + 0.08f * std::sin(9.0f * angle);
        p = Vec3f(p.x() * out, p.y(), p.z() * out);
    }
    EXPECT_NEAR(girth(limb, size, stretched, 0.6f).value(), girth_of(0.14), 1e-5);
    EXPECT_NEAR(girth(limb, size, wavy, 0.6f).value(), girth_of(0.14), 1e-5);
}

TEST(PatternTape, OtherSizesAreMeasuredAlongTheSameWay) {
    const Limb limb(0.15f);
    const auto medium = test::tube_size("M", 0.17f, 0.4f, 0.8f, kAround, 20);
    const auto large = test::tube_size("L", 0.19f, 0.4f, 0.8f, kAround, 20);
    const auto tape = lay_around(limb.tape(0.6f), limb.surface(),
                                 {medium.simulation.positions, medium.simulation.triangles},
                                 medium.material_coords);
    ASSERT_TRUE(tape);
    EXPECT_NEAR(tape->flat_length(large.material_coords), girth_of(0.19), 1e-5);
}

TEST(PatternTape, BeyondTheHemThereIsNoneUnlessItMayMove) {
    const Limb limb(0.15f);
    const auto size = test::tube_size("M", 0.17f, 0.4f, 0.8f, kAround, 20);
    EXPECT_FALSE(girth(limb, size, size.simulation.positions, 0.35f));
    EXPECT_FALSE(girth(limb, size, size.simulation.positions, 0.35f, 0.03f));
    const auto moved = girth(limb, size, size.simulation.positions, 0.35f, 0.06f);
    ASSERT_TRUE(moved);
    EXPECT_NEAR(*moved, girth_of(0.17), 1e-5);
}

TEST(PatternTape, ASkirtAroundBothLegsIsNoThighsGirth) {
    Limb legs(0.08f, 0.1f);
    const Limb left(0.08f, -0.1f);
    const body::Reading right = legs.tape(0.6f);
    const auto base = static_cast<std::uint32_t>(legs.mesh.positions.size());
    legs.mesh.positions.insert(legs.mesh.positions.end(), left.mesh.positions.begin(),
                               left.mesh.positions.end());
    for (const Triangle& t : left.mesh.triangles)
        legs.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    const auto skirt = test::tube_size("M", 0.25f, 0.4f, 0.8f, kAround, 20);
    EXPECT_FALSE(lay_around(right, legs.surface(),
                            {skirt.simulation.positions, skirt.simulation.triangles},
                            skirt.material_coords, {0.1f}));
    auto trouser = test::tube_size("M", 0.09f, 0.4f, 0.8f, kAround, 20);
    for (Vec3f& p : trouser.simulation.positions)
        p.x() += 0.1f;
    const auto leg = lay_around(right, legs.surface(),
                                {trouser.simulation.positions, trouser.simulation.triangles},
                                trouser.material_coords);
    ASSERT_TRUE(leg);
    EXPECT_NEAR(leg->flat_length(trouser.material_coords), girth_of(0.09), 1e-5);
}

TEST(PatternTape, AnOpenFrontIsMeasuredFromEdgeToEdge) {
    const Limb limb(0.15f);
    auto size = test::tube_size("M", 0.17f, 0.4f, 0.8f, kAround, 20);
    // Two of 48 strips are left out.
    std::vector<Triangle> kept;
    std::vector<Vec2f> coords;
    for (std::size_t i = 0; i < size.simulation.triangles.size(); ++i) {
        if (i / 2 % kAround < 2) continue;
        kept.push_back(size.simulation.triangles[i]);
        for (std::size_t k = 0; k < 3; ++k)
            coords.push_back(size.material_coords[3 * i + k]);
    }
    const auto tape =
        lay_around(limb.tape(0.6f), limb.surface(), {size.simulation.positions, kept}, coords);
    ASSERT_TRUE(tape);
    EXPECT_TRUE(tape->open);
    EXPECT_FALSE(lay_around(limb.tape(0.6f), limb.surface(), {size.simulation.positions, kept},
                            coords, {0.0f, false}))
        << "a limb's must be closed";
    EXPECT_NEAR(tape->flat_length(coords), girth_of(0.17) * 46 / 48, 1e-5);
}

} // namespace
} // namespace toile::garment
