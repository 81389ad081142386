#include "drawn_room.h"

#include <cmath>
#include <limits>

namespace toile::body_tracker {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

BodyTracking tracking_in(const DrawnRoom& room, std::size_t people = 1) {
    TrackingOptions options;
    options.most_people = people;
    return {adult(), room.camera, room.world_from_camera, options};
}

std::size_t active(const BodyTracking& tracking) {
    std::size_t count = 0;
    for (const auto& person : tracking.people())
        count += person->active() ? 1 : 0;
    return count;
}

TEST(BodyTracking, SeesSomebodyInTheFirstFrameAndFollows) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    for (int f = 0; f < 40; ++f) {
        room.clear();
        room.add(waving(f), 0.1f, 0.2f, 0.2f);
        tracking.update(room.depth.data(), frame_time(f));
        const PersonTrack& person = *tracking.people()[0];
        ASSERT_TRUE(person.active()) << "frame " << f;
        EXPECT_EQ(person.id(), 1u);
        if (f < 4) continue;
        EXPECT_EQ(person.following(), Following::tracked) << "frame " << f;
        EXPECT_LT(mean_error(person, room.people[0]), 0.03f) << "frame " << f;
    }
}

TEST(BodyTracking, TellsFrontFromBack) {
    for (const float yaw : {0.0f, 3.1415f}) {
        DrawnRoom room;
        BodyTracking tracking = tracking_in(room);
        for (int f = 0; f < 6; ++f) {
            room.clear();
            room.add(waving(f), 0.0f, 0.0f, yaw);
            tracking.update(room.depth.data(), frame_time(f));
        }
        ASSERT_TRUE(tracking.people()[0]->active());
        EXPECT_LT(mean_error(*tracking.people()[0], room.people[0]), 0.04f) << yaw;
    }
}

TEST(BodyTracking, LearnsHowTallSomebodyIs) {
    for (const double tall : {-1.5, 1.5}) {
        body::ShapeVector shape = body::ShapeVector::Zero(adult().component_count());
        TrackedBody measure(adult());
        measure.set_stature(static_cast<float>(1.70 + 0.1 * tall));
        shape = measure.shape();
        DrawnRoom room;
        BodyTracking tracking = tracking_in(room);
        for (int f = 0; f < 40; ++f) {
            room.clear();
            room.add(waving(f), 0.0f, 0.0f, 0.3f, shape);
            tracking.update(room.depth.data(), frame_time(f));
        }
        const auto leg = [](const body::Skeleton& s) {
            return (s.rest(body::Joint::left_upper_leg) - s.rest(body::Joint::left_foot)).norm();
        };
        EXPECT_NEAR(leg(tracking.people()[0]->body().skeleton()), leg(adult().skeleton(shape)),
                    0.025f);
    }
}

/// Trunks of dressed people were taken to be 18 mm too near to the camera, and thick.
TEST(BodyTracking, LearnsHowFarClothesStandOffTheBody) {
    const body::ShapeVector mean = body::ShapeVector::Zero(adult().component_count());
    for (const Wear& wear : {Wear{}, Wear{0.02f, 0.025f, 0.02f, 0.02f, 0.03f, 0.03f}}) {
        DrawnRoom room;
        BodyTracking tracking = tracking_in(room);
        for (int f = 0; f < 150; ++f) {
            room.clear();
            room.add(waving(f), 0.0f, 0.2f, 0.2f * std::sin(0.05f * static_cast<float>(f)), mean,
                     wear);
            tracking.update(room.depth.data(), frame_time(f));
        }
        const PersonTrack& person = *tracking.people()[0];
        EXPECT_LT(mean_error(person, room.people[0]), 0.025f) << wear[0];
        EXPECT_NEAR(person.joints()[0].translation.z(), room.people[0][0].translation.z(), 0.01f)
            << wear[0];
        for (std::size_t part = 0; part < wear.size(); ++part)
            EXPECT_NEAR(person.body().wear()[part], wear[part], 0.008f) << part;
    }
}

