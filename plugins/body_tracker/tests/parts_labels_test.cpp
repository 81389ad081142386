#include "body_tracker/parts_labels.h"

#include <gtest/gtest.h>
#include <set>

namespace toile::body_tracker {
namespace {

TEST(PartsLabels, SidesMirrorJointsAndParts) {
    for (int i = 1; i <= kPartCount; ++i) {
        const auto part = static_cast<PartLabel>(i);
        EXPECT_EQ(opposite_part(opposite_part(part)), part);
        EXPECT_EQ(part_joint(opposite_part(part)), body::opposite_joint(part_joint(part)));
    }
}

TEST(PartsLabels, GiveAllOfP4sParts) {
    std::set<body::Part> parts;
    for (int i = 1; i <= kPartCount; ++i)
        parts.insert(p4_part(static_cast<PartLabel>(i)));
    EXPECT_EQ(parts.size(), 12u);
    EXPECT_FALSE(parts.contains(body::Part::invalid));
}

TEST(PartsLabels, TheAdultHasEveryPartAndSidesOfItsOwn) {
    const auto model = body::load_body_model(body::find_avatar("adult"));
    const auto labels = label_vertices(model);
    ASSERT_EQ(labels.size(), model.rest.positions.size());
    std::array<int, kPartCount + 1> counts{};
    for (std::size_t v = 0; v < labels.size(); ++v) {
        ++counts[static_cast<std::size_t>(labels[v])];
        if (labels[v] == PartLabel::left_hand) EXPECT_GT(model.rest.positions[v].x(), 0.0f);
        if (labels[v] == PartLabel::right_foot) EXPECT_LT(model.rest.positions[v].x(), 0.0f);
    }
    EXPECT_EQ(counts[0], 0);
    for (int i = 1; i <= kPartCount; ++i)
        EXPECT_GT(counts[static_cast<std::size_t>(i)], 10) << "part " << i;
}

} // namespace
} // namespace toile::body_tracker
