// Where pictures, buttons and hands stand on screens of every shape.
#include "apps/kiosk/layout.h"

#include <gtest/gtest.h>

namespace toile::test {
namespace {

using namespace apps::kiosk;

struct Display {
    int width, height;
};

class KioskLayout : public testing::TestWithParam<Display> {};

// Shoulders of people of 1.4 and 2.1 m, and of somebody in a wheelchair, before a camera that shows
// 2.2 m of height; also beside the middle.
std::vector<Reach> reaches(int width, int height) {
    const float metre = static_cast<float>(height) / 2.2f;
    std::vector<Reach> out;
    for (const float shoulder : {1.0f, 1.15f, 1.75f})
        for (const float x : {0.3f, 0.5f, 0.7f})
            out.push_back({{x * static_cast<float>(width),
                            static_cast<float>(height) - (shoulder + 0.05f) * metre},
                           metre});
    return out;
}

TEST_P(KioskLayout, ButtonsAreOnTheScreenApartAndReadable) {
    const auto [width, height] = GetParam();
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    EXPECT_GE(measures(width, height).text, h / 40.0f);
    std::vector<std::optional<Reach>> all{std::nullopt};
    for (const Reach& reach : reaches(width, height))
        all.emplace_back(reach);
    for (const auto& reach : all)
        for (const ScreenName screen :
             {ScreenName::consent, ScreenName::measure, ScreenName::mirror, ScreenName::frozen}) {
            Screens screens({});
            std::vector<Action> offers;
            if (screen == ScreenName::mirror)
                offers = {Action::previous_garment, Action::next_garment, Action::next_size,
                          Action::next_colour,      Action::freeze,       Action::compare,
                          Action::snapshot,         Action::finish};
            else
                offers = {Action::agree, Action::decline, Action::finish};
            const auto buttons = lay_out(offers, width, height, {0, true, reach});
            ASSERT_EQ(buttons.size(), offers.size());
            for (std::size_t i = 0; i < buttons.size(); ++i) {
                const render::Rect& r = buttons[i].rect;
                EXPECT_EQ(buttons[i].action, offers[i]);
                EXPECT_GE(r.x, 0.0f);
                EXPECT_GE(r.y, 0.0f);
                EXPECT_LE(r.x + r.width, w);
                EXPECT_LE(r.y + r.height, h);
                if (screen == ScreenName::mirror) { // the cards of other garments stay clear
                    EXPECT_LE(r.y + r.height, measures(width, height).cards);
                }
                EXPECT_GE(r.height, 2.0f * measures(width, height).text);
                for (std::size_t j = 0; j < i; ++j) {
                    const render::Rect& o = buttons[j].rect;
                    const bool apart = r.x >= o.x + o.width || o.x >= r.x + r.width ||
                                       r.y >= o.y + o.height || o.y >= r.y + r.height;
                    EXPECT_TRUE(apart) << i << " and " << j;
                }
            }
        }
}

TEST_P(KioskLayout, EveryButtonIsWithinAnArmOfTheShoulder) {
    const auto [width, height] = GetParam();
    constexpr float kArm_m = 0.62f; // shoulder to middle of the hand, of somebody of 1.4 m: 0.53
    constexpr float kHalfShoulders = 0.16f;
    const std::vector<Action> offers = {
        Action::previous_garment, Action::next_garment, Action::next_size, Action::next_colour,
        Action::freeze,           Action::compare,      Action::finish};
    for (const Reach& reach : reaches(width, height)) {
        if (std::abs(reach.shoulders.x() / static_cast<float>(width) - 0.5f) > 0.1f) continue;
        for (const Button& button : lay_out(offers, width, height, {0, true, reach})) {
            // The nearest place of the button that a hand may rest on.
            const render::Rect r = button.rect.inset(0.2f * button.rect.height);
            const float side = r.centre().x() < reach.shoulders.x() ? -1.0f : 1.0f;
            const Vec2f shoulder =
                reach.shoulders + Vec2f(side * kHalfShoulders * reach.metre, 0.0f);
            const Vec2f nearest(std::clamp(shoulder.x(), r.x, r.x + r.width),
                                std::clamp(shoulder.y(), r.y, r.y + r.height));
            EXPECT_LE((nearest - shoulder).norm() / reach.metre, kArm_m)
                << action_name(button.action) << " at shoulder " << reach.shoulders.y();
        }
    }
}

// A body with hanging arms, 0.6 m wide.
render::Rect body_at(const Reach& reach) {
    const float half = 0.30f * reach.metre;
    return {reach.shoulders.x() - half, reach.shoulders.y() - 0.3f * reach.metre, 2.0f * half,
            1.8f * reach.metre};
}

bool apart(const render::Rect& a, const render::Rect& b) {
    return a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height ||
           b.y >= a.y + a.height;
}

void expect_inside(const render::Rect& inner, const render::Rect& outer) {
    EXPECT_GE(inner.x, outer.x - 0.5f);
    EXPECT_GE(inner.y, outer.y - 0.5f);
    EXPECT_LE(inner.x + inner.width, outer.x + outer.width + 0.5f);
    EXPECT_LE(inner.y + inner.height, outer.y + outer.height + 0.5f);
}

const std::vector<Action> kMirror = {
    Action::previous_garment, Action::next_garment, Action::next_size, Action::next_colour,
    Action::freeze,           Action::compare,      Action::snapshot,  Action::finish};
const std::vector<Action> kOwn = {Action::previous_garment, Action::next_garment, Action::next_size,
                                  Action::next_colour, Action::finish};

TEST_P(KioskLayout, NothingStandsOverAShopperInTheMiddle) {
    const auto [width, height] = GetParam();
    for (const Reach& reach : reaches(width, height)) {
        if (std::abs(reach.shoulders.x() / static_cast<float>(width) - 0.5f) > 0.01f) continue;
        for (const Button& button : lay_out(kMirror, width, height, {1, true, reach}))
            EXPECT_TRUE(apart(button.rect, body_at(reach))) << action_name(button.action);
    }
}

TEST_P(KioskLayout, TwoLooksAndTheirButtonsShareTheScreen) {
    const auto [width, height] = GetParam();
    const Stage stage = stage_of(Arrangement::two_looks, width, height);
    const render::Rect screen{0, 0, static_cast<float>(width), static_cast<float>(height)};
    ASSERT_TRUE(stage.panel);
    EXPECT_TRUE(apart(stage.pictures[0], stage.pictures[1]));
    // As tall as a shopper of 2.1 m needs, and wide enough for arms held out a little.
    for (const render::Rect& picture : stage.pictures) {
        expect_inside(picture, screen);
        EXPECT_TRUE(apart(picture, *stage.panel));
        EXPECT_GE(picture.height, 0.45f * screen.height);
        EXPECT_GE(picture.width / picture.height, 0.8f / 2.2f);
    }
    const auto buttons = lay_out_looks(kMirror, width, height, {1, true, {}});
    ASSERT_EQ(buttons.size(), kMirror.size());
    for (std::size_t i = 0; i < buttons.size(); ++i) {
        expect_inside(buttons[i].rect, *stage.panel);
        EXPECT_TRUE(apart(buttons[i].rect, stage.carousel));
        EXPECT_TRUE(apart(buttons[i].rect, stage.words));
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_TRUE(apart(buttons[i].rect, buttons[j].rect));
    }
    expect_inside(stage.carousel, *stage.panel);
    expect_inside(stage.words, *stage.panel);
}

// Hands beside the own shoulders reach every button of the panel, without a step.
TEST_P(KioskLayout, PanelsAreWithinAnArmOfTheShoulder) {
    const auto [width, height] = GetParam();
    const auto check = [](const std::vector<Button>& buttons, const Reach& reach) {
        for (const Button& button : buttons) {
            const render::Rect r = button.rect.inset(0.2f * button.rect.height);
            const float side = r.centre().x() < reach.shoulders.x() ? -1.0f : 1.0f;
            const Vec2f shoulder = reach.shoulders + Vec2f(side * 0.16f * reach.metre, 0.0f);
            const Vec2f nearest(std::clamp(shoulder.x(), r.x, r.x + r.width),
                                std::clamp(shoulder.y(), r.y, r.y + r.height));
            EXPECT_LE((nearest - shoulder).norm() / reach.metre, 0.62f)
                << action_name(button.action);
        }
    };
    const auto looks = panel_reach(Arrangement::two_looks, width, height, true);
    ASSERT_TRUE(looks);
    check(lay_out_looks(kMirror, width, height, {1, true, {}}), *looks);
    for (const bool left : {true, false})
        if (const auto own = panel_reach(Arrangement::two_people, width, height, left))
            check(lay_out_person(kOwn, width, height, {1, left, {}}), *own);
    EXPECT_FALSE(panel_reach(Arrangement::one, width, height, true));
}

TEST_P(KioskLayout, TwoPeopleHaveButtonsOfTheirOwnOnTheirOwnSide) {
    const auto [width, height] = GetParam();
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    const Stage stage = stage_of(Arrangement::two_people, width, height, 0.75f);
    EXPECT_EQ(stage.panel.has_value(), height > width);
    const float metre = h / 2.2f;
    std::vector<Button> all;
    std::vector<Reach> people;
    for (const bool left : {true, false}) {
        const Reach reach{{0.5f * w + (left ? -0.55f : 0.55f) * metre, h - 1.45f * metre}, metre};
        people.push_back(reach);
        const auto own = lay_out_person(kOwn, width, height, {left ? 1u : 2u, left, reach});
        ASSERT_EQ(own.size(), kOwn.size());
        for (const Button& button : own) {
            EXPECT_EQ(button.person, left ? 1u : 2u);
            EXPECT_EQ(button.rect.centre().x() < 0.5f * w, left);
            all.push_back(button);
        }
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (stage.panel) expect_inside(all[i].rect, *stage.panel);
        for (const Reach& reach : people)
            EXPECT_TRUE(stage.panel || apart(all[i].rect, body_at(reach)));
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_TRUE(apart(all[i].rect, all[j].rect)) << i << " and " << j;
    }
    // Somebody who has not been asked finds one button, apart from all others.
    const auto others = lay_out(kMirror, width, height, {1, true, people[0]});
    const Button asked =
        lay_out_beside(Action::agree, width, height, {2, false, people[1]}, others);
    EXPECT_EQ(asked.person, 2u);
    for (const Button& button : others)
        EXPECT_TRUE(apart(asked.rect, button.rect)) << action_name(button.action);
}

INSTANTIATE_TEST_SUITE_P(Displays, KioskLayout,
                         testing::Values(Display{1080, 1920}, Display{1920, 1080},
                                         Display{540, 960}, Display{1280, 720}),
                         [](const auto& display) {
                             return std::to_string(display.param.width) + "x" +
                                    std::to_string(display.param.height);
                         });

} // namespace
} // namespace toile::test
