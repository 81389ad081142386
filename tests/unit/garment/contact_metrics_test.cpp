// Contact metrics on shapes whose answers are known: spheres in spheres, bodies in bodies.
#include "garment/contact_metrics.h"

#include "core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace toile::garment {
namespace {

struct Surface {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;

    [[nodiscard]] ClothSurface cloth() const { return {positions, triangles}; }
};

/// Poles along y, outward; the polar angle runs from 0 to `until` (pi: closed).
Surface sphere(const Vec3f& centre, float radius, float until = std::numbers::pi_v<float>) {
    constexpr std::uint32_t kRings = 60;
    constexpr std::uint32_t kAround = 96;
    const bool closed = until > 3.14f;
    Surface made;
    made.positions.push_back(centre + Vec3f(0, radius, 0));
    const std::uint32_t rings = closed ? kRings - 1 : kRings;
    for (std::uint32_t r = 1; r <= rings; ++r) {
        for (std::uint32_t k = 0; k < kAround; ++k) {
            const float polar = until * float(r) / float(kRings);
            const float turn = 2.0f * std::numbers::pi_v<float> * float(k) / float(kAround);
            made.positions.push_back(centre + radius * Vec3f(std::sin(polar) * std::cos(turn),
                                                             std::cos(polar),
                                                             std::sin(polar) * std::sin(turn)));
        }
    }
    const auto at = [&](std::uint32_t r, std::uint32_t k) {
        return 1 + (r - 1) * kAround + k % kAround;
    };
    for (std::uint32_t k = 0; k < kAround; ++k) {
        made.triangles.push_back({0, at(1, k + 1), at(1, k)});
        for (std::uint32_t r = 1; r < rings; ++r) {
            made.triangles.push_back({at(r, k), at(r, k + 1), at(r + 1, k)});
            made.triangles.push_back({at(r, k + 1), at(r + 1, k + 1), at(r + 1, k)});
        }
    }
    if (closed) {
        made.positions.push_back(centre - Vec3f(0, radius, 0));
        const auto last = static_cast<std::uint32_t>(made.positions.size() - 1);
        for (std::uint32_t k = 0; k < kAround; ++k) {
            made.triangles.push_back({last, at(rings, k), at(rings, k + 1)});
        }
    }
    return made;
}

TEST(ContactMetrics, ClothOutsideIsCleanAndCoversAll) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface outer = sphere({0, 1, 0}, 0.21f);
    const ClothSurface garment = outer.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&garment, 1));
    EXPECT_EQ(metrics.covered().size(), body.positions.size());
    const ContactFigures figures = metrics.measure(body.positions, std::span(&garment, 1));
    EXPECT_EQ(figures.samples, outer.positions.size() + outer.triangles.size());
    EXPECT_EQ(figures.deep, 0u);
    EXPECT_EQ(figures.visible, 0u);
    EXPECT_EQ(figures.deep_apart + figures.visible_apart, 0u);
}

TEST(ContactMetrics, ClothInsideIsDeepAndShowsAllSkin) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface outer = sphere({0, 1, 0}, 0.21f);
    const Surface inner = sphere({0, 1, 0}, 0.19f);
    const ClothSurface rest = outer.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&rest, 1));
    const ClothSurface now = inner.cloth();
    const ContactFigures figures = metrics.measure(body.positions, std::span(&now, 1));
    EXPECT_EQ(figures.deep, figures.samples);
    EXPECT_NEAR(figures.deepest_m, 0.01f, 0.0005f);
    EXPECT_EQ(figures.visible, figures.covered);
    EXPECT_DOUBLE_EQ(figures.visible_fraction(), 1.0);
}

TEST(ContactMetrics, OneMillimetreInIsNotDeepButShowsSkin) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface outer = sphere({0, 1, 0}, 0.21f);
    const Surface inner = sphere({0, 1, 0}, 0.199f);
    const ClothSurface rest = outer.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&rest, 1));
    const ClothSurface now = inner.cloth();
    const ContactFigures figures = metrics.measure(body.positions, std::span(&now, 1));
    EXPECT_EQ(figures.deep, 0u);
    EXPECT_EQ(figures.visible, figures.covered);
}

