// People made outside of the body space: closed, of the wanted build, posed by their own rig, and
// made of what training never sees.
#include "body/held_out_modifiers.h"
#include "body/test_person_maker.h"
#include "geometry/nearest_surface.h"
#include "support/makehuman.h"
#include "support/throws.h"

#include <gmock/gmock.h>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

/// The data once for all tests; null where it is not at hand.
const MakeHumanData* shared_people_data() {
    static const std::unique_ptr<MakeHumanData> data = [] {
        const fs::path folder = test::makehuman_release();
        return folder.empty() ? nullptr : std::make_unique<MakeHumanData>(folder);
    }();
    return data.get();
}

/// Numbers 6 and 7 are the first heavy ones.
const TestPerson& person(std::uint32_t number) {
    static std::map<std::uint32_t, TestPerson> made;
    const auto found = made.find(number);
    if (found != made.end()) return found->second;
    return made.emplace(number, make_test_person(*shared_people_data(), number)).first->second;
}

#define NEEDS_PEOPLE_DATA()                                                                        \
    if (shared_people_data() == nullptr)                                                           \
    GTEST_SKIP() << "shared data set 'makehuman_cc0' is not here"

Pose bent(const Skeleton& skeleton) {
    Pose pose = rest_pose(skeleton);
    const auto turn = [&](Joint joint, float angle, const Vec3f& axis) {
        pose.rotations[static_cast<std::size_t>(joint)] =
            Quatf(Eigen::AngleAxisf(angle, axis.normalized()));
    };
    turn(Joint::hips, 0.3f, Vec3f::UnitY());
    turn(Joint::spine, 0.2f, Vec3f::UnitX());
    turn(Joint::left_upper_arm, -0.6f, Vec3f(0.2f, 0.1f, 1.0f));
    turn(Joint::left_lower_arm, 0.9f, Vec3f(0.3f, 1.0f, 0.2f));
    turn(Joint::left_hand, 0.5f, Vec3f(1.0f, -1.0f, 0.0f));
    turn(Joint::right_upper_leg, -0.5f, Vec3f::UnitX());
    turn(Joint::right_lower_leg, 0.8f, Vec3f::UnitX());
    turn(Joint::neck, 0.3f, Vec3f::UnitY());
    pose.hips_position += Vec3f(0.1f, -0.05f, 0.3f);
    return pose;
}

TEST(TestPeople, AreClosedAdultsOfTheWantedBuild) {
    NEEDS_PEOPLE_DATA();
    for (const std::uint32_t number : {0u, 1u, 6u, 7u}) {
        const TestPerson& made = person(number);
        EXPECT_EQ(made.woman, number % 2 == 0);
        EXPECT_TRUE(geometry::check_topology(made.rest.positions, made.rest.triangles).closed());
        EXPECT_GT(geometry::volume(made.rest), 0.03);
        EXPECT_THAT(made.lengths.at("stature"), testing::AllOf(testing::Gt(1.4), testing::Lt(2.0)));
        if (number >= 6) {
            EXPECT_GT(made.bmi, 35.0) << made.id;
        } else {
            EXPECT_THAT(made.bmi, testing::AllOf(testing::Gt(17.5), testing::Lt(34.5)));
        }
        float lowest = 1.0f;
        for (const Vec3f& p : made.rest.positions)
            lowest = std::min(lowest, p.y());
        EXPECT_EQ(lowest, 0.0f);
        EXPECT_EQ(made.bones.size(), 163u);
        for (const auto& row : made.weights) {
            float sum = 0.0f;
            for (const BoneWeight& w : row)
                sum += w.weight;
            EXPECT_NEAR(sum, 1.0f, 1e-4f);
        }
    }
}

TEST(TestPeople, HoldWhatTrainingNeverSees) {
    NEEDS_PEOPLE_DATA();
    TestPeopleOptions options;
    options.out_of_model = false;
    const TestPerson in_model = make_test_person(*shared_people_data(), 0, options);
    for (const auto& [name, amount] : in_model.recipe)
        EXPECT_FALSE(held_out(name)) << name;
    EXPECT_EQ(in_model.displacement_m, 0.0);
    for (const std::string_view family : kHeldOutModifiers) {
        const auto& recipe = person(0).recipe;
        EXPECT_TRUE(std::any_of(recipe.begin(), recipe.end(), [&](const auto& entry) {
            return entry.first.starts_with(family) && entry.second > 0.0;
        })) << family;
    }
    EXPECT_THAT(person(0).displacement_m, testing::AllOf(testing::Ge(0.003), testing::Le(0.005)));
    // Left and right differ: mirrored vertices lie off the surface.
    const auto asymmetry = [](const TestPerson& made) {
        const geometry::NearestSurface surface(made.rest.positions, made.rest.triangles);
        double sum = 0.0;
        for (const Vec3f& p : made.rest.positions)
            sum += static_cast<double>(surface.nearest(Vec3f(-p.x(), p.y(), p.z())).distance);
        return sum / static_cast<double>(made.rest.positions.size());
    };
    EXPECT_GT(asymmetry(person(0)), 10.0 * asymmetry(in_model));
    EXPECT_GT(asymmetry(person(0)), 0.001);
}

