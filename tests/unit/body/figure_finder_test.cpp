// Landmarks found by shape alone: on a mannequin of known sections, and on the avatars as if
// nothing were known of them.
#include "body/figure_finder.h"

#include "body/measurer.h"
#include "support/mannequin.h"
#include "support/meshes.h"
#include "support/throws.h"

#include <gtest/gtest.h>
#include <map>

namespace toile::body {
namespace {

using Values = std::map<std::string, double>;

Values measured(const FoundFigure& found) {
    std::vector<const MeasurementDefinition*> all;
    for (const MeasurementDefinition& d : measurement_definitions())
        all.push_back(&d);
    return as_map(measure(found.figure(), all));
}

Values measured(const geometry::TriangleMesh& mesh) {
    return measured(FoundFigure(mesh.positions, mesh.triangles));
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, float scale, const Quatf& turn,
                             const Vec3f& shift) {
    for (Vec3f& p : mesh.positions)
        p = scale * (turn * p) + shift;
    return mesh;
}

void expect_near(const Values& a, const Values& b, double scale, double relative) {
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [name, metres] : a)
        EXPECT_NEAR(b.at(name), scale * metres, relative * scale * std::max(metres, 0.3)) << name;
}

class MannequinOfKnownSections : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        mesh_ = new geometry::TriangleMesh(test::Mannequin().mesh(0.006f));
        values_ = new Values(measured(*mesh_));
    }
    static void TearDownTestSuite() {
        delete mesh_;
        delete values_;
    }
    static geometry::TriangleMesh* mesh_;
    static Values* values_;
};
geometry::TriangleMesh* MannequinOfKnownSections::mesh_ = nullptr;
Values* MannequinOfKnownSections::values_ = nullptr;

double girth(const test::Ring& ring) {
    return test::ellipse_perimeter(static_cast<double>(ring.x), static_cast<double>(ring.z));
}

TEST_F(MannequinOfKnownSections, HasItsHipsWaistAndLegsMeasuredExactly) {
    using M = test::Mannequin;
    const Values& v = *values_;
    EXPECT_NEAR(v.at("stature"), 1.70, 0.002);
    EXPECT_NEAR(v.at("crotch_height"), 0.80, 0.004);
    EXPECT_NEAR(v.at("hip_girth"), girth(M::kHip), 0.002);
    EXPECT_NEAR(v.at("hip_height"), 0.90, 0.006);
    EXPECT_NEAR(v.at("waist_girth"), girth(M::kWaist), 0.002);
    EXPECT_NEAR(v.at("waist_height"), 1.07, 0.006);
    EXPECT_NEAR(v.at("calf_girth"), girth(M::kCalf), 0.002);
    EXPECT_NEAR(v.at("minimum_leg_girth"), girth(M::kShin), 0.002);
    EXPECT_NEAR(v.at("wrist_girth"), girth(M::kWrist), 0.003);
    EXPECT_NEAR(v.at("hip_breadth"), 0.340, 0.002);
    EXPECT_NEAR(v.at("hip_depth"), 0.250, 0.002);
    EXPECT_NEAR(v.at("waist_breadth"), 0.250, 0.002);
    EXPECT_NEAR(v.at("waist_depth"), 0.180, 0.002);
    EXPECT_NEAR(v.at("head_girth"), test::ellipse_perimeter(0.075, 0.095), 0.004);
}

TEST_F(MannequinOfKnownSections, GrowsInProportion) {
    const Values grown = measured(moved(*mesh_, 1.1f, Quatf::Identity(), Vec3f::Zero()));
    expect_near(*values_, grown, 1.1, 0.002);
}

TEST_F(MannequinOfKnownSections, MayStandAnywhereFacingAnyWay) {
    const Quatf turn(Eigen::AngleAxisf(2.2f, Vec3f::UnitY()));
    const geometry::TriangleMesh there = moved(*mesh_, 1.0f, turn, Vec3f(3.0f, 0.4f, -1.0f));
    const FoundFigure found(there.positions, there.triangles);
    const Vec3f ahead = turn.conjugate() * (found.world_from_figure().rotation * Vec3f::UnitZ());
    EXPECT_GT(ahead.z(), 0.999f);
    expect_near(*values_, measured(found), 1.0, 0.01);
}

TEST_F(MannequinOfKnownSections, DoesNotDependOnItsTriangles) {
    const Values coarse = measured(test::Mannequin().mesh(0.010f));
    for (const char* name : {"hip_girth", "waist_girth", "bust_girth", "neck_girth", "calf_girth",
                             "minimum_leg_girth", "upper_arm_girth", "knee_girth"})
        EXPECT_NEAR(coarse.at(name), values_->at(name), 0.004) << name;
}

TEST(FoundFigure, RefusesWhatIsNoStandingPerson) {
    const auto find = [](const geometry::TriangleMesh& mesh) {
        return FoundFigure(mesh.positions, mesh.triangles);
    };
    EXPECT_ERROR(find(test::tube(0.2f, 0.1f, 1.7f, 60, 60)), "not closed (");
    EXPECT_ERROR(find(test::sphere(0.8f, 4)), "legs cannot be told apart");
    EXPECT_ERROR(find(test::sphere(80.0f, 4)), "scale it to metres");
    geometry::TriangleMesh inside_out = test::sphere(0.8f, 3);
    for (Triangle& t : inside_out.triangles)
        std::swap(t[0], t[1]);
    EXPECT_ERROR(find(inside_out), "inside out");
    EXPECT_ERROR(find({}), "no triangles");
}

} // namespace
} // namespace toile::body
