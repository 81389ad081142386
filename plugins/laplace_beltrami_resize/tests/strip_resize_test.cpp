// The abdomen by strips: girths, and that no number of strips leaves gaps, steps or folds.
#include "laplace_beltrami_resize/strip_resize.h"

#include "bodies.h"
#include "laplace_beltrami_resize/trunk.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <iostream>

namespace toile::laplace_beltrami_resize {
namespace {

constexpr double kGirth_m = 0.015;

struct Pair {
    geometry::TriangleMesh mannequin, customer, resized;
    std::vector<float> region, target_region;

    Pair(std::uint64_t from, std::uint64_t to, std::uint32_t strips)
        : mannequin(person(from)), customer(person(to)), resized(mannequin),
          region(abdomen_region(mannequin)), target_region(abdomen_region(customer)) {
        resized.positions = resize_strips(mannequin, region, customer, target_region, strips);
    }
    /// Of the resized abdomen minus the customer's, at the middles of 40 strips, metres.
    [[nodiscard]] std::vector<double> girth_errors() const {
        const Trunk had(mannequin, region), has(resized, region), wanted(customer, target_region);
        std::vector<double> out;
        for (int i = 0; i < 40; ++i) {
            const float at = (static_cast<float>(i) + 0.5f) / 40.0f;
            out.push_back(has.girth(had.low() + at * (had.high() - had.low())) -
                          wanted.girth(wanted.low() + at * (wanted.high() - wanted.low())));
        }
        return out;
    }
};

Vec3f cross_of(const geometry::TriangleMesh& mesh, const Triangle& t) {
    return (mesh.positions[t[1]] - mesh.positions[t[0]])
        .cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
}

/// Triangles that face the other way after the change.
std::size_t flipped(const geometry::TriangleMesh& before, const geometry::TriangleMesh& after) {
    std::size_t out = 0;
    for (const Triangle& t : before.triangles)
        out += cross_of(before, t).dot(cross_of(after, t)) <= 0.0f ? 1 : 0;
    return out;
}

/// Largest change of an edge, as a share of its length.
double largest_stretch(const geometry::TriangleMesh& before, const geometry::TriangleMesh& after) {
    double out = 0.0;
    for (const Triangle& t : before.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            const Vec3f jump = (after.positions[a] - before.positions[a]) -
                               (after.positions[b] - before.positions[b]);
            out = std::max(out,
                           static_cast<double>(jump.norm() /
                                               (before.positions[a] - before.positions[b]).norm()));
        }
    return out;
}

TEST(StripResize, TheAbdomenGetsTheCustomersGirths) {
    double worst_mean = 0.0, worst = 0.0;
    for (std::uint64_t customer = 1; customer <= 8; ++customer) {
        const Pair pair(0, customer, kStrips);
        double sum = 0.0;
        for (const double off : pair.girth_errors()) {
            sum += std::abs(off);
            worst = std::max(worst, std::abs(off));
        }
        worst_mean = std::max(worst_mean, sum / 40.0);
        EXPECT_LT(worst, kGirth_m) << "customer " << customer;
    }
    std::cout << "girths, 8 customers, 40 strips: mean at most " << 1000.0 * worst_mean
              << " mm off, single strips " << 1000.0 * worst << " mm\n";
}

TEST(StripResize, NoNumberOfStripsLeavesGapsOrFolds) {
    for (const std::uint32_t strips : {1u, 3u, 10u, 40u, 200u}) {
        double stretch = 0.0;
        for (const std::uint64_t customer : {2u, 3u, 5u}) {
            const Pair pair(0, customer, strips);
            EXPECT_EQ(flipped(pair.mannequin, pair.resized), 0u) << strips << " strips";
            stretch = std::max(stretch, largest_stretch(pair.mannequin, pair.resized));
        }
        // A step would show as an edge that is torn: vertices of one edge moving apart.
        EXPECT_LT(stretch, 1.0) << strips << " strips";
        std::cout << strips << " strips: an edge changes by at most " << 100.0 * stretch << " %\n";
    }
}

TEST(StripResize, HandsFeetAndHeadStay) {
    const Pair pair(0, 2, kStrips);
    const Trunk trunk(pair.mannequin, pair.region);
    for (std::size_t v = 0; v < pair.region.size(); ++v) {
        const Vec3f& p = pair.mannequin.positions[v];
        EXPECT_EQ(pair.resized.positions[v].y(), p.y());
        if (p.y() > trunk.high() + 0.2f || p.y() < trunk.low() - 0.2f) {
            EXPECT_EQ(pair.resized.positions[v], p);
        }
    }
}

TEST(StripResize, ItselfIsAFixedPoint) {
    const Pair pair(3, 3, kStrips);
    for (std::size_t v = 0; v < pair.region.size(); ++v)
        EXPECT_LT((pair.resized.positions[v] - pair.mannequin.positions[v]).norm(), 1e-4f);
}

TEST(StripResize, WhatCannotBeResizedIsRefused) {
    const auto mesh = person(0);
    const std::vector<float> none(mesh.positions.size(), 0.0f);
    const std::vector<float> all(mesh.positions.size(), 1.0f);
    EXPECT_ERROR((void)resize_strips(mesh, none, mesh, all), "empty");
    EXPECT_ERROR((void)resize_strips(mesh, all, mesh, all, 0), "strips");
    EXPECT_ERROR((void)resize_strips(mesh, all, mesh, all, 5000), "strips");
}

} // namespace
} // namespace toile::laplace_beltrami_resize