TEST(TestPeople, DisplacementsHaveTheirSizeAndAreSmooth) {
    NEEDS_PEOPLE_DATA();
    TestPeopleOptions options;
    options.least_displacement_m = options.most_displacement_m = 0.0;
    const TestPerson plain = make_test_person(*shared_people_data(), 1, options);
    const TestPerson& bumpy = person(1);
    std::vector<float> size;
    for (std::size_t v = 0; v < plain.rest.positions.size(); ++v)
        if (plain.parts[v] == Part::torso || plain.parts[v] == Part::pelvis)
            size.push_back((bumpy.rest.positions[v] - plain.rest.positions[v]).norm());
    std::sort(size.begin(), size.end());
    const auto most = static_cast<double>(size[size.size() * 95 / 100]);
    EXPECT_THAT(most, testing::AllOf(testing::Gt(0.5 * bumpy.displacement_m),
                                     testing::Lt(2.0 * bumpy.displacement_m)));
    // Along an edge of a centimetre or so they change by a fraction of that.
    double steepest = 0.0;
    for (const Triangle& t : plain.rest.triangles) {
        if (plain.parts[t[0]] != Part::torso || plain.parts[t[1]] != Part::torso) continue;
        const Vec3f change = (bumpy.rest.positions[t[1]] - plain.rest.positions[t[1]]) -
                             (bumpy.rest.positions[t[0]] - plain.rest.positions[t[0]]);
        steepest = std::max(steepest, static_cast<double>(change.norm()));
    }
    EXPECT_LT(steepest, 0.003);
}

TEST(TestPeople, TheRestPoseGivesTheRestSurface) {
    NEEDS_PEOPLE_DATA();
    TestPersonPoser poser(person(0));
    for (std::size_t v = 0; v < poser.positions().size(); ++v)
        EXPECT_LT((poser.positions()[v] - person(0).rest.positions[v]).norm(), 1e-5f);
    for (std::size_t j = 0; j < kJointCount; ++j)
        EXPECT_LT((poser.joints()[j].translation - person(0).skeleton.rest_positions[j]).norm(),
                  1e-5f);
}

TEST(TestPeople, TurnAsOurJointsDo) {
    NEEDS_PEOPLE_DATA();
    TestPersonPoser poser(person(0));
    const Pose pose = bent(person(0).skeleton);
    const RigidTransform place{Quatf(Eigen::AngleAxisf(0.7f, Vec3f::UnitY())),
                               Vec3f(1.0f, 0.0f, 2.0f)};
    poser.pose(pose, place);
    const JointTransforms ours = forward_kinematics(person(0).skeleton, pose);
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const RigidTransform wanted = place * ours[j];
        EXPECT_LT(poser.joints()[j].rotation.angularDistance(wanted.rotation), 1e-3f) << j;
        // The spine bends in two places instead of one: joints above lie a little elsewhere.
        EXPECT_LT((poser.joints()[j].translation - wanted.translation).norm(), 0.03f) << j;
    }
    EXPECT_LT((poser.joints()[0].translation - place * pose.hips_position).norm(), 1e-5f);
    // Whole turns move everything rigidly.
    Pose turned = rest_pose(person(0).skeleton);
    poser.pose(turned, place);
    for (std::size_t v = 0; v < poser.positions().size(); v += 97)
        EXPECT_LT((poser.positions()[v] - place * person(0).rest.positions[v]).norm(), 1e-4f);
    poser.pose(pose);
    const geometry::NearestSurface surface(poser.positions(), person(0).rest.triangles);
    for (const Joint joint : {Joint::left_lower_arm, Joint::right_lower_leg, Joint::chest})
        EXPECT_LT(surface.nearest(poser.joints()[static_cast<std::size_t>(joint)].translation)
                      .signed_distance,
                  0.0f);
}

