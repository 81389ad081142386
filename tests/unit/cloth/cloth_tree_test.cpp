// The tree of boxes against the plain search over all pairs.
#include "cloth/cloth_tree.h"

#include "core/random.h"

#include <gtest/gtest.h>

namespace toile::cloth {
namespace {

constexpr std::uint32_t kNobody = ClothTree::kNobody;

struct Scene {
    std::vector<ClothTree::Vertex> vertices;
    std::vector<Vec4f> now;
};

/// A sheet of `across` x `rows` vertices 1 cm apart.
void add_sheet(Scene& scene, std::uint32_t part, std::uint32_t across, std::uint32_t rows,
               float height) {
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < across; ++i) {
            const Vec4f at(0.01f * float(i), height, 0.01f * float(j), 0.0f);
            scene.vertices.push_back({at, 0.04f, part});
            scene.now.push_back(at);
        }
    }
}

/// By the definition of ClothTree::find.
std::vector<std::uint32_t> plain_search(const Scene& scene, float radius) {
    std::vector<std::uint32_t> nearest(scene.now.size(), kNobody);
    for (std::uint32_t a = 0; a < scene.now.size(); ++a) {
        float least = radius * radius;
        for (std::uint32_t b = 0; b < scene.now.size(); ++b) {
            const ClothTree::Vertex& p = scene.vertices[a];
            const ClothTree::Vertex& q = scene.vertices[b];
            const bool same =
                p.part == q.part && (p.start - q.start).squaredNorm() < p.apart * p.apart;
            const float squared = (scene.now[a] - scene.now[b]).squaredNorm();
            if (p.part != kNobody && q.part != kNobody && !same && squared < least) {
                least = squared;
                nearest[a] = b;
            }
        }
    }
    return nearest;
}

void expect_as_plain_search(const Scene& scene, float radius) {
    ClothTree tree;
    tree.arrange(scene.vertices);
    std::vector<std::uint32_t> found(scene.now.size());
    tree.find(scene.now, radius, found);
    const std::vector<std::uint32_t> expected = plain_search(scene, radius);
    std::size_t pairs = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        pairs += expected[v] == kNobody ? 0 : 1;
        if (found[v] == expected[v]) {
            continue;
        }
        // Sums in another order may take the other of two that are equally near.
        ASSERT_NE(found[v], kNobody) << "vertex " << v << " missed " << expected[v];
        ASSERT_NE(expected[v], kNobody) << "vertex " << v << " found " << found[v];
        EXPECT_NEAR((scene.now[v] - scene.now[found[v]]).norm(),
                    (scene.now[v] - scene.now[expected[v]]).norm(), 1e-6f);
    }
    EXPECT_GT(pairs, 0u) << "the scene tells nothing";
}

TEST(ClothTree, FindsWhatThePlainSearchFindsInACrumpledSheet) {
    Random random(7);
    for (int trial = 0; trial < 10; ++trial) {
        Scene scene;
        add_sheet(scene, 0, 30, 20, 0.0f);
        for (Vec4f& p : scene.now) { // thrown into a box of 12 cm
            p = Vec4f(0.12f * float(random.uniform()), 0.12f * float(random.uniform()),
                      0.12f * float(random.uniform()), 0.0f);
        }
        expect_as_plain_search(scene, 0.02f);
    }
}

TEST(ClothTree, FindsTheFoldOfASheetAndLeavesItsNeighboursOut) {
    Scene scene;
    add_sheet(scene, 0, 25, 41, 0.0f);
    for (Vec4f& p : scene.now) { // folded over at the middle, 6 mm above itself
        if (p.z() > 0.2f) {
            p = Vec4f(p.x() + 0.003f, 0.006f, 0.4f - p.z(), 0.0f);
        }
    }
    expect_as_plain_search(scene, 0.015f);
}

TEST(ClothTree, TellsPartsApartAndLeavesFillingOut) {
    Scene scene;
    add_sheet(scene, 0, 17, 13, 0.0f);
    scene.vertices.push_back({}); // the empty row between two garments
    scene.now.emplace_back(Vec4f::Zero());
    add_sheet(scene, 1, 17, 13, 0.004f);
    scene.vertices.push_back({});
    scene.now.emplace_back(Vec4f::Zero());
    expect_as_plain_search(scene, 0.015f);
}

} // namespace
} // namespace toile::cloth
