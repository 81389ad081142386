// From a depth picture to a skeleton nothing allocates, once the shape is known: tracking, the
// trials of the other facing and of lost arms, and a search after a failure.
#include "allocations/allocation_counter.h"
#include "body_tracker/tests/drawn_room.h"

#include <gtest/gtest.h>

namespace toile::body_tracker {
namespace {

constexpr int kKnown = 155, kCounted = 45;
constexpr int kJump = kKnown + 35; // aside and into another pose: a search follows

TEST(TrackedFrame, AllocatesNothing) {
    DrawnRoom room;
    TrackingOptions options;
    options.person.forest = shipped_forest();
    BodyTracking tracking(adult(), room.camera, room.world_from_camera, options);
    const auto draw = [&](int frame) {
        room.clear();
        const float aside = frame < kJump ? 0.0f : 0.25f;
        room.add(waving(frame < kJump ? frame : frame + 30), aside, 0.2f,
                 frame < kJump ? 0.2f : 1.2f);
        return room.depth;
    };
    for (int f = 0; f < kKnown; ++f)
        tracking.update(draw(f).data(), frame_time(f));
    ASSERT_EQ(tracking.people()[0]->following(), Following::tracked);
    std::vector<std::vector<float>> pictures;
    for (int f = kKnown; f < kKnown + kCounted; ++f)
        pictures.push_back(draw(f));
    test::AllocationCount count;
    for (int f = 0; f < kCounted; ++f)
        tracking.update(pictures[static_cast<std::size_t>(f)].data(), frame_time(kKnown + f));
    EXPECT_EQ(count.stop(), 0u) << test::AllocationCount::first();
    EXPECT_EQ(tracking.people()[0]->following(), Following::tracked);
}

} // namespace
} // namespace toile::body_tracker
