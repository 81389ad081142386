// Scans in, people out: whatever way up, in whatever unit, with whatever around them.
#include "people.h"
#include "support/throws.h"

#include <chrono>

namespace toile::scape_fit {
namespace {

FitSession& session() {
    static FitSession one(adult());
    return one;
}

/// Fits a scan that is the person moved by `metres_from_scan`, and compares in metres.
void expect_found(const geometry::TriangleMesh& scan, const geometry::TriangleMesh& person,
                  double most_mm, const SessionOptions& options = {}) {
    session().begin({});
    session().add_scan(scan);
    ASSERT_NO_THROW(session().fit(options, &serial_rows));
    const PosedLevel found = session().surface(0);
    EXPECT_LT(1000.0 * mean_distance(found.positions, person), most_mm);
    EXPECT_LT(
        1000.0 * mean_distance(person.positions, {found.positions, {}, adult().level(0).triangles}),
        most_mm);
}

TEST(ScanFit, FindsAPersonOfTheSpace) {
    const Somebody who;
    expect_found(who.surface, who.surface, 1.0);
    EXPECT_EQ(session().report().at("unit"), "m");
    EXPECT_EQ(session().report().at("sex"), "female");
    // Its joints are where they were, not only its skin.
    const PosedLevel found = session().surface(0);
    const auto truth = body::forward_kinematics(adult().skeleton(who.shape.coefficients), who.pose);
    for (const body::Joint joint :
         {body::Joint::left_lower_arm, body::Joint::right_lower_arm, body::Joint::left_lower_leg,
          body::Joint::right_lower_leg, body::Joint::neck, body::Joint::hips})
        EXPECT_LT((found.world[static_cast<std::size_t>(joint)].translation -
                   truth[static_cast<std::size_t>(joint)].translation)
                      .norm(),
                  0.015f)
            << body::joint_name(joint);
}

TEST(ScanFit, UnitAndWayUpAreFoundAndSaid) {
    const Somebody who;
    const Mat3f lying = Eigen::AngleAxisf(1.5707963f, Vec3f::UnitX()).toRotationMatrix();
    const geometry::TriangleMesh in_mm = moved(who.surface, lying, 1000.0f, Vec3f(3000, 10, 50));
    expect_found(in_mm, moved(who.surface, lying, 1.0f, Vec3f(3.0f, 0.01f, 0.05f)), 1.5);
    EXPECT_EQ(session().report().at("unit"), "mm");
    EXPECT_NEAR(session().report().at("up")[2].get<double>(), 1.0, 0.05);
}

TEST(ScanFit, UpsideDownAndTurned) {
    const Somebody who;
    const Mat3f turn =
        (Eigen::AngleAxisf(3.1415927f, Vec3f::UnitX()) * Eigen::AngleAxisf(2.0f, Vec3f::UnitY()))
            .toRotationMatrix();
    expect_found(moved(who.surface, turn), moved(who.surface, turn), 1.5);
    EXPECT_LT(session().report().at("up")[1].get<double>(), -0.9);
}

TEST(ScanFit, AMirroredScanIsTurnedOutside) {
    const Somebody who;
    geometry::TriangleMesh mirrored = who.surface;
    for (Vec3f& p : mirrored.positions)
        p.x() = -p.x();
    geometry::TriangleMesh outwards = mirrored;
    for (Triangle& t : outwards.triangles)
        std::swap(t[1], t[2]);
    expect_found(mirrored, outwards, 2.0);
    EXPECT_TRUE(session().report().at("triangles_faced_inwards").get<bool>());
}

TEST(ScanFit, HolesAndMissingFeet) {
    const Somebody who;
    geometry::TriangleMesh scan;
    scan.positions = who.surface.positions;
    for (const Triangle& t : who.surface.triangles) {
        const Vec3f& p = who.surface.positions[t[0]];
        const bool foot = p.y() < 0.12f;
        const bool hole = (p - Vec3f(0.1f, 1.2f, -0.1f)).norm() < 0.12f;
        if (!foot && !hole) scan.triangles.push_back(t);
    }
    session().begin({});
    session().add_scan(scan);
    session().fit({}, &serial_rows);
    const PosedLevel found = session().surface(0);
    EXPECT_LT(1000.0 * mean_distance(who.surface.positions,
                                     {found.positions, {}, adult().level(0).triangles}),
              4.0);
}

TEST(ScanFit, FloorAndClutterAreLeftOut) {
    const Somebody who;
    geometry::TriangleMesh scan = who.surface;
    geometry::TriangleMesh floor = test::grid(3.0f, 3.0f, 60, 60);
    const Mat3f down = Eigen::AngleAxisf(-1.5707963f, Vec3f::UnitX()).toRotationMatrix();
    add(scan, moved(floor, down, 1.0f, Vec3f(-1.4f, 0.0f, 1.3f)));
    add(scan, moved(test::sphere(0.3f, 4), Mat3f::Identity(), 1.0f, Vec3f(1.2f, 0.3f, 0.8f)));
    expect_found(scan, who.surface, 2.5);
    EXPECT_TRUE(session().report().at("floor_found").get<bool>());
    EXPECT_GT(session().report().at("removed_share").get<double>(), 0.1);
}

TEST(ScanFit, ACloudWithoutTriangles) {
    const Somebody who;
    geometry::TriangleMesh cloud;
    cloud.positions = sampled(who.surface, 30000).points;
    expect_found(cloud, who.surface, 2.5);
}

TEST(ScanFit, TheSameBytesEachTime) {
    const Somebody who;
    std::vector<Vec3f> first;
    for (int run = 0; run < 2; ++run) {
        session().begin({});
        session().add_scan(who.surface);
        // Ranges in another order, as threads would have them.
        const RowLoop backwards = [](std::uint32_t count, std::uint32_t grain, const auto& work) {
            const std::uint32_t ranges = (count + grain - 1) / grain;
            for (std::uint32_t r = ranges; r-- > 0;)
                work(r * grain, std::min(count, (r + 1) * grain));
        };
        session().fit({}, run == 0 ? RowLoop(&serial_rows) : backwards);
        const auto found = session().surface(0).positions;
        if (run == 0) first = found;
        for (std::size_t v = 0; v < found.size(); ++v)
            ASSERT_TRUE(first[v] == found[v]) << "vertex " << v;
    }
}

TEST(ScanFit, WhatIsNoPersonIsRefused) {
    const auto refused = [](const geometry::TriangleMesh& scan, const char* why) {
        session().begin({});
        session().add_scan(scan);
        EXPECT_ERROR(session().fit({}, &serial_rows), why);
        EXPECT_FALSE(session().fitted());
    };
    refused({}, "usable points");
    refused(moved(test::sphere(0.9f, 4), Mat3f::Identity()), "does not look like");
    geometry::TriangleMesh block;
    const geometry::TriangleMesh slab = test::grid(0.6f, 1.7f, 30, 60);
    add(block, slab);
    add(block, moved(slab, Mat3f::Identity(), 1.0f, Vec3f(0.0f, 0.0f, 0.4f)));
    refused(block, "does not look like");
    refused(moved(test::sphere(0.004f, 4), Mat3f::Identity()), "as large as a person");
    geometry::TriangleMesh bad = test::sphere(0.9f, 3);
    for (Vec3f& p : bad.positions)
        p.x() = std::nanf("");
    refused(bad, "usable points");
}

TEST(ScanFit, CanBeCancelled) {
    const Somebody who;
    session().begin({});
    session().add_scan(who.surface);
    SessionOptions options;
    options.progress = [](double share) { return share > 0.5; };
    EXPECT_THROW(session().fit(options, &serial_rows), Cancelled);
    EXPECT_FALSE(session().fitted());
}

} // namespace
} // namespace toile::scape_fit
