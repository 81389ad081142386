// Surface caches: what is written is read back, and what is damaged is named.
#include "body/surface_cache.h"
#include "core/bytes.h"
#include "support/meshes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <limits>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

assets::Scene two_boxes() {
    assets::Scene scene;
    for (const char* name : {"skin", "coat"}) {
        const float size = scene.meshes.empty() ? 0.5f : 0.7f;
        const auto box = test::box(Vec3f::Constant(-size), Vec3f::Constant(size));
        assets::Primitive primitive;
        primitive.positions = box.positions;
        primitive.triangles = box.triangles;
        assets::Node node;
        node.name = name;
        node.mesh = static_cast<int>(scene.meshes.size());
        scene.nodes.push_back(node);
        scene.meshes.push_back({name, {primitive}, {}});
    }
    return scene;
}

const std::vector<SurfaceRole> kRoles = {SurfaceRole::body, SurfaceRole::garment};

/// Two frames; the second one is 10 cm higher.
void write_cache(const fs::path& folder) {
    const assets::Scene scene = two_boxes();
    SurfaceCacheWriter writer(folder, scene, kRoles);
    TrackedPerson person;
    person.id = 7;
    person.state = TrackState::tracked;
    for (int frame = 0; frame < 2; ++frame) {
        person.joints[3].translation = Vec3f(0.0f, 0.1f * static_cast<float>(frame), 0.0f);
        person.confidence[3] = 0.5f;
        std::vector<std::vector<Vec3f>> moved;
        std::vector<std::span<const Vec3f>> views;
        for (const assets::Mesh& mesh : scene.meshes) {
            moved.push_back(mesh.primitives[0].positions);
            for (Vec3f& p : moved.back())
                p.y() += 0.1f * static_cast<float>(frame);
        }
        for (const auto& positions : moved)
            views.emplace_back(positions);
        writer.add(frame / 25.0, std::span(&person, 1), views);
    }
    EXPECT_EQ(writer.frame_count(), 2u);
}

TEST(SurfaceCache, IsReadBackAsItWasWritten) {
    const test::TemporaryFolder folder;
    write_cache(folder / "cache");
    const SurfaceCache cache = open_surface_cache(folder / "cache");
    ASSERT_EQ(cache.surfaces.size(), 2u);
    EXPECT_EQ(cache.surfaces[0].name, "skin");
    EXPECT_EQ(cache.surfaces[0].role, SurfaceRole::body);
    EXPECT_EQ(cache.surfaces[1].role, SurfaceRole::garment);
    ASSERT_EQ(cache.frames.size(), 2u);
    EXPECT_DOUBLE_EQ(cache.frames[1].time_s, 0.04);
    ASSERT_EQ(cache.frames[1].people.size(), 1u);
    EXPECT_EQ(cache.frames[1].people[0].id, 7u);
    EXPECT_FLOAT_EQ(cache.frames[1].people[0].joints[3].translation.y(), 0.1f);
    EXPECT_FLOAT_EQ(cache.frames[1].people[0].confidence[3], 0.5f);
    const assets::Scene scene = two_boxes();
    std::vector<std::vector<Vec3f>> positions;
    for (const std::size_t frame : {1u, 0u}) {
        cache.load(frame, positions);
        for (std::size_t s = 0; s < 2; ++s)
            for (std::size_t v = 0; v < positions[s].size(); ++v) {
                Vec3f expected = scene.meshes[s].primitives[0].positions[v];
                expected.y() += 0.1f * static_cast<float>(frame);
                EXPECT_EQ(positions[s][v], expected);
            }
    }
}

TEST(SurfaceCache, WrongCallsAreRefused) {
    const test::TemporaryFolder folder;
    write_cache(folder / "cache");
    EXPECT_ERROR(SurfaceCacheWriter(folder / "cache", two_boxes(), kRoles), "already holds");
    EXPECT_ERROR(SurfaceCacheWriter(folder / "new", two_boxes(), {SurfaceRole::body}), "role");
    const assets::Scene scene = two_boxes();
    SurfaceCacheWriter writer(folder / "other", scene, kRoles);
    const std::vector<Vec3f> few(3, Vec3f::Zero());
    const std::array<std::span<const Vec3f>, 2> views = {few, few};
    EXPECT_ERROR(writer.add(0.0, {}, views), "changed its vertices");
    EXPECT_ERROR(writer.add(std::numeric_limits<double>::quiet_NaN(), {}, views), "time");
}

TEST(SurfaceCache, DamageIsNamed) {
    const test::TemporaryFolder folder;
    const fs::path cache = folder / "cache";
    write_cache(cache);
    EXPECT_ERROR((void)open_surface_cache(folder.path()), "no surface cache");

    std::vector<std::vector<Vec3f>> positions;
    const SurfaceCache open = open_surface_cache(cache);
    fs::resize_file(cache / "frames" / "000001.f32", 100);
    EXPECT_ERROR(open.load(1, positions), "000001.f32");
    fs::remove(cache / "frames" / "000001.f32");
    EXPECT_ERROR(open.load(1, positions), "000001.f32");
    std::vector<float> numbers(3 * 16, 0.0f);
    numbers[5] = std::numeric_limits<float>::infinity();
    write_bytes(cache / "frames" / "000001.f32",
                {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * 4});
    EXPECT_ERROR(open.load(1, positions), "not finite");

    write_text(cache / "track.jsonl", "");
    EXPECT_ERROR((void)open_surface_cache(cache), "no frames");
    write_text(cache / "cache.json",
               R"({"schema": 1, "surfaces": [{"name": "a", "role": "hat"}]})");
    EXPECT_ERROR((void)open_surface_cache(cache), "hat");
    write_text(cache / "cache.json", R"({"schema": 1, "surfaces": []})");
    EXPECT_ERROR((void)open_surface_cache(cache), "surfaces");
}

} // namespace
} // namespace toile::body
