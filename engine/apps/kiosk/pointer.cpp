#include "apps/kiosk/pointer.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

Target target_of(const Button& button) {
    return {button.action, button.person};
}

} // namespace

Target Pointer::under(std::span<const Hand> hands, std::span<const Button> buttons) {
    Target found;
    std::uint32_t whose = 0;
    for (const Hand& hand : hands) {
        if (!hand.raised) continue;
        for (const Button& button : buttons) {
            if (button.person != 0 && button.person != hand.person) continue;
            const bool own = target_of(button) == target_;
            const float slack = own ? options_.slack * button.rect.height : 0.0f;
            if (!button.rect.inset(-slack).contains(hand.place)) continue;
            if (own && hand.person == person_) return target_; // who came first keeps the button
            if (found.action != Action::invalid) continue;
            found = target_of(button);
            whose = hand.person;
        }
    }
    if (found.action != Action::invalid) person_ = whose;
    return found;
}

Action Pointer::hover(std::span<const Hand> hands, std::span<const Button> buttons, double dt_s) {
    const Target now = under(hands, buttons);
    if (now.action == Action::invalid) {
        off_s_ += dt_s;
        if (off_s_ > options_.forget_s) {
            target_ = {};
            rested_s_ = 0.0;
            spent_ = false;
        }
        return Action::invalid;
    }
    off_s_ = 0.0;
    if (now != target_) {
        const bool stays = spent_ && target_.action == Action::invalid;
        target_ = now;
        rested_s_ = 0.0;
        spent_ = stays;
    }
    if (spent_) return Action::invalid;
    rested_s_ += dt_s;
    if (rested_s_ < options_.dwell_s) return Action::invalid;
    spent_ = true;
    rested_s_ = 0.0;
    return now.action;
}

Target Pointer::tap(const Vec2f& place, std::span<const Button> buttons) {
    for (const Button& button : buttons)
        if (button.rect.contains(place)) return target_of(button);
    return {};
}

void Pointer::move_focus(int by, std::span<const Button> buttons) {
    if (buttons.empty()) {
        focus_.reset();
        return;
    }
    const auto count = static_cast<int>(buttons.size());
    int at = by > 0 ? -1 : 0;
    for (int i = 0; i < count; ++i)
        if (focus_ && target_of(buttons[static_cast<std::size_t>(i)]) == *focus_) at = i;
    focus_ = target_of(buttons[static_cast<std::size_t>(((at + by) % count + count) % count)]);
}

Target Pointer::press_focus(std::span<const Button> buttons) const {
    for (const Button& button : buttons)
        if (focus_ && target_of(button) == *focus_) return *focus_;
    return {};
}

float Pointer::progress() const {
    if (target_.action == Action::invalid || spent_) return 0.0f;
    return std::clamp(static_cast<float>(rested_s_ / options_.dwell_s), 0.0f, 1.0f);
}

void Pointer::forget() {
    target_ = {};
    rested_s_ = 0.0;
    off_s_ = 0.0;
    spent_ = true;
    focus_.reset();
}

} // namespace toile::apps::kiosk
