#include "body_tracker/parts_clothes.h"

#include "body/body_model.h"

#include <gtest/gtest.h>

namespace toile::body_tracker {
namespace {

const body::BodyModel& woman() {
    static const body::BodyModel model = body::load_body_model(body::find_avatar("woman"));
    return model;
}

std::vector<Vec3f> dressed(const Outfit& outfit) {
    std::vector<Vec3f> out = woman().rest.positions;
    dress(outfit, woman().skeleton, woman().rest.normals, label_vertices(woman()), out);
    return out;
}

TEST(PartsClothes, NoOutfitLeavesTheBodyAsItIs) {
    EXPECT_EQ(dressed({}), woman().rest.positions);
}

TEST(PartsClothes, ClothLiesOutsideTheBodyAndNoFartherThanItMay) {
    Outfit outfit;
    outfit.top_m = 0.03f;
    outfit.bottom_m = 0.02f;
    outfit.folds = 7;
    const auto out = dressed(outfit);
    const auto labels = label_vertices(woman());
    std::size_t moved = 0;
    for (std::size_t v = 0; v < out.size(); ++v) {
        const Vec3f shift = out[v] - woman().rest.positions[v];
        EXPECT_LT(shift.norm(), 0.0301f);
        EXPECT_GE(shift.dot(woman().rest.normals[v]), -1e-6f);
        if (labels[v] == PartLabel::left_hand || labels[v] == PartLabel::head ||
            labels[v] == PartLabel::right_lower_arm)
            EXPECT_EQ(shift.norm(), 0.0f);
        moved += shift.norm() > 0.005f ? 1 : 0;
    }
    EXPECT_GT(moved, out.size() / 10);
}

TEST(PartsClothes, ASkirtClosesTheGapBetweenTheThighs) {
    Outfit outfit;
    outfit.skirt_m = 0.5f;
    const auto out = dressed(outfit);
    const float hip = woman().skeleton.rest(body::Joint::left_upper_leg).y();
    float before = 1.0f, after = 1.0f; // nearest to the middle, 25 to 35 cm below the hips
    for (std::size_t v = 0; v < out.size(); ++v) {
        const Vec3f& p = woman().rest.positions[v];
        if (p.x() < 0.0f || hip - p.y() < 0.25f || hip - p.y() > 0.35f) continue;
        before = std::min(before, p.x());
        after = std::min(after, out[v].x());
    }
    EXPECT_LT(after, 0.3f * before);
}

TEST(PartsClothes, OutfitsDifferAndStayInTheirBounds) {
    Random random(5);
    int skirts = 0, hair = 0;
    for (int k = 0; k < 500; ++k) {
        const Outfit outfit = draw_outfit(random);
        EXPECT_LE(outfit.top_m, 0.05f);
        EXPECT_LE(outfit.bottom_m, 0.05f);
        skirts += outfit.skirt_m > 0.0f ? 1 : 0;
        hair += outfit.hair_m > 0.0f ? 1 : 0;
    }
    EXPECT_GT(skirts, 30);
    EXPECT_LT(skirts, 150);
    EXPECT_GT(hair, 250);
}

} // namespace
} // namespace toile::body_tracker
