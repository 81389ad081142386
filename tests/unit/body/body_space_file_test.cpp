// The files of a body space: read as they were written, and refused when something in them is
// wrong.
#include "core/json.h"
#include "support/small_space.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cstring>
#include <functional>

namespace toile::body {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

/// Everything that a folder of bodies is read for.
void load(const fs::path& folder) {
    const BodySpace space = BodySpace::load(folder);
    (void)load_pose_tables(space.model());
    (void)space.shape(std::vector<double>{1.0, -1.0});
}

class SpaceFiles : public testing::Test {
  protected:
    void SetUp() override { test::write_space(test::small_model(), folder_.path()); }

    void expect_refused(const char* name, const std::string& part,
                        const std::function<void(nlohmann::json&)>& change) {
        const fs::path file = folder_ / name;
        const Bytes good = read_bytes(file, 1u << 20);
        nlohmann::json json = parse_json_file(file);
        change(json);
        write_text(file, json.dump());
        EXPECT_ERROR(load(folder_.path()), part);
        write_bytes(file, good);
    }
    void expect_space_refused(const std::string& part,
                              const std::function<void(nlohmann::json&)>& change) {
        expect_refused("space.json", part, change);
    }
    void expect_avatar_refused(const std::string& part,
                               const std::function<void(nlohmann::json&)>& change) {
        expect_refused("avatar.json", part, change);
    }
    void expect_model_refused(const std::string& part,
                              const std::function<void(BodyModel&)>& change) {
        BodyModel model = test::small_model();
        change(model);
        test::write_space(std::move(model), folder_.path());
        EXPECT_ERROR(load(folder_.path()), part);
        SetUp();
    }

