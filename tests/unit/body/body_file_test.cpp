// body.json: what is written is read again, what is wrong is refused with file and place, and the
// body of it measures the same however it stood.
#include "body/body_file.h"

#include "body/measurer.h"
#include "body/skinning.h"
#include "core/bytes.h"
#include "support/temporary_folder.h"
#include "support/throws.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>

namespace toile::body {
namespace {

Quatf about(const Vec3f& axis, float radians) {
    return Quatf(Eigen::AngleAxisf(radians, axis));
}

Pose stride() {
    Pose out;
    out.hips_position = Vec3f(0.4f, 0.93f, -1.2f);
    const auto turn = [&](Joint joint, const Vec3f& axis, float radians) {
        out.rotations[static_cast<std::size_t>(joint)] = about(axis, radians);
    };
    turn(Joint::hips, Vec3f::UnitY(), 1.1f);
    turn(Joint::chest, Vec3f::UnitY(), 0.2f);
    turn(Joint::left_upper_arm, Vec3f::UnitX(), 0.3f);
    turn(Joint::left_upper_leg, Vec3f::UnitX(), -0.4f);
    turn(Joint::right_lower_leg, Vec3f::UnitX(), 0.3f);
    return out;
}

BodyFile somebody() {
    BodyFile out;
    out.model = "adult";
    out.model_version = "1.0.0";
    out.made_by = "measurements";
    out.sex = Sex::female;
    out.coefficients = {0.7, -1.1, 0.25, 1.0 / 3.0};
    return out;
}

/// Everything that a file may hold.
BodyFile whole() {
    BodyFile out = somebody();
    out.made_by = "fit";
    out.detail = {0.0f, 0.00123f, -0.2f};
    out.pose = stride();
    out.measurements["bust_girth"] = {0.923456789, 0.75};
    out.fit = nlohmann::ordered_json::parse(R"({"zeta": [1, 2.5], "alpha": {"text": "kept"}})");
    return out;
}

class BodyFileTest : public testing::Test {
  protected:
    nlohmann::json json() {
        save_body_file(whole(), file_);
        const auto bytes = read_bytes(file_, 1u << 20);
        return nlohmann::json::parse(bytes.begin(), bytes.end());
    }
    void expect_refused(const std::string& part,
                        const std::function<void(nlohmann::json&)>& change) {
        nlohmann::json changed = json();
        change(changed);
        write_text(file_, changed.dump());
        EXPECT_ERROR((void)load_body_file(file_), file_.string() + ": " + part);
    }

