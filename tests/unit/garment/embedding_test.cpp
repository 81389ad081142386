#include "garment/embedding.h"

#include "support/garments.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

struct Posed {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;
};

Posed evaluate(const SurfaceEmbedding& embedding, const GarmentSize& size,
               const std::vector<Vec3f>& simulation) {
    std::vector<Vec3f> normals(simulation.size());
    geometry::vertex_normals(simulation, size.simulation.triangles, normals);
    auto scratch = embedding.make_scratch();
    const std::size_t n = embedding.parts()[0].welded.size();
    Posed out{std::vector<Vec3f>(n), std::vector<Vec3f>(n)};
    embedding.evaluate(0, simulation, normals, scratch, out.positions, out.normals);
    return out;
}

TEST(Embedding, IsExactAtRest) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    ASSERT_EQ(embedding.parts().size(), 1u);
    EXPECT_NEAR(embedding.parts()[0].max_distance, 0.001, 2e-4);
    const Posed posed = evaluate(embedding, size, size.simulation.positions);
    const auto& rest = size.render.meshes[0].primitives[0];
    for (std::size_t i = 0; i < rest.positions.size(); ++i) {
        EXPECT_LT((posed.positions[i] - rest.positions[i]).norm(), 1e-6f);
        EXPECT_GT(posed.normals[i].dot(rest.normals[i]), 0.99f);
    }
}

TEST(Embedding, MovesRigidlyWithTheCloth) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    const RigidTransform move{Quatf(Eigen::AngleAxisf(0.8f, Vec3f(1, 2, 3).normalized())),
                              Vec3f(0.3f, -0.2f, 1.0f)};
    std::vector<Vec3f> moved;
    for (const Vec3f& p : size.simulation.positions)
        moved.push_back(move * p);
    const Posed posed = evaluate(embedding, size, moved);
    const auto& rest = size.render.meshes[0].primitives[0];
    for (std::size_t i = 0; i < rest.positions.size(); ++i)
        EXPECT_LT((posed.positions[i] - move * rest.positions[i]).norm(), 2e-6f);
}

TEST(Embedding, KeepsItsSideWhenTheClothWidens) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    std::vector<Vec3f> wide = size.simulation.positions;
    for (Vec3f& p : wide)
        p = Vec3f(2.0f * p.x(), p.y(), 2.0f * p.z());
    const Posed posed = evaluate(embedding, size, wide);
    for (const Vec3f& p : posed.positions) // the offset keeps its 1 mm
        EXPECT_NEAR(std::hypot(p.x(), p.z()), 0.401f, 2e-4f);
}

TEST(Embedding, SpreadsALinearQuantityExactly) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    std::vector<float> height, spread(embedding.parts()[0].welded.size());
    for (const Vec3f& p : size.simulation.positions)
        height.push_back(p.y());
    embedding.spread(0, height, spread);
    const auto& rest = size.render.meshes[0].primitives[0];
    for (std::size_t i = 0; i < spread.size(); ++i)
        EXPECT_NEAR(spread[i], rest.positions[i].y(), 1e-5f);
}

TEST(Embedding, LeavesOutWhatHangsOnHiddenTrianglesOnly) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    const auto& rest = size.render.meshes[0].primitives[0];
    EXPECT_EQ(embedding.uncovered(0, rest.triangles, {}).size(), rest.triangles.size());
    std::vector<std::uint8_t> hidden;
    for (const Triangle& t : size.simulation.triangles) // all of the upper half
        hidden.push_back(std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
            return size.simulation.positions[v].y() > 0.74f;
        }));
    const auto drawn = embedding.uncovered(0, rest.triangles, hidden);
    EXPECT_LT(drawn.size(), rest.triangles.size());
    EXPECT_GE(drawn.size(), rest.triangles.size() / 2);
    for (const Triangle& t : drawn) {
        float low = 2.0f;
        for (const std::uint32_t v : t)
            low = std::min(low, rest.positions[v].y());
        EXPECT_LT(low, 0.76f);
    }
    std::fill(hidden.begin(), hidden.end(), std::uint8_t{1});
    EXPECT_TRUE(embedding.uncovered(0, rest.triangles, hidden).empty());
}

TEST(Embedding, SeamsStayClosed) {
    const GarmentSize size = test::tube_size("M", 0.2f, 0.5f, 1.0f);
    const SurfaceEmbedding embedding(size);
    const Posed posed = evaluate(embedding, size, size.simulation.positions);
    for (std::size_t j = 0; j <= 8; ++j) {
        EXPECT_EQ(posed.positions[j * 25], posed.positions[j * 25 + 24]);
        EXPECT_EQ(posed.normals[j * 25], posed.normals[j * 25 + 24]);
    }
}

} // namespace
} // namespace toile::garment
