#include "imaging/rig_file.h"

#include "core/bytes.h"
#include "support/json_schema.h"
#include "support/temporary_folder.h"

#include <gmock/gmock.h>

namespace toile::imaging {
namespace {

using testing::HasSubstr;

RigFile two_cameras() {
    RigFile out;
    out.method = "ball";
    out.cameras.resize(2);
    out.cameras[0].name = "front";
    out.cameras[1].name = "back";
    out.cameras[1].world_from_camera.rotate(Eigen::AngleAxisd(2.5, Vec3d(1, 2, 3).normalized()));
    out.cameras[1].world_from_camera.pretranslate(Vec3d(0.1, 1.2, -2.3));
    out.report = {{"radius_m", 0.1}};
    return out;
}

std::string refusal(const std::filesystem::path& file) {
    try {
        (void)load_rig(file);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(RigFile, ComesBackAsItWasWritten) {
    const test::TemporaryFolder folder;
    const RigFile rig = two_cameras();
    save_rig(rig, folder / "rig.json");
    const RigFile read = load_rig(folder / "rig.json");
    EXPECT_EQ(read.method, "ball");
    ASSERT_EQ(read.cameras.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_EQ(read.cameras[c].name, rig.cameras[c].name);
        EXPECT_TRUE(
            read.cameras[c].world_from_camera.isApprox(rig.cameras[c].world_from_camera, 1e-12));
    }
    EXPECT_EQ(read.report, rig.report);
    EXPECT_THAT(test::JsonSchema("rig.schema.json").faults(parse_json_file(folder / "rig.json")),
                testing::IsEmpty());
}

TEST(RigFile, SaysWhatIsWrongAndWhere) {
    const test::TemporaryFolder folder;
    save_rig(two_cameras(), folder / "rig.json");
    const nlohmann::json good = parse_json_file(folder / "rig.json");
    const auto with = [&](const nlohmann::json& json) {
        write_text(folder / "bad.json", json.dump());
        return refusal(folder / "bad.json");
    };
    nlohmann::json bad = good;
    bad["cameras"][1]["world_from_camera"][0] = 3.0;
    EXPECT_THAT(with(bad), HasSubstr("/cameras/1/world_from_camera: is not a rigid motion"));
    bad = good;
    bad["cameras"] = nlohmann::json::array();
    EXPECT_THAT(with(bad), HasSubstr("names no camera"));
    bad = good;
    bad["schema"] = 2;
    EXPECT_THAT(with(bad), HasSubstr("schema"));
    bad = good;
    bad["cameras"][0]["colour"] = "red";
    EXPECT_THAT(with(bad), HasSubstr("colour"));
    EXPECT_THAT(refusal(folder / "none.json"), HasSubstr("none.json"));
}

} // namespace
} // namespace toile::imaging
