#include "body/body_file.h"

#include "body/measurer.h"
#include "body/rotations.h"
#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <gtest/gtest.h>

namespace toile::body {
namespace {

const std::filesystem::path kAdult = std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" / "adult";

BodyFile somebody() {
    BodyFile out;
    out.model = "adult";
    out.model_version = "1.0.0";
    out.made_by = "fit";
    out.sex = Sex::female;
    out.coefficients = {0.5, -1.0, 0.25};
    out.measurements["stature"] = {1.68, 1.0};
    out.fit = {{"rms_m", 0.002}};
    Pose pose;
    pose.hips_position = Vec3f(0.1f, 0.9f, -0.3f);
    pose.rotations[3] = from_rotation_vector(Vec3f(0.1f, 0.2f, -0.3f));
    out.pose = pose;
    return out;
}

TEST(BodyFile, IsReadAsItWasWritten) {
    const test::TemporaryFolder folder;
    BodyFile before = somebody();
    before.detail.assign(5, 0.00123f);
    const auto file = folder.path() / "a.json";
    save_body_file(before, file);
    const BodyFile after = load_body_file(file);
    EXPECT_EQ(after.model, before.model);
    EXPECT_EQ(after.made_by, before.made_by);
    EXPECT_EQ(after.sex, before.sex);
    EXPECT_EQ(after.coefficients, before.coefficients);
    EXPECT_EQ(after.measurements.at("stature").value_m, 1.68);
    EXPECT_EQ(after.fit, before.fit);
    ASSERT_EQ(after.detail.size(), 5u);
    EXPECT_NEAR(after.detail[0], 0.00123f, 1e-5f);
    EXPECT_LT(after.pose->rotations[3].angularDistance(before.pose->rotations[3]), 1e-5f);
    EXPECT_LT((after.pose->hips_position - before.pose->hips_position).norm(), 1e-6f);
    // And writes the same bytes again.
    save_body_file(after, folder.path() / "b.json");
    EXPECT_EQ(read_bytes(file, 1u << 20), read_bytes(folder.path() / "b.json", 1u << 20));
}

TEST(BodyFile, RefusesWhatItDoesNotKnow) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "bad.json";
    const auto refused = [&](const std::string& text, const char* why) {
        write_text(file, text);
        EXPECT_ERROR((void)load_body_file(file), why);
        EXPECT_ERROR((void)load_body_file(file), "bad.json");
    };
    const std::string good = R"("schema": 1, "model": "adult", "model_version": "1.0.0",
                                "made_by": "fit", "coefficients": [0.5])";
    refused("{" + good + R"(, "waist": 3})", "waist");
    refused(R"({"schema": 2})", "schema");
    refused(R"({"schema": 1, "model": "adult"})", "model_version");
    refused("{" + good + R"(, "sex": "other"})", "sex");
    refused("{" + good + R"(, "detail": [0.5]})", "detail");
    refused("{" + good + R"(, "detail": [99999]})", "detail");
    refused("{" + good + R"(, "measurements": {"stature": {"value": -1, "confidence": 1}}})",
            "/measurements/stature/value");
    refused("{" + good + R"(, "pose": {"hips_position": [0, 0], "rotations": {}}})",
            "hips_position");
    refused("{" + good +
                R"(, "pose": {"hips_position": [0, 0, 0], "rotations": {"tail": [0,0,0,1]}}})",
            "tail");
    refused("{" + good +
                R"(, "pose": {"hips_position": [0, 0, 0], "rotations": {"head": [0,0,0,2]}}})",
            "unit quaternion");
    refused("not json", "bad.json");
    EXPECT_ERROR((void)load_body_file(folder.path() / "none.json"), "none.json");
}

TEST(BodyFile, DetailComesBackFromTheSurface) {
    const BodySpace space = BodySpace::load(kAdult);
    BodyFile body = somebody();
    body.detail.resize(space.model().rest.positions.size());
    for (std::size_t v = 0; v < body.detail.size(); ++v)
        body.detail[v] = 0.004f * std::sin(0.01f * static_cast<float>(v));
    const BodyShape shape = shape_of(body, space);
    const auto found =
        detail_of(space, body.coefficients, shape.positions, shape.skeleton);
    for (std::size_t v = 0; v < found.size(); ++v)
        ASSERT_NEAR(found[v], body.detail[v], 2e-6f);
    body.detail.resize(7);
    EXPECT_ERROR((void)shape_of(body, space), "7");
}

TEST(BodyFile, BecomesAMeasuredBody) {
    BodyFile body = somebody();
    const BodyModel model = model_of(body);
    EXPECT_TRUE(model.shape.empty());
    EXPECT_GT(model.measurements.at("stature"), 1.3);
    body.model_version = "7.0.0";
    EXPECT_ERROR((void)model_of(body), "7.0.0");
    body.model = "nobody";
    EXPECT_ERROR((void)model_of(body), "nobody");
}

TEST(BodyFile, MeasuresTheSameInAnyPose) {
    const BodySpace space = BodySpace::load(kAdult);
    const BodyShape shape = shape_of(somebody(), space);
    const Measurer measurer(space.model());
    Pose pose = rest_pose(shape.skeleton);
    pose.rotations[static_cast<std::size_t>(Joint::left_upper_arm)] =
        from_rotation_vector(Vec3f(0.0f, 0.0f, -0.5f));
    pose.rotations[static_cast<std::size_t>(Joint::right_lower_leg)] =
        from_rotation_vector(Vec3f(0.6f, 0.0f, 0.0f));
    const JointTransforms world = forward_kinematics(shape.skeleton, pose);
    const JointTransforms skinning = skinning_transforms(shape.skeleton, world);
    std::vector<Vec3f> posed;
    for (std::size_t v = 0; v < shape.positions.size(); ++v) {
        Vec3f p = Vec3f::Zero();
        for (std::size_t k = 0; k < 4; ++k)
            p += space.model().skin.weights[v][k] *
                 (skinning[space.model().skin.joints[v][k]] * shape.positions[v]);
        posed.push_back(p);
    }
    const auto rest = measurer.measure(shape.positions, shape.skeleton);
    const auto again =
        measurer.measure(measurer.unposed(posed, shape.skeleton, world), shape.skeleton);
    for (std::size_t i = 0; i < rest.size(); ++i)
        EXPECT_NEAR(again[i].value_m, rest[i].value_m, 0.002) << rest[i].name;
}

} // namespace
} // namespace toile::body
