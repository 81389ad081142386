// Hands, touch and keys on the same buttons, and where the buttons stand.
#include "apps/kiosk/pointer.h"

#include <gtest/gtest.h>

namespace toile::test {
namespace {

using namespace apps::kiosk;

const std::vector<Button> kButtons = {{Action::agree, {100, 100, 200, 80}},
                                      {Action::decline, {100, 300, 200, 80}}};

Hand at(float x, float y, bool raised = true) {
    return {1, {x, y}, raised};
}

// Rests for `seconds` and returns what was pressed.
std::vector<Action> rest(Pointer& pointer, const Hand& hand, double seconds) {
    std::vector<Action> out;
    for (int i = 0; i < static_cast<int>(std::lround(seconds / 0.05)); ++i) {
        const Action pressed = pointer.hover({&hand, 1}, kButtons, 0.05);
        if (pressed != Action::invalid) out.push_back(pressed);
    }
    return out;
}

TEST(KioskPointer, AHandThatRestsPressesOnce) {
    Pointer pointer({});
    EXPECT_TRUE(rest(pointer, at(150, 140), 1.0).empty());
    EXPECT_NEAR(pointer.progress(), 1.0 / 1.2, 0.05);
    EXPECT_EQ(rest(pointer, at(150, 140), 6.0), std::vector{Action::agree});
    EXPECT_TRUE(rest(pointer, at(600, 600), 0.5).empty());
    EXPECT_EQ(rest(pointer, at(150, 140), 1.5), std::vector{Action::agree}) << "after leaving";
}

TEST(KioskPointer, AHandThatPassesOrHangsPressesNothing) {
    Pointer pointer({});
    for (int i = 0; i < 50; ++i) {
        EXPECT_TRUE(rest(pointer, at(150, 140), 0.5).empty());
        EXPECT_TRUE(rest(pointer, at(150, 340), 0.5).empty());
    }
    EXPECT_TRUE(rest(pointer, at(150, 140, false), 5.0).empty());
}

TEST(KioskPointer, AShortSlipKeepsWhatWasGathered) {
    Pointer pointer({});
    (void)rest(pointer, at(150, 140), 1.0);
    EXPECT_TRUE(rest(pointer, at(600, 600), 0.2).empty());
    EXPECT_EQ(rest(pointer, at(150, 140), 0.3), std::vector{Action::agree});
}

TEST(KioskPointer, ATremblingHandAtTheEdgeStaysOnItsButton) {
    Pointer pointer({});
    std::vector<Action> pressed;
    for (int i = 0; i < 30; ++i) {
        const Hand hand = at(150, i % 2 == 0 ? 178.0f : 190.0f);
        const Action now = pointer.hover({&hand, 1}, kButtons, 0.05);
        if (now != Action::invalid) pressed.push_back(now);
    }
    EXPECT_EQ(pressed, std::vector{Action::agree});
}

TEST(KioskPointer, ANewScreenUnderARestingHandIsNotPressed) {
    Pointer pointer({});
    EXPECT_EQ(rest(pointer, at(150, 140), 1.3), std::vector{Action::agree});
    pointer.forget();
    EXPECT_TRUE(rest(pointer, at(150, 140), 5.0).empty());
}

TEST(KioskPointer, TouchAndKeysGiveTheSameActions) {
    EXPECT_EQ(Pointer::tap({150, 340}, kButtons), Action::decline);
    EXPECT_EQ(Pointer::tap({50, 340}, kButtons), Action::invalid);
    Pointer pointer({});
    EXPECT_EQ(pointer.press_focus(kButtons), Action::invalid);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons), Action::agree);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons), Action::decline);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons), Action::agree);
    pointer.move_focus(-1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons), Action::decline);
}

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
            const auto buttons = lay_out(screen, offers, width, height, reach);
            ASSERT_EQ(buttons.size(), offers.size());
            for (std::size_t i = 0; i < buttons.size(); ++i) {
                const render::Rect& r = buttons[i].rect;
                EXPECT_EQ(buttons[i].action, offers[i]);
                EXPECT_GE(r.x, 0.0f);
                EXPECT_GE(r.y, 0.0f);
                EXPECT_LE(r.x + r.width, w);
                EXPECT_LE(r.y + r.height, h);
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
        for (const Button& button : lay_out(ScreenName::mirror, offers, width, height, reach)) {
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

INSTANTIATE_TEST_SUITE_P(Displays, KioskLayout,
                         testing::Values(Display{1080, 1920}, Display{1920, 1080},
                                         Display{540, 960}, Display{1280, 720}),
                         [](const auto& display) {
                             return std::to_string(display.param.width) + "x" +
                                    std::to_string(display.param.height);
                         });

} // namespace
} // namespace toile::test
