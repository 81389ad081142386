// The visit of a shopper: what may follow what.
#include "apps/kiosk/screens.h"

#include <gtest/gtest.h>
#include <random>

namespace toile::test {
namespace {

using namespace apps::kiosk;

Moment somebody(double dt_s = 0.1, Measuring measuring = Measuring::not_begun) {
    return {dt_s, 1, measuring};
}
Moment nobody(double dt_s = 0.1) {
    return {dt_s, 0, Measuring::not_begun};
}

bool has(const std::vector<Effect>& effects, Effect effect) {
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

Screens asked() {
    Screens screens({});
    for (int i = 0; i < 8; ++i)
        screens.tick(somebody());
    return screens;
}

TEST(KioskScreens, WhoeverStopsIsAskedAndWhoPassesIsNot) {
    Screens passing({});
    for (int i = 0; i < 40; ++i) {
        passing.tick(somebody());
        passing.tick(nobody());
    }
    EXPECT_EQ(passing.now(), ScreenName::attract);
    EXPECT_EQ(asked().now(), ScreenName::consent);
}

TEST(KioskScreens, AWholeVisit) {
    Screens screens = asked();
    EXPECT_TRUE(screens.take_effects().empty());
    screens.act(Action::agree);
    EXPECT_EQ(screens.now(), ScreenName::measure);
    EXPECT_EQ(screens.take_effects(), std::vector{Effect::begin_measuring});
    screens.tick(somebody(0.1, Measuring::working));
    EXPECT_EQ(screens.now(), ScreenName::measure);
    screens.tick(somebody(0.1, Measuring::done));
    EXPECT_EQ(screens.now(), ScreenName::mirror);
    EXPECT_EQ(screens.take_effects(), std::vector{Effect::wear});
    screens.act(Action::next_garment);
    screens.act(Action::freeze);
    EXPECT_EQ(screens.now(), ScreenName::frozen);
    screens.act(Action::live);
    EXPECT_EQ(screens.now(), ScreenName::mirror);
    screens.act(Action::finish);
    EXPECT_EQ(screens.now(), ScreenName::goodbye);
    EXPECT_TRUE(has(screens.take_effects(), Effect::erase));
    for (int i = 0; i < 60; ++i)
        screens.tick(nobody());
    EXPECT_EQ(screens.now(), ScreenName::attract);
}

TEST(KioskScreens, NoMeansNotMeasuredAndNotAskedAgain) {
    Screens screens = asked();
    screens.act(Action::decline);
    EXPECT_EQ(screens.take_effects(), std::vector{Effect::erase});
    for (int i = 0; i < 3000; ++i)
        screens.tick(somebody());
    EXPECT_EQ(screens.now(), ScreenName::goodbye) << "still the same person";
    for (int i = 0; i < 40; ++i)
        screens.tick(nobody());
    EXPECT_EQ(screens.now(), ScreenName::attract);
}

TEST(KioskScreens, AQuestionWithoutAnAnswerCountsAsNo) {
    Screens screens = asked();
    for (int i = 0; i < 700; ++i)
        screens.tick(somebody());
    EXPECT_EQ(screens.now(), ScreenName::goodbye);
    EXPECT_TRUE(screens.declined());
}

TEST(KioskScreens, ActionsThatAScreenDoesNotOfferDoNothing) {
    Screens screens({});
    for (int a = 1; a < static_cast<int>(Action::open_setup); ++a)
        screens.act(static_cast<Action>(a));
    EXPECT_EQ(screens.now(), ScreenName::attract);
    EXPECT_TRUE(screens.take_effects().empty());
    Screens safe({}, true, true);
    safe.act(Action::open_setup);
    for (int i = 0; i < 50; ++i)
        safe.tick(somebody());
    EXPECT_EQ(safe.now(), ScreenName::safe);
}

TEST(KioskScreens, NothingIsMeasuredOrWornBeforeConsentAndAllIsErasedAfterwards) {
    std::mt19937 random(7);
    const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int run = 0; run < 40; ++run) {
        Screens screens({}, run % 2 == 0);
        bool agreed = false;
        bool kept = false; // something of a person
        double alone = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const bool there = upto(100) < (i / 200 % 2 == 0 ? 97 : 5);
            const auto measuring = static_cast<Measuring>(1 + upto(5));
            screens.tick({0.1, there ? 1u : 0u, measuring});
            alone = there ? 0.0 : alone + 0.1;
            if (upto(6) == 0) {
                const auto action = static_cast<Action>(1 + upto(16));
                if (screens.now() == ScreenName::consent && action == Action::agree) agreed = true;
                screens.act(action);
            }
            for (const Effect effect : screens.take_effects()) {
                if (effect == Effect::erase) {
                    agreed = kept = false;
                    continue;
                }
                ASSERT_TRUE(agreed) << "effect " << static_cast<int>(effect);
                kept = true;
            }
            ASSERT_FALSE(kept && alone > 3.05) << "kept of somebody who left";
        }
    }
}

TEST(KioskScreens, NamesComeBack) {
    for (int i = 1; i <= static_cast<int>(ScreenName::safe); ++i)
        EXPECT_EQ(screen_from_name(screen_name(static_cast<ScreenName>(i))),
                  static_cast<ScreenName>(i));
    for (int i = 1; i <= static_cast<int>(Action::close_setup); ++i)
        EXPECT_EQ(action_from_name(action_name(static_cast<Action>(i))), static_cast<Action>(i));
    EXPECT_EQ(screen_from_name("no such"), ScreenName::invalid);
}

} // namespace
} // namespace toile::test