// A shifted sphere is deep where the shift exceeds 2 mm + the gap: a cap of known share.
TEST(ContactMetrics, CountsTheShareThatIsDeep) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface outer = sphere({0, 1, 0}, 0.205f);
    const ClothSurface rest = outer.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&rest, 1));
    const float shift = 0.02f; // downwards: the top sinks in
    const Surface moved = sphere({0, 1 - shift, 0}, 0.205f);
    const ClothSurface now = moved.cloth();
    const ContactFigures figures = metrics.measure(body.positions, std::span(&now, 1));
    // Depth at polar angle a is about shift cos a - 5 mm; rings are uniform in a.
    const double expected = std::acos((0.002 + 0.005) / shift) / std::numbers::pi;
    EXPECT_NEAR(figures.deep_fraction(), expected, 0.02);
    EXPECT_NEAR(figures.deepest_m, shift - 0.005f, 0.0005f);
}

TEST(ContactMetrics, BareSkinBesideAHemIsNeitherCoveredNorVisible) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface cap = sphere({0, 1, 0}, 0.21f, 0.5f * std::numbers::pi_v<float>);
    const ClothSurface garment = cap.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&garment, 1));
    EXPECT_NEAR(double(metrics.covered().size()) / double(body.positions.size()), 0.5, 0.02);
    // The cap slides up and off: skin is bare, but not in front of the cloth.
    Surface lifted = cap;
    for (Vec3f& p : lifted.positions) {
        p.y() += 0.08f;
    }
    const ClothSurface now = lifted.cloth();
    const ContactFigures figures = metrics.measure(body.positions, std::span(&now, 1));
    EXPECT_EQ(figures.visible, 0u);
    EXPECT_EQ(figures.deep, 0u);
}

TEST(ContactMetrics, WhereTheBodyRunsIntoItselfIsCountedApart) {
    Surface body = sphere({0, 1, 0}, 0.2f);
    const Surface arm = sphere({0.22f, 1, 0}, 0.05f);
    const auto base = static_cast<std::uint32_t>(body.positions.size());
    for (const Triangle& t : arm.triangles) {
        body.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
    body.positions.insert(body.positions.end(), arm.positions.begin(), arm.positions.end());
    const Surface sleeve = sphere({0.22f, 1, 0}, 0.056f);
    const ClothSurface garment = sleeve.cloth();
    ContactMetrics metrics(body.positions, body.triangles, std::span(&garment, 1));
    const ContactFigures figures = metrics.measure(body.positions, std::span(&garment, 1));
    EXPECT_EQ(figures.deep, 0u);
    EXPECT_GT(figures.deep_apart, 100u); // the rest lies nearer to the arm, outside of it
    // The same sleeve sunk into the trunk where no arm is: deep.
    ContactMetrics alone(
        std::span(body.positions).first(base),
        std::span(body.triangles).first(body.triangles.size() - arm.triangles.size()),
        std::span(&garment, 1));
    const ContactFigures sunk =
        alone.measure(std::span(body.positions).first(base), std::span(&garment, 1));
    EXPECT_GT(sunk.deep, sunk.samples / 6);
    EXPECT_EQ(sunk.deep_apart, 0u);
}

TEST(ContactMetrics, CountsMustMatch) {
    const Surface body = sphere({0, 1, 0}, 0.2f);
    const ClothSurface none{};
    ContactMetrics metrics(body.positions, body.triangles, std::span(&none, 1));
    EXPECT_EQ(metrics.measure(body.positions, std::span(&none, 1)).samples, 0u);
    EXPECT_THROW((void)metrics.measure(std::span(body.positions).first(3), std::span(&none, 1)),
                 Error);
}

} // namespace
} // namespace toile::garment
