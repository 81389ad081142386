#include "scape_fit/floor_contact.h"

#include "people.h"
#include "scape_fit/fit_solver.h"

namespace toile::scape_fit {
namespace {

const geometry::Plane kFloor{Vec3f(0.0f, 1.0f, 0.0f), 0.0f};
constexpr float kTooLow = 0.03f; // metres

/// Both feet with their toes turned down, radians.
body::Pose on_toes(const Somebody& who, float down) {
    body::Pose out = who.pose;
    for (const body::Joint foot : {body::Joint::left_foot, body::Joint::right_foot})
        out.rotations[static_cast<std::size_t>(foot)] = body::about(Vec3f::UnitX(), down);
    return out;
}

float lowest(const PosedLevel& posed) {
    float out = 1e9f;
    for (const Vec3f& p : posed.positions)
        out = std::min(out, p.y());
    return out;
}

TEST(FloorContact, AFootIsDrawnOutOfTheFloorFromAnyDepth) {
    const Somebody who;
    const FitLevel& level = adult().level(2);
    PosedLevel posed;
    Association contact;
    for (const float raised : {0.0f, -0.08f, -0.15f, -0.4f}) {
        body::Pose pose = who.pose;
        pose.hips_position.y() += raised;
        pose_level(adult(), level, who.shape, pose, posed);
        stand_on(level, posed, kFloor, contact);
        ASSERT_EQ(contact.pairs.size(), 2u) << raised << " m";
        float deepest = 1.0f;
        for (const VertexPair& pair : contact.pairs) {
            EXPECT_EQ(pair.kind, PairKind::floor);
            EXPECT_NEAR(pair.place.y(), 0.0f, 1e-6f);
            deepest = std::min(deepest, pair.distance);
        }
        EXPECT_NEAR(deepest, lowest(posed), 1e-6f);
    }
}

TEST(FloorContact, ALiftedFootIsLeftAlone) {
    const Somebody who;
    body::Pose pose = who.pose;
    pose.hips_position.y() += 0.3f;
    PosedLevel posed;
    pose_level(adult(), adult().level(2), who.shape, pose, posed);
    Association contact;
    stand_on(adult().level(2), posed, kFloor, contact);
    EXPECT_TRUE(contact.pairs.empty());
}

/// Their points were cut off with the floor, and the pose is possible: only the floor speaks.
TEST(FloorContact, FeetThatPointIntoTheFloorComeToStandOnIt) {
    Somebody who;
    who.pose.hips_position.y() -= kTooLow; // as where legs were found too long
    const FitLevel& level = adult().level(2);
    FitState state;
    state.shape = who.shape;
    state.poses = {on_toes(who, 0.75f)};
    FitPriors priors;
    priors.fix_shape = true;
    priors.pose_weight = 0.0;
    FitSolver solver(adult());
    std::vector<PosedLevel> posed(1);
    Association contact, body;
    // What the cameras see of the rest of the body holds it where it is.
    pose_level(adult(), level, who.shape, who.pose, posed[0]);
    for (std::uint32_t v = 0; v < level.vertices.size(); ++v) {
        if (posed[0].positions[v].y() < 0.25f) continue;
        for (int axis = 0; axis < 3; ++axis) {
            VertexPair pair;
            pair.vertex = v;
            pair.normal = Vec3f::Unit(axis);
            pair.place = posed[0].positions[v];
            pair.weight = level.areas[v];
            body.pairs.push_back(pair);
        }
    }
    const auto see = [&] {
        pose_level(adult(), level, who.shape, state.poses[0], posed[0]);
        stand_on(level, posed[0], kFloor, contact);
        for (VertexPair& pair : body.pairs)
            pair.distance = pair.normal.dot(posed[0].positions[pair.vertex] - pair.place);
    };
    see();
    ASSERT_LT(lowest(posed[0]), -0.10f) << "deep enough to have been forgotten";
    for (int round = 0; round < 20; ++round) {
        const std::vector<AssociatedView> views{{0, 0, std::nullopt, &body},
                                                {0, 0, std::nullopt, &contact}};
        (void)solver.step(level, posed, views, priors, 1e-3, &serial_rows, state);
        see();
    }
    EXPECT_GT(lowest(posed[0]), -kTooLow);
}

} // namespace
} // namespace toile::scape_fit
