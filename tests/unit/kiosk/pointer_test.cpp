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
    EXPECT_EQ(Pointer::tap({150, 340}, kButtons), (Target{Action::decline, 0}));
    EXPECT_EQ(Pointer::tap({50, 340}, kButtons).action, Action::invalid);
    Pointer pointer({});
    EXPECT_EQ(pointer.press_focus(kButtons).action, Action::invalid);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons).action, Action::agree);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons).action, Action::decline);
    pointer.move_focus(1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons).action, Action::agree);
    pointer.move_focus(-1, kButtons);
    EXPECT_EQ(pointer.press_focus(kButtons).action, Action::decline);
}

TEST(KioskPointer, HandsPressTheButtonsOfTheirOwnPersonOnly) {
    const std::vector<Button> buttons = {{Action::next_garment, {0, 0, 100, 80}, 1},
                                         {Action::next_garment, {0, 100, 100, 80}, 2},
                                         {Action::agree, {0, 200, 100, 80}, 0}};
    for (const auto& [person, y, pressed] : {std::tuple{1u, 40.0f, true},
                                             {2u, 40.0f, false},
                                             {2u, 140.0f, true},
                                             {1u, 140.0f, false},
                                             {1u, 240.0f, true},
                                             {2u, 240.0f, true}}) {
        Pointer pointer({});
        Action last = Action::invalid;
        for (int i = 0; i < 40; ++i) {
            const Hand hand{person, {50, y}, true};
            const Action now = pointer.hover({&hand, 1}, buttons, 0.05);
            if (now != Action::invalid) last = now;
        }
        EXPECT_EQ(last != Action::invalid, pressed) << person << " at " << y;
        EXPECT_TRUE(!pressed || pointer.person() == person);
    }
    Pointer keys({});
    keys.move_focus(1, buttons);
    keys.move_focus(1, buttons);
    EXPECT_EQ(keys.press_focus(buttons), (Target{Action::next_garment, 2}))
        << "the same action of another person";
}

} // namespace
} // namespace toile::test
