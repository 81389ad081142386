#include "imaging/capture_folder.h"

#include "core/bytes.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <limits>

namespace toile::imaging {
namespace {

namespace fs = std::filesystem;

const Intrinsics kCamera{4, 3, 5.0, 6.0, 1.5, 1.0, {0.1, 0, 0, 0, 0, 0, 0, 0}};

Eigen::Isometry3d somewhere() {
    Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
    m.rotate(Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()));
    m.translation() = Vec3d(0.5, 1.2, 2.5);
    return m;
}

DepthImage depth_of(float metres) {
    DepthImage depth{4, 3, std::vector<float>(12, metres)};
    depth.metres[3] = std::numeric_limits<float>::quiet_NaN();
    return depth;
}

Image grey(std::uint8_t value) {
    return {4, 3, std::vector<std::uint8_t>(48, value)};
}

void write_capture(const fs::path& folder) {
    CaptureWriter writer(folder, kCamera, somewhere());
    const Image color = grey(90);
    const Image mask = grey(255);
    writer.add(0.0, depth_of(1.5f), &color, &mask);
    writer.add(0.04, depth_of(1.6f), &color);
    writer.add(0.1, depth_of(1.7f));
}

TEST(CaptureFolder, RoundTrip) {
    const test::TemporaryFolder folder;
    write_capture(folder / "c");
    const Capture capture = open_capture(folder / "c");
    ASSERT_EQ(capture.cameras.size(), 1u);
    const CaptureCamera& camera = capture.cameras[0];
    EXPECT_EQ(camera.intrinsics.fx, 5.0);
    EXPECT_EQ(camera.intrinsics.cy, 1.0);
    EXPECT_EQ(camera.intrinsics.distortion, kCamera.distortion);
    ASSERT_TRUE(camera.world_from_camera.has_value());
    EXPECT_TRUE(camera.world_from_camera->isApprox(somewhere(), 1e-12));
    ASSERT_EQ(camera.frames.size(), 3u);
    EXPECT_EQ(camera.frames[1].time_s, 0.04);
    EXPECT_FLOAT_EQ(camera.load_depth(1).metres[0], 1.6f);
    EXPECT_TRUE(std::isnan(camera.load_depth(1).metres[3]));
    EXPECT_NEAR(camera.load_color(1)->pixels[0], 90, 2);
    EXPECT_EQ(camera.load_mask(0)->pixels[0], 255);
    EXPECT_FALSE(camera.load_mask(1).has_value());
    EXPECT_FALSE(camera.load_color(2).has_value());
}

TEST(CaptureFolder, SeveralCameras) {
    const test::TemporaryFolder folder;
    write_capture(folder / "left");
    write_capture(folder / "right");
    const Capture capture = open_capture(folder.path());
    ASSERT_EQ(capture.cameras.size(), 2u);
    EXPECT_EQ(capture.cameras[0].name, "left");
    EXPECT_EQ(capture.cameras[1].name, "right");
}

TEST(CaptureFolder, EachFaultIsNamed) {
    const test::TemporaryFolder base;
    const fs::path folder = base / "c";
    const auto broken = [&](const auto& change) {
        fs::remove_all(folder);
        write_capture(folder);
        change();
    };
    broken([&] { fs::remove(folder / "depth/000001.png"); });
    EXPECT_ERROR((void)open_capture(folder), "no picture for frame 1");
    broken([&] { write_text(folder / "timestamps.csv", "0,0\n1,0.1\n"); });
    EXPECT_ERROR((void)open_capture(folder), "no time for frame 2");
    broken([&] { write_text(folder / "timestamps.csv", "0,0\n1,0.1\n2,0.1\n"); });
    EXPECT_ERROR((void)open_capture(folder), "line 3: times do not rise");
    broken([&] { write_text(folder / "timestamps.csv", "0,0\n1;0.1\n"); });
    EXPECT_ERROR((void)open_capture(folder), "line 2: expected 'frame,seconds'");
    broken([&] { write_text(folder / "timestamps.csv", "0,zero\n"); });
    EXPECT_ERROR((void)open_capture(folder), "'zero' is not");
    broken([&] { write_text(folder / "depth/notes.txt", "x"); });
    EXPECT_ERROR((void)open_capture(folder), "notes.txt: is not a frame");
    broken([&] { fs::rename(folder / "color/000000.jpg", folder / "color/000009.jpg"); });
    EXPECT_ERROR((void)open_capture(folder), "no depth picture beside it");
    broken([&] { fs::remove(folder / "intrinsic.json"); });
    EXPECT_ERROR((void)open_capture(folder), "not a capture folder");
    EXPECT_ERROR((void)open_capture(base / "nowhere"), "no such capture folder");
    broken([&] { fs::remove_all(folder / "depth"); });
    EXPECT_ERROR((void)open_capture(folder), "holds no frames");
    broken([&] {
        write_text(folder / "intrinsic.json",
                   R"({"width":4,"height":3,"intrinsic_matrix":[5,0,1.5,0,6,1,0,0,1]})");
    });
    EXPECT_ERROR((void)open_capture(folder), "column-major");
    broken([&] {
        write_text(folder / "intrinsic.json",
                   R"({"width":4,"height":3,"intrinsic_matrix":[5,0,0,0,6,0,1,1,1],"focal":2})");
    });
    EXPECT_ERROR((void)open_capture(folder), "focal");
    broken([&] {
        write_text(folder / "extrinsic.json",
                   R"({"world_from_camera":[2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})");
    });
    EXPECT_ERROR((void)open_capture(folder), "not a rigid motion");
    broken([&] { save_depth({2, 2, {1, 1, 1, 1}}, folder / "depth/000000.png"); });
    EXPECT_ERROR((void)open_capture(folder).cameras[0].load_depth(0), "is 2 x 2 pixels");
    EXPECT_ERROR(CaptureWriter(folder, kCamera), "already holds a capture");
    CaptureWriter writer(base / "d", kCamera);
    writer.add(1.0, depth_of(1));
    EXPECT_ERROR(writer.add(1.0, depth_of(1)), "does not come after");
    EXPECT_ERROR(writer.add(2.0, DepthImage{1, 1, {1.0f}}), "the camera 4 x 3");
}

TEST(CaptureFolder, TheSharedTurntableOpens) {
    TOILE_SHARED_DATA_OR_SKIP(set, "turntable_full");
    // truth.jsonl and SOURCE.txt stand beside the capture's own files.
    const Capture capture = open_capture(set);
    ASSERT_EQ(capture.cameras.size(), 1u);
    const CaptureCamera& camera = capture.cameras[0];
    EXPECT_EQ(camera.frames.size(), 60u);
    EXPECT_NEAR(camera.frames[59].time_s, 59.0 / 15.0, 1e-3);
    const DepthImage depth = camera.load_depth(0);
    std::size_t known = 0;
    for (const float metres : depth.metres)
        if (metres > 0.0f) ++known;
    EXPECT_GT(known, 20000u);
}

} // namespace
} // namespace toile::imaging
