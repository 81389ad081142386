#include "apps/kiosk/layout.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

// Of an arm of 0.55 m, bent: from the shoulders' middle sideways, and up and down from them.
constexpr float kAside_m = 0.46f;
constexpr float kUp_m = 0.28f;
constexpr float kDown_m = 0.42f;
constexpr float kGap = 0.28f; // of a button's height

bool on_the_left(Action action) {
    return action == Action::decline || action == Action::previous_garment ||
           action == Action::next_size || action == Action::next_colour || action == Action::skip ||
           action == Action::live || action == Action::turn;
}

struct Column {
    float x = 0.0f; ///< left edge
    float width = 0.0f;
    std::vector<Action> actions;
};

// Stacked about `middle`, within the screen.
void stack(const Column& column, float middle, const Measures& sizes, float height,
           std::vector<Button>& out) {
    if (column.actions.empty()) return;
    const auto count = static_cast<float>(column.actions.size());
    const float step = (1.0f + kGap) * sizes.button;
    const float tall = count * step - kGap * sizes.button;
    const float highest = sizes.margin;
    const float lowest = std::max(highest, height - 2.0f * sizes.margin - tall);
    float y = std::clamp(middle - 0.5f * tall, highest, lowest);
    for (const Action action : column.actions) {
        out.push_back({action, {column.x, y, column.width, sizes.button}});
        y += step;
    }
}

} // namespace

Measures measures(int width, int height) {
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    Measures out;
    out.text = std::ceil(h / 40.0f);
    out.title = std::round(std::min(h / 20.0f, w / 13.0f));
    out.title = std::max(out.title, out.text);
    out.margin = std::round(0.03f * std::min(w, h));
    out.button = std::round(0.078f * h);
    const float wide = std::min(w - 2.0f * out.margin, 1.1f * h);
    out.body = {0.5f * (w - wide), out.margin, wide, h - 2.0f * out.margin};
    return out;
}

std::vector<Button> lay_out(ScreenName, const std::vector<Action>& offers, int width, int height,
                            const std::optional<Reach>& reach) {
    const Measures sizes = measures(width, height);
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    Column left;
    Column right;
    for (const Action action : offers)
        (on_the_left(action) ? left : right).actions.push_back(action);
    left.width = right.width = std::round(std::min(0.30f * w, 3.4f * sizes.button));
    float middle = 0.66f * h;
    // Up to the edges: a hand held out is there.
    const float edge = 0.25f * sizes.margin;
    left.x = edge;
    right.x = w - edge - right.width;
    if (reach && reach->metre > 0.0f) {
        middle = reach->shoulders.y() + 0.5f * (kDown_m - kUp_m) * reach->metre;
        // A button's inner edge is where the hand is; it never hides the trunk.
        const float aside = kAside_m * reach->metre;
        left.x = std::clamp(reach->shoulders.x() - aside - 0.5f * left.width, edge,
                            w - 2.0f * (sizes.margin + left.width));
        right.x = std::clamp(reach->shoulders.x() + aside - 0.5f * right.width,
                             left.x + left.width + sizes.margin, w - edge - right.width);
    }
    std::vector<Button> out;
    stack(left, middle, sizes, h, out);
    stack(right, middle, sizes, h, out);
    // In the order of the offers, which is that of the keyboard.
    std::stable_sort(out.begin(), out.end(), [&](const Button& a, const Button& b) {
        return std::find(offers.begin(), offers.end(), a.action) <
               std::find(offers.begin(), offers.end(), b.action);
    });
    return out;
}

} // namespace toile::apps::kiosk