/// Somebody tall who comes into view with the head cut off was taken to be of usual height, and
/// learned as that.
TEST(BodyTracking, LearnsHowTallSomebodyIsWhoCameTooNear) {
    TrackedBody tall(adult());
    tall.set_stature(1.90f);
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    for (int f = 0; f < 90; ++f) {
        room.clear();
        const float z = 1.9f - 0.035f * static_cast<float>(std::clamp(f - 15, 0, 50));
        room.add(waving(f), 0.0f, z, 0.2f, tall.shape());
        tracking.update(room.depth.data(), frame_time(f));
    }
    const auto neck = [](const body::Skeleton& s) {
        return s.rest(body::Joint::neck).y() - s.rest(body::Joint::left_toes).y();
    };
    EXPECT_NEAR(neck(tracking.people()[0]->body().skeleton()), neck(tall.skeleton()), 0.035f);
    EXPECT_LT(mean_error(*tracking.people()[0], room.people[0]), 0.03f);
}

TEST(BodyTracking, NobodyInAnEmptyRoomOrBehindAPlainBox) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    for (int f = 0; f < 20; ++f) {
        room.clear();
        if (f >= 10) // a flat panel as large as a person
            for (int y = 60; y < 200; ++y)
                for (int x = 140; x < 180; ++x)
                    room.depth[static_cast<std::size_t>(y * 320 + x)] = 3.0f;
        tracking.update(room.depth.data(), frame_time(f));
        EXPECT_EQ(active(tracking), 0u) << "frame " << f;
    }
}

TEST(BodyTracking, FurnitureOfAPersonsSizeIsNobodyAndDelaysNobody) {
    DrawnRoom room;
    TrackingOptions options;
    options.person.forest = shipped_forest();
    BodyTracking tracking(adult(), room.camera, room.world_from_camera, options);
    for (int f = 0; f < 12; ++f) {
        room.clear();
        room.add(waving(f), 0.3f, 0.2f, 0.2f);
        room.add_box({-1.4f, 0.0f, -0.2f}, {-0.75f, 1.75f, 0.1f}); // larger in view than the person
        tracking.update(room.depth.data(), frame_time(f));
        if (f < 5) continue;
        const PersonTrack& person = *tracking.people()[0];
        ASSERT_TRUE(person.active()) << "frame " << f;
        EXPECT_EQ(person.id(), 1u);
        EXPECT_LT(mean_error(person, room.people[0]), 0.05f) << "frame " << f;
    }
}

/// Where nothing is behind the person no reading comes: what an arm that was lost passed there was
/// learned as scene, so that it was never found again.
TEST(BodyTracking, AnArmThatLeapsBeforeNothingIsFoundAgain) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    const body::Skeleton& skeleton = adult().space().model().skeleton;
    for (int f = 0; f < 60; ++f) {
        const auto arms = f < 30 ? body::usual_arms()[0] : body::usual_arms()[2];
        const body::Pose hanging = body::usual_pose(skeleton, body::usual_arms()[0], 4.0f);
        room.clear();
        room.add(body::with_arm(hanging, true, body::usual_pose(skeleton, arms, 4.0f)), 0.0f, 0.2f,
                 0.1f);
        for (float& d : room.depth)
            if (d > 4.0f) d = kNaN;
        if (f >= 30) { // the upper arm is hidden, so that the rest hangs on nothing
            const Vec3f elbow =
                room.people[0][static_cast<std::size_t>(body::Joint::left_lower_arm)].translation;
            const auto x = static_cast<int>(159.5f - 290.0f * elbow.x() / elbow.z());
            for (int y = 0; y < 240; ++y)
                for (int k = x - 3; k <= x + 3; ++k)
                    room.depth[static_cast<std::size_t>(y * 320 + k)] = kNaN;
        }
        tracking.update(room.depth.data(), frame_time(f));
        if (f < 45) continue;
        const auto hand = static_cast<std::size_t>(body::Joint::left_hand);
        EXPECT_LT(
            (tracking.people()[0]->joints()[hand].translation - room.people[0][hand].translation)
                .norm(),
            0.08f)
            << "frame " << f;
    }
}

