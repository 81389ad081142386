#include "host/mesh_sink.h"

#include "core/error.h"

#include <gmock/gmock.h>
#include <limits>

namespace toile::host {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

toile_mesh_buffers begin(MeshSink& sink, std::uint32_t nv, std::uint32_t nf) {
    toile_mesh_buffers out{};
    out.size = sizeof(out);
    EXPECT_EQ(sink.handle()->begin(sink.handle(), nv, nf, &out), TOILE_OK);
    return out;
}

void fill(const toile_mesh_buffers& out) {
    auto* p = static_cast<float*>(out.positions.data);
    for (std::uint32_t i = 0; i < 3 * out.positions.count; ++i)
        p[i] = static_cast<float>(i);
    auto* t = static_cast<std::uint32_t*>(out.triangles.data);
    for (std::uint32_t i = 0; i < 3 * out.triangles.count; ++i)
        t[i] = i % out.positions.count;
}

std::string error_of(MeshSink& sink) {
    try {
        (void)sink.take();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(MeshSink, KeepsWhatWasWrittenAndDropsWhatWasNot) {
    MeshSink sink(10, 10);
    const auto out = begin(sink, 4, 2);
    fill(out);
    static_cast<std::uint8_t*>(out.colors.data)[3] = 255;
    EXPECT_EQ(sink.handle()->commit(sink.handle()), TOILE_OK);
    const SunkMesh mesh = sink.take();
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.colors.size(), 4u);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.corner_coords.empty());
}

TEST(MeshSink, RefusesWhatIsNotFiniteOrOutOfRange) {
    MeshSink nan(10, 10);
    auto out = begin(nan, 4, 2);
    fill(out);
    static_cast<float*>(out.positions.data)[5] = kNan;
    EXPECT_EQ(nan.handle()->commit(nan.handle()), TOILE_E_NUMERIC);
    EXPECT_THAT(error_of(nan), ::testing::HasSubstr("positions are not finite"));

    MeshSink index(10, 10);
    out = begin(index, 4, 2);
    fill(out);
    static_cast<std::uint32_t*>(out.triangles.data)[5] = 4;
    EXPECT_EQ(index.handle()->commit(index.handle()), TOILE_E_NUMERIC);
    EXPECT_THAT(error_of(index), ::testing::HasSubstr("an index beyond the vertices"));

    MeshSink normals(10, 10);
    out = begin(normals, 4, 2);
    fill(out);
    static_cast<float*>(out.normals.data)[0] = 1; // one of four: not left out, not whole
    EXPECT_EQ(normals.handle()->commit(normals.handle()), TOILE_E_NUMERIC);
    EXPECT_THAT(error_of(normals), ::testing::HasSubstr("normals are not finite"));
}

TEST(MeshSink, RefusesCallsOutOfOrder) {
    MeshSink sink(10, 10);
    EXPECT_EQ(sink.handle()->commit(sink.handle()), TOILE_E_ARGUMENT);
    EXPECT_THAT(error_of(sink), ::testing::HasSubstr("gave no mesh"));
    toile_mesh_buffers out{};
    EXPECT_EQ(sink.handle()->begin(sink.handle(), 1, 1, &out), TOILE_E_ARGUMENT) << "no size";
    out.size = sizeof(out);
    EXPECT_EQ(sink.handle()->begin(sink.handle(), 11, 1, &out), TOILE_E_CAPACITY);
    (void)begin(sink, 1, 1);
    EXPECT_EQ(sink.handle()->begin(sink.handle(), 1, 1, &out), TOILE_E_ARGUMENT) << "twice";
    EXPECT_THAT(error_of(sink), ::testing::HasSubstr("did not commit"));
}

TEST(MeshSink, FillsNoMoreOfAnOlderStructThanItHas) {
    MeshSink sink(10, 10);
    toile_mesh_buffers out{};
    out.size = offsetof(toile_mesh_buffers, triangles);
    EXPECT_EQ(sink.handle()->begin(sink.handle(), 1, 1, &out), TOILE_OK);
    EXPECT_NE(out.positions.data, nullptr);
    EXPECT_EQ(out.triangles.data, nullptr);
    EXPECT_EQ(out.size, offsetof(toile_mesh_buffers, triangles));
}

} // namespace
} // namespace toile::host
