#include "body_tracker/joint_proposals.h"

#include <gtest/gtest.h>

namespace toile::body_tracker {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr float kFocal = 150.0f;
constexpr ImageCentre kCentre = {79.5f, 59.5f};

/// A labelled picture that squares of 9 pixels are put into.
struct Scene {
    std::vector<std::uint16_t> mm = std::vector<std::uint16_t>(kWidth * kHeight);
    std::vector<std::uint8_t> labels = std::vector<std::uint8_t>(kWidth * kHeight);
    std::vector<std::uint8_t> shares = std::vector<std::uint8_t>(kWidth * kHeight);

    void put(PartLabel part, int x, int y, std::uint16_t depth, std::uint8_t share = 255) {
        for (int v = y - 4; v <= y + 4; ++v)
            for (int u = x - 4; u <= x + 4; ++u) {
                const auto at = static_cast<std::size_t>(v * kWidth + u);
                mm[at] = depth;
                labels[at] = static_cast<std::uint8_t>(part);
                shares[at] = share;
            }
    }
    [[nodiscard]] PartProposals propose(PartLabel part, const ProposalOptions& options = {}) {
        JointProposer proposer(options);
        const DepthView view{kWidth, kHeight, kFocal, mm.data()};
        return proposer.propose(view, kCentre,
                                {1, labels, shares})[static_cast<std::size_t>(part) - 1];
    }
};

Vec3f point(int x, int y, float z) {
    return {(static_cast<float>(x) - kCentre.x_px) * z / kFocal,
            (kCentre.y_px - static_cast<float>(y)) * z / kFocal, -z};
}

TEST(JointProposals, FindTheMiddleOfAPart) {
    Scene scene;
    scene.put(PartLabel::left_hand, 40, 30, 2000);
    const auto found = scene.propose(PartLabel::left_hand);
    EXPECT_LT((found[0].position - point(40, 30, 2.0f)).norm(), 1e-4f);
    EXPECT_NEAR(found[0].area_m2, 81.0f * 4.0f / (kFocal * kFocal), 1e-5f);
    EXPECT_GT(found[0].confidence, 0.5f);
    EXPECT_EQ(found[1].confidence, 0.0f);
    EXPECT_EQ(scene.propose(PartLabel::right_hand)[0].confidence, 0.0f);
}

TEST(JointProposals, TheSurerOfTwoPlacesComesFirst) {
    Scene scene;
    scene.put(PartLabel::left_hand, 40, 30, 2000, 100);
    scene.put(PartLabel::left_hand, 120, 80, 2000, 250);
    const auto found = scene.propose(PartLabel::left_hand);
    EXPECT_LT((found[0].position - point(120, 80, 2.0f)).norm(), 1e-4f);
    EXPECT_LT((found[1].position - point(40, 30, 2.0f)).norm(), 1e-4f);
    EXPECT_GT(found[0].confidence, found[1].confidence);
    EXPECT_EQ(found[2].confidence, 0.0f);
}

TEST(JointProposals, WeighPixelsByTheSurfaceTheyCover) {
    Scene scene;
    scene.put(PartLabel::head, 40, 30, 1000);
    scene.put(PartLabel::head, 120, 80, 2000);
    const auto found = scene.propose(PartLabel::head);
    EXPECT_LT((found[0].position - point(120, 80, 2.0f)).norm(), 1e-4f);
    EXPECT_NEAR(found[0].area_m2 / found[1].area_m2, 4.0f, 1e-3f);
}

TEST(JointProposals, PushBackGoesAlongTheRay) {
    Scene scene;
    scene.put(PartLabel::head, 40, 30, 2000);
    ProposalOptions options;
    options.push_back_m[static_cast<std::size_t>(PartLabel::head) - 1] = 0.1f;
    const Vec3f surface = point(40, 30, 2.0f);
    const auto found = scene.propose(PartLabel::head, options);
    EXPECT_LT((found[0].position - surface - 0.1f * surface.normalized()).norm(), 1e-4f);
}

TEST(JointProposals, UnsurePixelsAreLeftOut) {
    Scene scene;
    scene.put(PartLabel::head, 40, 30, 2000, 63);
    EXPECT_EQ(scene.propose(PartLabel::head)[0].confidence, 0.0f);
}

TEST(JointProposals, TheForestsPushBackIsUsed) {
    Forest forest;
    forest.class_count = kPartCount;
    EXPECT_EQ(proposal_options(forest).push_back_m[3], 0.0f);
    forest.push_back_mm.assign(kPartCount, 0);
    forest.push_back_mm[3] = 125;
    EXPECT_FLOAT_EQ(proposal_options(forest).push_back_m[3], 0.125f);
    EXPECT_EQ(proposal_options(forest).push_back_m[4], 0.0f);
}

} // namespace
} // namespace toile::body_tracker