TEST(BodyTracking, GoesOnAfterBadFrames) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    const std::vector<float> none(room.camera.width * room.camera.height, kNaN);
    const std::vector<float> zero(none.size(), 0.0f), full(none.size(), 65.535f),
        near(none.size(), 0.4f);
    std::int64_t time = 0;
    for (int f = 0; f < 60; ++f) {
        room.clear();
        room.add(waving(f), 0.0f, 0.0f, 0.0f);
        const bool bad = f >= 20 && f < 28;
        const std::array<const float*, 4> kinds{none.data(), zero.data(), full.data(), near.data()};
        // Clocks that stand, go back and leap ahead.
        time = f == 10   ? time
               : f == 12 ? time - 1'000'000'000
               : f == 14 ? time + 3'600'000'000'000
                         : time + 33'333'333;
        tracking.update(bad ? kinds[static_cast<std::size_t>(f) % 4] : room.depth.data(), time);
        for (const RigidTransform& joint : tracking.people()[0]->joints())
            ASSERT_TRUE(joint.translation.allFinite()) << "frame " << f;
        if (bad) {
            EXPECT_NE(tracking.people()[0]->following(), Following::tracked) << f;
        }
    }
    ASSERT_TRUE(tracking.people()[0]->active());
    EXPECT_EQ(tracking.people()[0]->id(), 1u);
    EXPECT_LT(mean_error(*tracking.people()[0], room.people[0]), 0.03f);
}

TEST(BodyTracking, FindsSomebodyAgainWhoLeft) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room);
    for (int f = 0; f < 90; ++f) {
        room.clear();
        const bool away = f >= 30 && f < 75;
        if (!away) room.add(waving(f), f < 30 ? -0.3f : 0.5f, 0.0f, 0.0f);
        tracking.update(room.depth.data(), frame_time(f));
        if (f == 74) {
            EXPECT_NE(tracking.people()[0]->following(), Following::tracked);
        }
        if (f < 85) continue;
        ASSERT_TRUE(tracking.people()[0]->active());
        EXPECT_LT(mean_error(*tracking.people()[0], room.people[0]), 0.05f) << "frame " << f;
    }
}

TEST(BodyTracking, TwoPeopleWhoCrossKeepTheirNumbers) {
    DrawnRoom room;
    BodyTracking tracking = tracking_in(room, 2);
    std::array<std::uint32_t, 2> first{};
    for (int f = 0; f < 90; ++f) {
        room.clear();
        const float x = -0.9f + 0.02f * static_cast<float>(f);
        room.add(waving(f), x, 0.3f, 0.4f);
        room.add(waving(f + 20), -x, -0.5f, -0.4f);
        tracking.update(room.depth.data(), frame_time(f));
        if (f < 6) continue;
        for (std::size_t p = 0; p < 2; ++p) {
            const Vec3f hips = room.people[p][0].translation;
            const PersonTrack* nearest = nullptr;
            for (const auto& person : tracking.people())
                if (person->active() &&
                    (nearest == nullptr || (person->joints()[0].translation - hips).norm() <
                                               (nearest->joints()[0].translation - hips).norm()))
                    nearest = person.get();
            ASSERT_NE(nearest, nullptr);
            if (f == 6) first[p] = nearest->id();
            if (f == 89) {
                EXPECT_EQ(nearest->id(), first[p]);
            }
        }
    }
    EXPECT_NE(first[0], first[1]);
}

TEST(BodyTracking, TheSameFramesGiveTheSameBytes) {
    std::array<std::vector<float>, 2> runs;
    for (auto& run : runs) {
        DrawnRoom room;
        BodyTracking tracking = tracking_in(room);
        for (int f = 0; f < 25; ++f) {
            room.clear();
            room.add(waving(f), 0.0f, 0.1f, 0.5f);
            tracking.update(room.depth.data(), frame_time(f));
            for (const RigidTransform& joint : tracking.people()[0]->joints())
                run.insert(run.end(), {joint.translation.x(), joint.translation.y(),
                                       joint.rotation.x(), joint.rotation.w()});
        }
    }
    EXPECT_EQ(runs[0], runs[1]);
}

} // namespace
} // namespace toile::body_tracker