    test::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "anna.json";
};

TEST_F(BodyFileTest, IsReadAsItWasWritten) {
    const BodyFile written = whole();
    save_body_file(written, file_);
    const BodyFile read = load_body_file(file_);
    EXPECT_EQ(read.model, written.model);
    EXPECT_EQ(read.model_version, written.model_version);
    EXPECT_EQ(read.made_by, written.made_by);
    EXPECT_EQ(read.sex, written.sex);
    EXPECT_EQ(read.coefficients, written.coefficients);
    ASSERT_EQ(read.detail.size(), written.detail.size());
    for (std::size_t v = 0; v < read.detail.size(); ++v)
        EXPECT_NEAR(read.detail[v], written.detail[v], 5e-6);
    ASSERT_TRUE(read.pose);
    EXPECT_EQ(read.pose->hips_position, written.pose->hips_position);
    for (std::size_t j = 0; j < kJointCount; ++j)
        EXPECT_LT(read.pose->rotations[j].angularDistance(written.pose->rotations[j]), 1e-3f);
    EXPECT_EQ(read.measurements.at("bust_girth").value_m, 0.923456789);
    EXPECT_EQ(read.measurements.at("bust_girth").confidence, 0.75);
    EXPECT_EQ(nlohmann::json(read.fit), nlohmann::json(written.fit));
}

TEST_F(BodyFileTest, WrittenAgainIsTheSameFile) {
    BodyFile body = whole();
    body.fit = nlohmann::ordered_json::parse(R"({"alpha": 1})");
    save_body_file(body, file_);
    const auto first = read_bytes(file_, 1u << 20);
    save_body_file(load_body_file(file_), file_);
    // Quaternions are made unit again when read: that may move their last digit, once.
    save_body_file(load_body_file(file_), folder_ / "again.json");
    EXPECT_EQ(read_bytes(file_, 1u << 20), read_bytes(folder_ / "again.json", 1u << 20));
    EXPECT_NEAR(static_cast<double>(first.size()),
                static_cast<double>(read_bytes(file_, 1u << 20).size()), 200.0);
}

TEST_F(BodyFileTest, WhatMayBeLeftOutMay) {
    save_body_file(somebody(), file_);
    const BodyFile read = load_body_file(file_);
    EXPECT_FALSE(read.pose);
    EXPECT_TRUE(read.detail.empty());
    EXPECT_TRUE(read.measurements.empty());
    EXPECT_TRUE(read.fit.is_null());
}

TEST_F(BodyFileTest, JointsThatAreNotNamedStandAsAtRest) {
    nlohmann::json changed = json();
    changed["pose"]["rotations"] = {{"neck", {0, 0, 1, 0}}};
    write_text(file_, changed.dump());
    const Pose pose = *load_body_file(file_).pose;
    for (std::size_t j = 0; j < kJointCount; ++j)
        EXPECT_EQ(pose.rotations[j].w(), j == static_cast<std::size_t>(Joint::neck) ? 0.0f : 1.0f);
}

TEST_F(BodyFileTest, RefusesWhatIsMissingOrUnknown) {
    for (const char* key : {"schema", "model", "model_version", "made_by", "coefficients"})
        expect_refused("/" + std::string(key) + ": is missing", [&](auto& j) { j.erase(key); });
    expect_refused("/shoe_size: is not a known key", [](auto& j) { j["shoe_size"] = 42; });
    expect_refused("/pose/turn: is not a known key", [](auto& j) { j["pose"]["turn"] = 1; });
    expect_refused("/pose/rotations/tail: is no joint", [](auto& j) {
        j["pose"]["rotations"]["tail"] = {0, 0, 0, 1};
    });
    expect_refused("/pose/hips_position: is missing",
                   [](auto& j) { j["pose"].erase("hips_position"); });
    expect_refused("/measurements/bust_girth/confidence: is missing",
                   [](auto& j) { j["measurements"]["bust_girth"].erase("confidence"); });
}

TEST_F(BodyFileTest, RefusesWrongTypesAndNumbers) {
    expect_refused("/schema: must lie between 1 and 1", [](auto& j) { j["schema"] = 2; });
    expect_refused("/model: must be a text", [](auto& j) { j["model"] = 1; });
    expect_refused("/sex: must be", [](auto& j) { j["sex"] = "unknown"; });
    expect_refused("/coefficients: must be a list", [](auto& j) { j["coefficients"] = 1; });
    expect_refused("/coefficients: must hold numbers", [](auto& j) { j["coefficients"][0] = "1"; });
    expect_refused("/coefficients: has a value beyond",
                   [](auto& j) { j["coefficients"][0] = 1e30; });
    expect_refused("/detail: must hold whole numbers", [](auto& j) { j["detail"][0] = 0.5; });
    for (const std::int64_t far : {std::int64_t{20001}, INT64_MIN, INT64_MAX})
        expect_refused("/detail: must hold whole numbers", [=](auto& j) { j["detail"][0] = far; });
    expect_refused("/detail: must hold whole numbers",
                   [](auto& j) { j["detail"][0] = UINT64_MAX; });
    expect_refused("/pose/hips_position: is over",
                   [](auto& j) { j["pose"]["hips_position"][1] = 1e6; });
    expect_refused("/pose/rotations/hips: is not a unit quaternion", [](auto& j) {
        j["pose"]["rotations"]["hips"] = {0, 0, 0, 0};
    });
    expect_refused("/pose/rotations/hips: must be an array of 4", [](auto& j) {
        j["pose"]["rotations"]["hips"] = {0, 0, 1};
    });
    expect_refused("/measurements/bust_girth/value: is 92",
                   [](auto& j) { j["measurements"]["bust_girth"]["value"] = 92; });
    write_text(file_, R"({"schema": 1e999})");
    EXPECT_ERROR((void)load_body_file(file_), "out of range");
    write_text(file_, R"({"schema": NaN})");
    EXPECT_ERROR((void)load_body_file(file_), "not valid JSON");
    EXPECT_ERROR((void)load_body_file(folder_ / "nobody.json"), "nobody.json: no such file");
}

TEST_F(BodyFileTest, RefusesWhatDoesNotFitItsModel) {
    const auto expect = [&](const std::string& part, const std::function<void(BodyFile&)>& change) {
        BodyFile body = somebody();
        change(body);
        save_body_file(body, file_);
        EXPECT_ERROR((void)load_body(file_), file_.string() + ": ");
        EXPECT_ERROR((void)load_body(file_), part);
    };
    expect("no avatar 'giant'", [](BodyFile& b) { b.model = "giant"; });
    expect("version 0.9.0 of 'adult'", [](BodyFile& b) { b.model_version = "0.9.0"; });
    expect("41 shape coefficients", [](BodyFile& b) { b.coefficients.resize(41); });
    expect("detail is for 3 vertices", [](BodyFile& b) { b.detail.resize(3); });
    expect("'man' is one body and takes none", [](BodyFile& b) { b.model = "man"; });
}

TEST_F(BodyFileTest, AnAvatarWithoutComponentsIsItself) {
    BodyFile body = somebody();
    body.model = "man";
    body.coefficients.clear();
    const BodyModel made = model_of(body);
    const BodyModel man = load_body_model(find_avatar("man"));
    EXPECT_EQ(made.rest.positions, man.rest.positions);
    EXPECT_NEAR(made.measurements.at("waist_girth"), man.measurements.at("waist_girth"), 1e-4);
}

TEST_F(BodyFileTest, DetailLeadsBackToTheSurfaceItWasTakenFrom) {
    const BodySpace space = BodySpace::load(find_avatar("adult"));
    BodyFile body = somebody();
    BodyShape bumpy = space.shape(body.coefficients);
    for (std::size_t v = 0; v < bumpy.positions.size(); ++v)
        bumpy.positions[v] +=
            0.004f * std::sin(40.0f * bumpy.positions[v].y()) * space.model().rest.normals[v];
    body.detail = detail_of(space, body.coefficients, bumpy.positions, bumpy.skeleton);
    save_body_file(body, file_);
    const BodyShape back = shape_of(load_body_file(file_), space);
    // Stood on the floor: the soles' own detail has lifted or sunk it.
    const Vec3f lift = back.skeleton.rest(Joint::hips) - bumpy.skeleton.rest(Joint::hips);
    float farthest = 0.0f, floor = 1.0f;
    for (std::size_t v = 0; v < back.positions.size(); ++v) {
        farthest = std::max(farthest, (back.positions[v] - lift - bumpy.positions[v]).norm());
        floor = std::min(floor, back.positions[v].y());
    }
    EXPECT_LT(farthest, 2e-5f);
    EXPECT_NEAR(floor, 0.0f, 1e-6f);
}

/// Largest change of any measurement, printed with its name.
double largest_change(const char* what, const Measurements& before, const Measurements& after) {
    double most = 0.0;
    std::string_view name;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double change = std::abs(after[i].value_m - before[i].value_m);
        if (change <= most) continue;
        most = change;
        name = before[i].name;
    }
    std::cout << what << ": " << 1000.0 * most << " mm (" << name << ")\n";
    return most;
}

TEST_F(BodyFileTest, ABodyMeasuresTheSameHoweverItStands) {
    BodyFile body = somebody();
    const BodyModel rest = model_of(body);
    body.pose = stride();
    save_body_file(body, file_);
    const BodyModel model = load_body(file_);
    EXPECT_EQ(model.rest.positions, rest.rest.positions);

    // As a linear blend shows it, and brought back.
    const Measurer measurer(model);
    const JointTransforms world = forward_kinematics(model.skeleton, *body.pose);
    std::vector<Vec3f> posed(model.rest.positions.size());
    const SkinnedSurface surface(model.rest.positions, {}, model.skin.joints, model.skin.weights);
    surface.pose(skinning_transforms(model.skeleton, world), SkinningMethod::linear_blend,
                 VectorRows(std::span<Vec3f>(posed)), {});
    const Measurements before = measurer.measure(model.rest.positions, model.skeleton);
    const auto after = [&] {
        return measurer.measure(measurer.unposed(posed, model.skeleton, world), model.skeleton);
    };
    EXPECT_LT(largest_change("posed by a linear blend", before, after()), 0.002);
    for (const auto& m : before)
        if (m.value_m > 0.0) {
            EXPECT_NEAR(m.value_m, rest.measurements.at(std::string(m.name)), 1e-6) << m.name;
        }
}

} // namespace
} // namespace toile::body