TEST(TestPeople, GirthsAreThoseOfTheirPlanes) {
    NEEDS_PEOPLE_DATA();
    for (const std::uint32_t number : {0u, 1u, 6u}) {
        const TestPerson& made = person(number);
        std::map<std::string, double> girth;
        for (const GirthPlane& plane : made.girths) {
            const auto again = girth_in(plane, {}, made.rest.positions, made.rest.triangles);
            ASSERT_TRUE(again) << plane.name;
            EXPECT_NEAR(*again, plane.girth, 1e-4) << plane.name;
            girth[plane.name] = plane.girth;
        }
        EXPECT_EQ(made.girths.size(), 16u);
        EXPECT_THAT(girth["waist_girth"], testing::AllOf(testing::Gt(0.55), testing::Lt(1.5)));
        EXPECT_THAT(girth["hip_girth"], testing::AllOf(testing::Gt(0.75), testing::Lt(1.6)));
        EXPECT_THAT(girth["neck_girth"], testing::AllOf(testing::Gt(0.26), testing::Lt(0.55)));
        EXPECT_THAT(girth["left_wrist_girth"], testing::AllOf(testing::Gt(0.1), testing::Lt(0.24)));
        EXPECT_GT(girth["left_thigh_girth"], girth["left_calf_girth"]);
        EXPECT_GT(girth["left_calf_girth"], girth["left_ankle_girth"]);
        EXPECT_NEAR(girth["left_knee_girth"], girth["right_knee_girth"], 0.03);
        // A girth moves with its joint: a turned trunk keeps it.
        TestPersonPoser poser(made);
        Pose pose = rest_pose(made.skeleton);
        pose.rotations[0] = Quatf(Eigen::AngleAxisf(1.0f, Vec3f::UnitY()));
        poser.pose(pose);
        for (const GirthPlane& plane : made.girths) {
            const auto moved =
                girth_in(plane, poser.moved(plane.joint), poser.positions(), made.rest.triangles);
            ASSERT_TRUE(moved) << plane.name;
            EXPECT_NEAR(*moved, plane.girth, 1e-3) << plane.name;
        }
    }
}

TEST(TestPeople, EveryPartIsLabelled) {
    NEEDS_PEOPLE_DATA();
    std::map<Part, std::size_t> count;
    for (const Part part : person(0).parts)
        ++count[part];
    EXPECT_EQ(count.count(Part::invalid), 0u);
    EXPECT_EQ(count.size(), 12u);
    const auto& made = person(0);
    for (std::size_t v = 0; v < made.parts.size(); ++v)
        if (made.parts[v] == Part::left_lower_leg) {
            EXPECT_GT(made.rest.positions[v].x(), 0.0f);
        }
}

TEST(TestPeople, AreReadBackAsTheyWereWritten) {
    NEEDS_PEOPLE_DATA();
    const test::TemporaryFolder folder;
    const TestPerson& made = person(0);
    save_test_person(made, folder / "person");
    const TestPerson read = load_test_person(folder / "person");
    EXPECT_EQ(read.id, made.id);
    EXPECT_EQ(read.recipe, made.recipe);
    EXPECT_EQ(read.parts, made.parts);
    EXPECT_EQ(read.landmarks, made.landmarks);
    EXPECT_EQ(read.rest.triangles, made.rest.triangles);
    ASSERT_EQ(read.rest.positions.size(), made.rest.positions.size());
    for (std::size_t v = 0; v < made.rest.positions.size(); ++v)
        ASSERT_EQ(read.rest.positions[v], made.rest.positions[v]);
    ASSERT_EQ(read.girths.size(), made.girths.size());
    TestPersonPoser one(made);
    TestPersonPoser other(read);
    one.pose(bent(made.skeleton));
    other.pose(bent(read.skeleton));
    for (std::size_t v = 0; v < one.positions().size(); ++v)
        ASSERT_LT((one.positions()[v] - other.positions()[v]).norm(), 1e-5f);
    fs::remove(folder / "person" / "person.glb");
    EXPECT_ERROR((void)load_test_person(folder / "person"), "person.glb");
    EXPECT_ERROR((void)load_test_person(folder / "nobody"), "person.json");
}

TEST(TestPeople, AreTheSameAgainAndOthersForOtherSeeds) {
    NEEDS_PEOPLE_DATA();
    const TestPerson again = make_test_person(*shared_people_data(), 1);
    EXPECT_EQ(again.recipe, person(1).recipe);
    ASSERT_EQ(again.rest.positions.size(), person(1).rest.positions.size());
    for (std::size_t v = 0; v < again.rest.positions.size(); ++v)
        ASSERT_EQ(again.rest.positions[v], person(1).rest.positions[v]);
    TestPeopleOptions options;
    options.seed = 2;
    EXPECT_NE(make_test_person(*shared_people_data(), 1, options).recipe, person(1).recipe);
}

} // namespace
} // namespace toile::body
