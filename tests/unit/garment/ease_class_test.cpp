#include "garment/ease_class.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace toile::garment {
namespace {

using testing::HasSubstr;
using testing::Not;

const RegionRule& chest() {
    return region_rules().front();
}

TEST(EaseClass, MeansWhatCuttersMean) {
    EXPECT_DOUBLE_EQ(intended_ease_m(EaseClass::fitted, chest(), 0.9), 0.045);
    EXPECT_DOUBLE_EQ(intended_ease_m(EaseClass::semi_fitted, chest(), 0.9), 0.07);
    EXPECT_DOUBLE_EQ(intended_ease_m(EaseClass::loose, chest(), 0.9), 0.10);
    EXPECT_DOUBLE_EQ(intended_ease_m(EaseClass::very_loose, chest(), 0.9), 0.15);
    EXPECT_LT(intended_ease_m(EaseClass::stretch, chest(), 0.9), 0.0);
}

TEST(EaseClass, NearestClassOfItsOwnRoomIsItself) {
    for (const RegionRule& region : region_rules())
        for (const EaseClass c : {EaseClass::stretch, EaseClass::fitted, EaseClass::semi_fitted,
                                  EaseClass::loose, EaseClass::very_loose})
            EXPECT_EQ(nearest_class(intended_ease_m(c, region, 0.6), region, 0.6), c);
}

TEST(EaseClass, VerdictsGoFromTightToLooseWithTheRoom) {
    for (const RegionRule& region : region_rules())
        for (const EaseClass c : {EaseClass::stretch, EaseClass::fitted, EaseClass::very_loose}) {
            const double intended = intended_ease_m(c, region, 0.6);
            EXPECT_EQ(verdict_of(intended, intended, c, region, 0.6), Verdict::as_intended);
            Verdict last = Verdict::too_tight;
            for (double ease = -0.3; ease < 0.5; ease += 0.002) {
                const Verdict now = verdict_of(ease, intended, c, region, 0.6);
                EXPECT_GE(now, last);
                EXPECT_LE(static_cast<int>(now), static_cast<int>(last) + 1) << "one was skipped";
                last = now;
            }
            EXPECT_EQ(last, Verdict::too_loose);
        }
}

TEST(EaseClass, AFittedChestHasTheLimitsOfTheDocs) {
    const auto verdict = [](double ease) {
        return verdict_of(ease, 0.045, EaseClass::fitted, chest(), 0.9);
    };
    EXPECT_EQ(verdict(-0.006), Verdict::too_tight);
    EXPECT_EQ(verdict(0.010), Verdict::tight);
    EXPECT_EQ(verdict(0.021), Verdict::as_intended);
    EXPECT_EQ(verdict(0.069), Verdict::as_intended);
    EXPECT_EQ(verdict(0.080), Verdict::loose);
    EXPECT_EQ(verdict(0.096), Verdict::too_loose);
}

TEST(EaseClass, WordsNameTheNumberAndNoSizeThatIsNotThere) {
    EXPECT_THAT(verdict_text(Verdict::as_intended, 0.072, chest(), true, true),
                HasSubstr("7.2 cm of room around the chest"));
    EXPECT_THAT(verdict_text(Verdict::too_tight, -0.02, chest(), true, true),
                testing::AllOf(HasSubstr("2.0 cm shorter"), HasSubstr("next size up")));
    EXPECT_THAT(verdict_text(Verdict::too_tight, -0.02, chest(), true, false),
                Not(HasSubstr("next size")));
    EXPECT_THAT(verdict_text(Verdict::too_loose, 0.3, chest(), false, true),
                Not(HasSubstr("next size")));
}

TEST(EaseClass, ARegionMayDifferFromTheRest) {
    EaseIntent intent{EaseClass::fitted, {{FitRegion::hip, EaseClass::very_loose}}};
    EXPECT_EQ(intent.of(FitRegion::waist), EaseClass::fitted);
    EXPECT_EQ(intent.of(FitRegion::hip), EaseClass::very_loose);
    EXPECT_TRUE(EaseIntent{}.empty());
    EXPECT_EQ(EaseIntent{}.of(FitRegion::hip), EaseClass::invalid);
}

TEST(EaseClass, NamesReadBack) {
    for (const EaseClass c : {EaseClass::stretch, EaseClass::fitted, EaseClass::semi_fitted,
                              EaseClass::loose, EaseClass::very_loose})
        EXPECT_EQ(ease_class_from_name(name_of(c)), c);
    for (const RegionRule& region : region_rules())
        EXPECT_EQ(fit_region_from_name(name_of(region.region)), region.region);
    EXPECT_FALSE(ease_class_from_name("invalid"));
    EXPECT_FALSE(fit_region_from_name("nose"));
}

} // namespace
} // namespace toile::garment
