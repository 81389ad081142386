#include "abi/parameters.h"
#include "abi/skinning.h"
#include "sdk/views.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

extern "C" const toile_entry toile_plugin_entry_linear_blend_skinning;

namespace {

using toile::sdk::Float3;
using toile::sdk::Float4;
using toile::sdk::Index4;
using toile::sdk::view_of;

std::string last_report;
void report(const toile_host*, int32_t, toile_status, const char* text) {
    last_report = text;
}
const void* no_extension(const toile_host*, const char*) {
    return nullptr;
}

/// One triangle whose vertices hang on the hips, the left hand, and on both.
class LinearBlendSkinningEntry : public testing::Test {
  protected:
    void SetUp() override {
        host_ = {sizeof(toile_host), TOILE_ABI_MINOR, nullptr, "1.0.0", &no_extension, &report};
        instance_ =
            toile_plugin_entry_linear_blend_skinning.create(&host_, "toile.linear_blend_skinning");
        ASSERT_NE(instance_, nullptr);
        ASSERT_EQ(instance_->init(instance_), TOILE_OK);
        table_ =
            static_cast<const toile_skinning*>(instance_->get_extension(instance_, TOILE_SKINNING));
        body_.size = sizeof(body_);
        body_.revision = 7;
        body_.rest.size = sizeof(toile_mesh);
        body_.rest.positions = view_of<Float3>(positions_);
        body_.rest.triangles = view_of<toile::sdk::Triangle>(triangles_);
        body_.rest_joints = view_of<Float3>(rest_joints_);
        body_.joint_indices = view_of<Index4>(indices_);
        body_.joint_weights = view_of<Float4>(weights_);
        joints_.fill({});
        for (std::size_t i = 0; i < joints_.size(); ++i)
            joints_[i].rotation[3] = 1.0f;
        state_.size = sizeof(state_);
        state_.body_revision = 7;
        state_.joints = view_of<toile_joint>(joints_);
    }
    void TearDown() override { instance_->destroy(instance_); }

    void activate() {
        toile_limits limits{};
        limits.size = sizeof(limits);
        ASSERT_EQ(instance_->activate(instance_, &limits), TOILE_OK);
    }
    toile_status pose() {
        const toile_view_mut p{out_.data(), 3, sizeof(Float3), TOILE_F32X3, 0};
        const toile_view_mut n{normals_.data(), 3, sizeof(Float3), TOILE_F32X3, 0};
        return table_->pose(instance_, &state_, p, n);
    }

    toile_host host_{};
    toile_instance* instance_ = nullptr;
    const toile_skinning* table_ = nullptr;
    std::vector<Float3> positions_{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<toile::sdk::Triangle> triangles_{{0, 1, 2}};
    std::array<Float3, TOILE_JOINT_COUNT> rest_joints_{};
    std::vector<Index4> indices_{{0, 0, 0, 0}, {9, 0, 0, 0}, {0, 9, 0, 0}};
    std::vector<Float4> weights_{{1, 0, 0, 0}, {1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}};
    std::array<toile_joint, TOILE_JOINT_COUNT> joints_{};
    std::array<Float3, 3> out_{};
    std::array<Float3, 3> normals_{};
    toile_body body_{};
    toile_body_state state_{};
};

TEST_F(LinearBlendSkinningEntry, PosesWhatWasBoundAndFindsTheNormals) {
    activate();
    ASSERT_EQ(table_->bind(instance_, &body_, nullptr), TOILE_OK);
    positions_.assign(3, {9, 9, 9}); // borrowed for the call only
    joints_[9].position[2] = 2.0f;
    ASSERT_EQ(pose(), TOILE_OK);
    EXPECT_EQ(out_[0], (Float3{0, 0, 0}));
    EXPECT_EQ(out_[1], (Float3{1, 0, 2}));
    EXPECT_EQ(out_[2], (Float3{0, 1, 1}));
    for (const Float3& normal : normals_)
        EXPECT_EQ(normal, (Float3{0, 0, 1}));
}

TEST_F(LinearBlendSkinningEntry, TheSwitchChangesTheMethodAtActivate) {
    const auto* const parameters =
        static_cast<const toile_parameters*>(instance_->get_extension(instance_, TOILE_PARAMETERS));
    ASSERT_NE(parameters, nullptr);
    ASSERT_EQ(parameters->set(instance_, "dual_quaternion", 1.0), TOILE_OK);
    EXPECT_NE(parameters->set(instance_, "dual_quaternion", 0.5), TOILE_OK);
    activate();
    ASSERT_EQ(table_->bind(instance_, &body_, nullptr), TOILE_OK);
    // A quarter turn of one of two joints: the vertex between them keeps its distance of 1.
    joints_[9].rotation[0] = std::sqrt(0.5f);
    joints_[9].rotation[3] = std::sqrt(0.5f);
    ASSERT_EQ(pose(), TOILE_OK);
    EXPECT_NEAR(std::hypot(out_[2][0], out_[2][1], out_[2][2]), 1.0f, 1e-6f);
}

TEST_F(LinearBlendSkinningEntry, RefusesWhatItCannotPose) {
    activate();
    EXPECT_EQ(pose(), TOILE_E_ARGUMENT); // nothing bound
    weights_[1][0] = 0.5f;
    EXPECT_LT(table_->bind(instance_, &body_, nullptr), 0);
    EXPECT_NE(last_report.find("vertex 1"), std::string::npos);
    weights_[1][0] = 1.0f;
    ASSERT_EQ(table_->bind(instance_, &body_, nullptr), TOILE_OK);
    state_.body_revision = 8;
    EXPECT_EQ(pose(), TOILE_E_ARGUMENT);
    state_.body_revision = 7;
    joints_[3].rotation[3] = std::nanf("");
    EXPECT_EQ(pose(), TOILE_E_NUMERIC);
}

} // namespace
