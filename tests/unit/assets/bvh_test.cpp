#include "assets/bvh.h"

#include "core/bytes.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <numbers>

namespace toile::assets {
namespace {

constexpr const char* kMotion = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 10 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Leg
  {
    OFFSET 1 -2 3
    CHANNELS 3 Yrotation Xrotation Zrotation
    End Site
    {
      OFFSET 0 -5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0  0 0 0
1 2 3 90 0 0  0 90 0
)";

BvhMotion load(const std::string& text, double scale = 1.0) {
    const test::TemporaryFolder folder;
    write_text(folder / "m.bvh", text);
    return load_bvh(folder / "m.bvh", scale);
}

std::string changed(const std::string& from, const std::string& to) {
    std::string text = kMotion;
    return text.replace(text.find(from), from.size(), to);
}

TEST(Bvh, ReadsJointsAndFrames) {
    const BvhMotion motion = load(kMotion, 0.1);
    ASSERT_EQ(motion.joints.size(), 2u);
    EXPECT_EQ(motion.joints[1].name, "Left Leg");
    EXPECT_EQ(motion.joints[1].parent, 0);
    EXPECT_TRUE(motion.joints[1].offset.isApprox(Vec3f(0.1f, -0.2f, 0.3f)));
    EXPECT_TRUE(motion.joints[1].end.isApprox(Vec3f(0, -0.5f, 0)));
    EXPECT_EQ(motion.frame_count, 2u);
    EXPECT_NEAR(motion.frame_time_s, 0.04, 1e-9);
    EXPECT_TRUE(motion.translation(1, 0).isApprox(Vec3f(0.1f, 0.2f, 0.3f)));
    EXPECT_TRUE(motion.translation(1, 1).isApprox(Vec3f(0.1f, -0.2f, 0.3f)));
    // 90 degrees about z turns x into y; about x it turns y into z.
    EXPECT_TRUE((motion.rotation(1, 0) * Vec3f::UnitX()).isApprox(Vec3f::UnitY(), 1e-6f));
    EXPECT_TRUE((motion.rotation(1, 1) * Vec3f::UnitY()).isApprox(Vec3f::UnitZ(), 1e-6f));
}

TEST(Bvh, TheFirstRotationIsOutermost) {
    const BvhMotion motion = load(changed("1 2 3 90 0 0  0 90 0", "0 0 0 90 90 0  0 0 0"));
    // Z then X: v -> Rz (Rx v).
    EXPECT_TRUE((motion.rotation(1, 0) * Vec3f::UnitY()).isApprox(Vec3f::UnitZ(), 1e-6f));
    EXPECT_TRUE((motion.rotation(1, 0) * Vec3f::UnitX()).isApprox(Vec3f::UnitY(), 1e-6f));
}

TEST(Bvh, RefusalsNameTheLine) {
    EXPECT_ERROR((void)load(changed("HIERARCHY", "HIERARCHIE")), "line 1: expected 'HIERARCHY'");
    EXPECT_ERROR((void)load(changed("OFFSET 1 -2 3", "OFFSET 1 -2 nan")), "line 8: 'nan' is not");
    EXPECT_ERROR((void)load(changed("Yrotation Xrotation Zrotation\n    End",
                                    "Yrotation Wrotation Zrotation\n    End")),
                 "line 9: unknown channel 'Wrotation'");
    EXPECT_ERROR((void)load(changed("Left Leg", "Hips")), "two joints are called 'Hips'");
    EXPECT_ERROR((void)load(changed("Frames: 2", "Frames: 1000")), "more than the file can hold");
    EXPECT_ERROR((void)load(changed("1 2 3 90 0 0  0 90 0\n", "1 2 3 90 0 0  0 90 0 5\n")),
                 "more values than 2 frames");
    EXPECT_ERROR((void)load(changed("Frames: 2", "Frames: 3")), "line ");
    EXPECT_ERROR((void)load(changed("Frames: 2", "Frames: -2")), "not a count");
    EXPECT_ERROR((void)load(changed("0.04", "0")), "frame time");
    EXPECT_ERROR((void)load(changed("0 90 0\n", "0 90 1e999\n")), "not a finite number");
    EXPECT_ERROR((void)load(""), "line 1: the file ends too early");
    EXPECT_ERROR((void)load("HIERARCHY ROOT a { OFFSET 0 0 0"), "the file ends too early");
}

TEST(Bvh, SharedMotionsLoad) {
    TOILE_SHARED_DATA_OR_SKIP(set, "bvh_motions");
    for (const char* name : {"01_01", "02_01", "131_01", "131_03", "Boxing_Toes"}) {
        const BvhMotion motion = load_bvh(set / (std::string(name) + ".bvh"), 0.056444);
        EXPECT_GT(motion.joints.size(), 15u) << name;
        EXPECT_GT(static_cast<double>(motion.frame_count) * motion.frame_time_s, 2.5) << name;
        EXPECT_EQ(motion.values.size(), motion.frame_count * motion.channel_count) << name;
    }
}

} // namespace
} // namespace toile::assets