    test::TemporaryFolder folder_;
};

TEST_F(SpaceFiles, AreReadAsTheyWereWritten) {
    const BodySpace space = BodySpace::load(folder_.path());
    EXPECT_EQ(space.component_count(), 2);
    EXPECT_EQ(space.model().rest.positions, test::small_model().rest.positions);
    EXPECT_EQ(space.prior(Sex::male).covariance(0, 1), 0.25);
    ASSERT_EQ(space.levels().size(), 1u);
    EXPECT_EQ(space.levels()[0].triangles.size(), 8u);
    const PoseTables poses = load_pose_tables(space.model());
    EXPECT_NEAR(poses.correctives.weights.back()(2, 3), 1.0f, 1e-4f);
}

TEST_F(SpaceFiles, ASpaceWithoutSomethingIsRefused) {
    for (const char* key : {"schema", "coefficients", "levels", "tables"})
        expect_space_refused("/" + std::string(key) + ": is missing",
                             [&](auto& j) { j.erase(key); });
    expect_space_refused("/coefficients/female: is missing",
                         [](auto& j) { j["coefficients"].erase("female"); });
    expect_space_refused("/coefficients/male/mean: is missing",
                         [](auto& j) { j["coefficients"]["male"].erase("mean"); });
    expect_space_refused("/people: is not a known key", [](auto& j) { j["people"] = -1; });
}

TEST_F(SpaceFiles, ASpaceOfWrongTypesAndSizesIsRefused) {
    expect_space_refused("/coefficients: must be an object",
                         [](auto& j) { j["coefficients"] = 1; });
    expect_space_refused("/coefficients/male: must be an object", [](auto& j) {
        j["coefficients"]["male"] = {1, 2};
    });
    expect_space_refused("/levels: must be an array", [](auto& j) { j["levels"] = "octahedron"; });
    expect_space_refused("/levels: must hold texts", [](auto& j) { j["levels"][0] = 3; });
    expect_space_refused("too many",
                         [](auto& j) { j["levels"] = std::vector<std::string>(9, "octahedron"); });
    expect_space_refused("no table 'cube_vertices'", [](auto& j) { j["levels"][0] = "cube"; });
    expect_space_refused("/tables: must be a text", [](auto& j) { j["tables"] = true; });
    for (const char* name : {"", ".", "..", "../space.tables", "/dev/zero", "folder/space.tables"})
        expect_space_refused("/tables: must be the name", [&](auto& j) { j["tables"] = name; });
    expect_space_refused("no such file", [](auto& j) { j["tables"] = "none.tables"; });
    expect_space_refused("no file of tables", [](auto& j) { j["tables"] = "avatar.json"; });
    const auto prior = [](nlohmann::json& j) -> nlohmann::json& {
        return j["coefficients"]["female"];
    };
    expect_space_refused("/mean: must be an array of 2",
                         [&](auto& j) { prior(j)["mean"].push_back(0.0); });
    expect_space_refused("/covariance: must be an array of 4", [&](auto& j) {
        prior(j)["covariance"] = {1, 0, 0};
    });
    expect_space_refused("/mean: must hold numbers", [&](auto& j) { prior(j)["mean"][0] = "0"; });
    expect_space_refused("/mean: must hold numbers",
                         [&](auto& j) { prior(j)["mean"][0] = nullptr; });
    expect_space_refused("beyond 100 deviations", [&](auto& j) { prior(j)["mean"][0] = -1e30; });
    expect_space_refused("symmetric", [&](auto& j) { prior(j)["covariance"][1] = 0.3; });
    expect_space_refused("positive definite", [&](auto& j) {
        prior(j)["covariance"] = {1, 2, 2, 1};
    });
    write_text(folder_ / "space.json", R"({"schema": 1, "coefficients": NaN})");
    EXPECT_ERROR(load(folder_.path()), "not valid JSON");
}

TEST_F(SpaceFiles, AnAvatarOfWrongCountsAndNumbersIsRefused) {
    for (const double count : {-1.0, 0.0, 67.0, 0.5})
        expect_avatar_refused("/parts/0/count", [=](auto& j) { j["parts"][0]["count"] = count; });
    for (const std::int64_t count : {INT64_MIN, std::int64_t{-1}, INT64_MAX})
        expect_avatar_refused("/parts/0/count", [=](auto& j) { j["parts"][0]["count"] = count; });
    for (const std::int64_t vertex : {std::int64_t{-1}, std::int64_t{66}, INT64_MAX})
        expect_avatar_refused("/landmarks/navel",
                              [=](auto& j) { j["landmarks"]["navel"] = vertex; });
    expect_avatar_refused("/landmarks/navel: must be a whole number",
                          [](auto& j) { j["landmarks"]["navel"] = "4"; });
    expect_avatar_refused("/measurements/stature",
                          [](auto& j) { j["measurements"]["stature"] = 1e30; });
    expect_avatar_refused("/joints/hips: is over 10 m", [](auto& j) {
        j["joints"]["hips"] = {0, 1e300, 0};
    });
    expect_avatar_refused("/joints/hips", [](auto& j) { j["joints"]["hips"] = {0, 1}; });
    expect_avatar_refused("/shape: names 1 components", [](auto& j) { j["shape"].erase(0); });
    expect_avatar_refused("/shape: must be an array", [](auto& j) { j["shape"] = 2; });
    const auto offsets = [](nlohmann::json& j) -> nlohmann::json& {
        return j["shape"][1]["joint_offsets"];
    };
    expect_avatar_refused("joint_offsets: must be an array of 66",
                          [&](auto& j) { offsets(j).erase(0); });
    expect_avatar_refused("joint_offsets: must hold numbers",
                          [&](auto& j) { offsets(j)[65] = false; });
    for (const double far : {11.0, -1e300})
        expect_avatar_refused("joint_offsets: is over 10 m",
                              [&](auto& j) { offsets(j)[65] = far; });
    for (const char* name : {"", ".", "..", "a/small.glb"})
        expect_avatar_refused("/model: must be the name", [&](auto& j) { j["model"] = name; });
}

TEST_F(SpaceFiles, AModelTheSizeOfAHouseIsRefused) {
    for (const float far : {11.0f, -1e30f}) {
        expect_model_refused("10 m", [=](BodyModel& m) { m.rest.positions[7].y() = far; });
        expect_model_refused("10 m", [=](BodyModel& m) { m.shape[1].vertex_offsets[7].x() = far; });
    }
}

/// The tables of a space: whole numbers and real ones, damaged in all the ways that have a name.
class SpaceTables : public SpaceFiles {
  protected:
    void write_levels(const std::vector<std::uint32_t>& vertices,
                      const std::vector<std::uint32_t>& corners) {
        TableWriter tables;
        tables.integers("octahedron_vertices", vertices);
        tables.integers("octahedron_triangles", corners);
        tables.write(folder_ / "space.tables");
    }
};

TEST_F(SpaceTables, LevelsThatAreNoSurfaceAreRefused) {
    const std::vector<std::uint32_t> six = {0, 1, 2, 3, 4, 5};
    write_levels({}, {});
    EXPECT_ERROR(load(folder_.path()), "space.tables");
    write_levels(six, {});
    EXPECT_ERROR(load(folder_.path()), "no whole triangles");
    write_levels(six, {0, 1});
    EXPECT_ERROR(load(folder_.path()), "no whole triangles");
    write_levels(six, {0, 1, 6});
    EXPECT_ERROR(load(folder_.path()), "6 is out of range");
    write_levels({0, 1, 66}, {0, 1, 2});
    EXPECT_ERROR(load(folder_.path()), "66 is out of range");
    write_levels(six, {0, 0, 0});
    EXPECT_ERROR(load(folder_.path()), "not closed");
    write_levels(six, {0, 2, 4});
    EXPECT_ERROR(load(folder_.path()), "not closed");
}

TEST_F(SpaceTables, OfTheSizeOfAnotherModelAreRefused) {
    for (const char* name : {"scape.tables", "baked.tables"}) {
        const Bytes good = read_bytes(folder_ / name, 1u << 20);
        TableWriter tables;
        tables.integers("joints", std::vector<std::uint32_t>(5, 0u));
        tables.numbers("weights", Eigen::MatrixXf::Ones(5, 72));
        tables.write(folder_ / name);
        EXPECT_ERROR(load(folder_.path()), std::string(name) + ": table 'joints' does not fit");
        write_bytes(folder_ / name, good);
    }
}

TEST_F(SpaceTables, CutOffAnywhereAreRefused) {
    for (const char* name : {"space.tables", "scape.tables", "baked.tables"}) {
        const Bytes good = read_bytes(folder_ / name, 1u << 20);
        const std::size_t step = 1 + good.size() / 500;
        for (std::size_t keep = 0; keep < good.size(); keep += step) {
            write_bytes(folder_ / name, std::span(good).first(keep));
            EXPECT_THROW(load(folder_.path()), FileError) << name << ", " << keep << " bytes kept";
        }
        write_bytes(folder_ / name, good);
    }
}

TEST_F(SpaceTables, AnyWordMayBeAnything) {
    for (const char* name : {"space.tables", "baked.tables"}) {
        const Bytes good = read_bytes(folder_ / name, 1u << 20);
        // Heads and first values, then here and there.
        const std::size_t step = 1 + good.size() / 200;
        for (std::size_t at = 0; at + 4 <= good.size(); at += at < 120 ? 1 : step)
            for (const std::uint32_t word :
                 {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0x7fc00000u, 0x7f7fffffu}) {
                Bytes bad = good;
                std::memcpy(bad.data() + at, &word, sizeof word);
                write_bytes(folder_ / name, bad);
                try {
                    load(folder_.path());
                } catch (const Error& e) {
                    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
                }
            }
        write_bytes(folder_ / name, good);
    }
}

class TableFile : public testing::Test {
  protected:
    /// A file of one table without values, whose name is a letter.
    void write_head(std::uint32_t kind, std::uint32_t rows, std::uint32_t columns,
                    char name = 'a') {
        Bytes bytes;
        const auto put = [&bytes](const void* from, std::size_t size) {
            const auto* first = static_cast<const std::uint8_t*>(from);
            bytes.insert(bytes.end(), first, first + size);
        };
        put("ToileTb1", 8);
        const std::array<std::uint32_t, 2> before = {1, 1}; // tables, length of the name
        put(before.data(), sizeof before);
        put(&name, 1);
        const std::array<std::uint32_t, 3> head = {kind, rows, columns};
        put(head.data(), sizeof head);
        write_bytes(file_, bytes);
    }

