#include "body_tracker/part_painter.h"

#include "drawn_room.h"

namespace toile::body_tracker {
namespace {

constexpr std::size_t kPixels = 320 * 240;

/// P4's part of each pixel of a person, as the forest's labels have it: the pose of `waving` drawn
/// alone.
struct Followed {
    DrawnRoom room;
    std::unique_ptr<BodyTracking> tracking;
    std::vector<std::uint8_t> parts, people;

    explicit Followed(int frames, std::size_t most = 1, bool second = false) {
        TrackingOptions options;
        options.person.forest = shipped_forest();
        options.most_people = most;
        tracking =
            std::make_unique<BodyTracking>(adult(), room.camera, room.world_from_camera, options);
        for (int f = 0; f < frames; ++f) {
            room.clear();
            room.add(waving(f), second ? -0.6f : 0.0f, 0.0f, 0.0f);
            if (second) room.add(waving(f + 9), 0.7f, 0.0f, 0.0f);
            tracking->update(room.depth.data(), frame_time(f));
        }
        parts.assign(kPixels, 99);
        people.assign(kPixels, 99);
        PartPainter painter(tracking->people()[0]->body(), options.person.forest.get(),
                            room.camera);
        painter.paint(*tracking, room.depth, parts, people);
    }
    /// Pixel of a true joint.
    [[nodiscard]] std::size_t pixel(std::size_t person, body::Joint joint) const {
        const auto p = imaging::project(
            room.camera,
            room.people[person][static_cast<std::size_t>(joint)].translation.cast<double>());
        return static_cast<std::size_t>(std::lround(p->y()) * 320 + std::lround(p->x()));
    }
    /// Middle of the bone between two joints.
    [[nodiscard]] body::Part at_bone(std::size_t person, body::Joint a, body::Joint b) const {
        const Vec3f middle = 0.5f * (room.people[person][static_cast<std::size_t>(a)].translation +
                                     room.people[person][static_cast<std::size_t>(b)].translation);
        const auto p = imaging::project(room.camera, middle.cast<double>());
        return static_cast<body::Part>(
            parts[static_cast<std::size_t>(std::lround(p->y()) * 320 + std::lround(p->x()))]);
    }
};

void expect_limbs(const Followed& followed, std::size_t person) {
    using body::Joint;
    using body::Part;
    EXPECT_EQ(followed.at_bone(person, Joint::left_upper_leg, Joint::left_lower_leg),
              Part::left_upper_leg);
    EXPECT_EQ(followed.at_bone(person, Joint::right_lower_leg, Joint::right_foot),
              Part::right_lower_leg);
    EXPECT_EQ(followed.at_bone(person, Joint::left_upper_arm, Joint::left_lower_arm),
              Part::left_upper_arm);
    EXPECT_EQ(followed.at_bone(person, Joint::right_lower_arm, Joint::right_hand),
              Part::right_lower_arm);
    EXPECT_EQ(followed.parts[followed.pixel(person, Joint::chest)],
              static_cast<std::uint8_t>(Part::torso));
}

TEST(PartPainter, NamesTheLimbsOfSomebodyTracked) {
    const Followed followed(8);
    ASSERT_EQ(followed.tracking->people()[0]->following(), Following::tracked);
    expect_limbs(followed, 0);
    std::array<std::size_t, 13> count{};
    for (std::size_t i = 0; i < kPixels; ++i) {
        ASSERT_LE(followed.parts[i], 12) << i;
        ASSERT_EQ(followed.parts[i] != 0, followed.people[i] != 0) << i;
        ASSERT_LE(followed.people[i], 1) << i;
        ++count[followed.parts[i]];
    }
    for (std::size_t part = 1; part < count.size(); ++part)
        EXPECT_GT(count[part], 10u) << "part " << part << " is seen and never named";
}

TEST(PartPainter, LabelsNothingButThePerson) {
    const Followed followed(8);
    DrawnRoom empty;
    empty.clear();
    std::size_t person = 0, labelled = 0, beside = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const bool is_person = followed.room.depth[i] < empty.depth[i] - 0.02f;
        person += is_person ? 1 : 0;
        labelled += is_person && followed.parts[i] != 0 ? 1 : 0;
        beside += !is_person && followed.parts[i] != 0 ? 1 : 0;
    }
    EXPECT_GT(static_cast<double>(labelled), 0.97 * static_cast<double>(person));
    EXPECT_LT(static_cast<double>(beside), 0.02 * static_cast<double>(person));
}

/// In the first frame nobody is tracked yet: the forest names the parts.
TEST(PartPainter, TheForestNamesThePartsOfSomebodyJustDetected) {
    const Followed followed(1);
    ASSERT_EQ(followed.tracking->people()[0]->following(), Following::detected);
    std::size_t named = 0;
    for (const std::uint8_t part : followed.parts)
        named += part != 0 ? 1 : 0;
    EXPECT_GT(named, 2000u);
    EXPECT_EQ(followed.at_bone(0, body::Joint::left_upper_leg, body::Joint::left_lower_leg),
              body::Part::left_upper_leg);
}

TEST(PartPainter, TwoPeopleAreKeptApart) {
    const Followed followed(10, 2, true);
    expect_limbs(followed, 0);
    expect_limbs(followed, 1);
    const std::uint8_t one = followed.people[followed.pixel(0, body::Joint::chest)];
    const std::uint8_t other = followed.people[followed.pixel(1, body::Joint::chest)];
    EXPECT_EQ(one + other, 3) << "persons 1 and 2";
}

} // namespace
} // namespace toile::body_tracker