    test::TemporaryFolder folder_;
    fs::path file_ = folder_ / "t.tables";
};

TEST_F(TableFile, KeepsNumbersWithinItsBound) {
    Eigen::MatrixXf values = Eigen::MatrixXf::Random(50, 3);
    values.col(1) *= 1e-4f;
    values.col(2).setZero();
    TableWriter out;
    out.numbers("a", values);
    const std::vector<std::uint32_t> whole = {0, 7, 3};
    out.integers("b", whole);
    out.integers("none", {});
    out.numbers("nothing", Eigen::MatrixXf(0, 2));
    out.write(file_);
    const TableReader in(file_);
    EXPECT_TRUE(in.integers("none", 1).empty());
    EXPECT_EQ(in.numbers("nothing", 0, 2).size(), 0);
    const Eigen::MatrixXf read = in.numbers("a", 50, 3);
    for (int c = 0; c < 3; ++c)
        EXPECT_LE((read.col(c) - values.col(c)).cwiseAbs().maxCoeff(),
                  values.col(c).cwiseAbs().maxCoeff() / 65000.0f);
    EXPECT_EQ(in.integers("b", 8), whole);
    EXPECT_ERROR(static_cast<void>(in.integers("b", 7)), "out of range");
    EXPECT_ERROR(static_cast<void>(in.integers("a", 7)), "kind");
    EXPECT_ERROR(static_cast<void>(in.numbers("a", 50, 4)), "instead of");
    EXPECT_ERROR(static_cast<void>(in.numbers("c", 1, 1)), "no table");
}

TEST_F(TableFile, DamagedFilesAreRefused) {
    TableWriter out;
    out.numbers("a", Eigen::MatrixXf::Ones(4, 2));
    out.write(file_);
    const auto bytes = read_bytes(file_, 1000);
    for (std::size_t keep = 0; keep < bytes.size(); ++keep) {
        write_bytes(file_, std::span(bytes).first(keep));
        EXPECT_THROW(TableReader{file_}, FileError) << keep << " bytes kept";
    }
}

TEST_F(TableFile, HeadsThatCannotBeAreRefused) {
    // 2^31 x 2^31 values of 4 bytes are 2^64 bytes, and so are 2^31 columns of 4 + 2 (2^32 - 2).
    write_head(1, 1u << 31, 1u << 31);
    EXPECT_ERROR(TableReader{file_}, "is cut off in 'a'");
    write_head(2, 0xfffffffeu, 1u << 31);
    EXPECT_ERROR(TableReader{file_}, "is cut off in 'a'");
    write_head(1, 0xffffffffu, 0xffffffffu);
    EXPECT_ERROR(TableReader{file_}, "is cut off in 'a'");
    write_head(2, 0xffffffffu, 1);
    EXPECT_ERROR(TableReader{file_}, "is cut off in 'a'");
    write_head(3, 1, 1);
    EXPECT_ERROR(TableReader{file_}, "unknown kind");
    write_head(1, 0, 0, '\n');
    EXPECT_ERROR(TableReader{file_}, "no name");
}

TEST_F(TableFile, NumbersThatAreNotFiniteAreRefused) {
    TableWriter out;
    out.numbers("a", Eigen::MatrixXf::Ones(4, 1));
    out.write(file_);
    Bytes bytes = read_bytes(file_, 1000);
    const std::size_t step = bytes.size() - 4 * sizeof(std::int16_t) - sizeof(float);
    for (const float bad : {std::nanf(""), HUGE_VALF, 3e38f}) {
        std::memcpy(bytes.data() + step, &bad, sizeof bad);
        write_bytes(file_, bytes);
        EXPECT_ERROR((void)TableReader(file_).numbers("a", 4, 1), "not finite");
    }
}

} // namespace
} // namespace toile::body
