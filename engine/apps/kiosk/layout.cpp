#include "apps/kiosk/layout.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

// Of an arm of 0.55 m, bent: up and down from the shoulders' middle.
constexpr float kUp_m = 0.28f;
constexpr float kDown_m = 0.42f;
constexpr float kLower_m = 0.5f * (kDown_m - kUp_m); // middle of that
// From the middle sideways: arms that hang end here, nothing covers them.
constexpr float kBody_m = 0.31f;
constexpr float kNarrowest = 0.23f;    // of an upright screen: words of nine letters
constexpr float kPanelOfPeople = 0.8f; // a metre of a hand's way, of what the mirror shows

bool on_the_left(Action action) {
    return action == Action::decline || action == Action::previous_garment ||
           action == Action::next_size || action == Action::next_colour ||
           action == Action::freeze || action == Action::skip || action == Action::live ||
           action == Action::turn;
}

struct Column {
    float x = 0.0f; ///< left edge
    float width = 0.0f;
    std::vector<Action> actions;
};

struct Columns {
    Column left, right;
};

Columns shared(const std::vector<Action>& offers) {
    Columns out;
    for (const Action action : offers)
        (on_the_left(action) ? out.left : out.right).actions.push_back(action);
    return out;
}

// Stacked about `middle`, within the screen.
void stack(const Column& column, float middle, const Measures& sizes, float height,
           std::uint32_t person, std::vector<Button>& out) {
    if (column.actions.empty()) return;
    const auto count = static_cast<float>(column.actions.size());
    const float tall = (count - 1.0f) * sizes.step + sizes.button;
    const float highest = sizes.margin;
    const float lowest = std::max(highest, height - 2.0f * sizes.margin - tall);
    float y = std::clamp(middle - 0.5f * tall, highest, lowest);
    for (const Action action : column.actions) {
        out.push_back({action, {column.x, y, column.width, sizes.button}, person});
        y += sizes.step;
    }
}

std::vector<Button> stacked(const Columns& columns, float middle, const Measures& sizes,
                            float height, std::uint32_t person, const std::vector<Action>& offers) {
    std::vector<Button> out;
    stack(columns.left, middle, sizes, height, person, out);
    stack(columns.right, middle, sizes, height, person, out);
    // In the order of the offers, which is that of the keyboard.
    std::stable_sort(out.begin(), out.end(), [&](const Button& a, const Button& b) {
        return std::find(offers.begin(), offers.end(), a.action) <
               std::find(offers.begin(), offers.end(), b.action);
    });
    return out;
}

float widest(const Measures& sizes, float w) {
    return std::round(std::min(0.30f * w, 3.4f * sizes.button));
}

// As wide as the room beside the body, if words find place there.
float width_in(float room, const Measures& sizes, float w) {
    const float most = widest(sizes, w);
    return std::round(std::clamp(room, std::min(kNarrowest * w, most), most));
}

} // namespace

std::vector<Button> lay_out(const std::vector<Action>& offers, int width, int height,
                            const Seat& seat) {
    const Measures sizes = measures(width, height);
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    Columns columns = shared(offers);
    Column& left = columns.left;
    Column& right = columns.right;
    left.width = right.width = widest(sizes, w);
    left.x = sizes.edge;
    right.x = w - sizes.edge - right.width;
    float middle = 0.66f * h;
    if (seat.reach && seat.reach->metre > 0.0f) {
        const Reach& reach = *seat.reach;
        middle = reach.shoulders.y() + kLower_m * reach.metre;
        const float from = reach.shoulders.x() - kBody_m * reach.metre;
        const float to = reach.shoulders.x() + kBody_m * reach.metre;
        left.width = width_in(from - sizes.edge, sizes, w);
        right.width = width_in(w - sizes.edge - to, sizes, w);
        left.x = std::clamp(from - left.width, sizes.edge,
                            w - 2.0f * sizes.margin - left.width - right.width);
        right.x = std::clamp(to, left.x + left.width + sizes.margin, w - sizes.edge - right.width);
    }
    // Cards of other garments stand beneath; `stack` keeps two margins off the end.
    const bool cards =
        std::find(offers.begin(), offers.end(), Action::previous_garment) != offers.end();
    return stacked(columns, middle, sizes, cards ? sizes.cards + sizes.margin : h, seat.person,
                   offers);
}

std::vector<Button> lay_out_looks(const std::vector<Action>& offers, int width, int height,
                                  const Seat& seat) {
    const Measures sizes = measures(width, height);
    const Stage stage = stage_of(Arrangement::two_looks, width, height);
    const render::Rect& panel = *stage.panel;
    Columns columns = shared(offers);
    const bool upright = height > width;
    const float wide =
        upright ? std::round(0.25f * panel.width) : widest(sizes, static_cast<float>(width));
    columns.left.width = columns.right.width = wide;
    columns.left.x = panel.x + (upright ? sizes.edge : 0.5f * sizes.margin);
    columns.right.x = panel.x + panel.width - wide - (upright ? sizes.edge : 0.5f * sizes.margin);
    return stacked(columns, panel.centre().y(), sizes, static_cast<float>(height), seat.person,
                   offers);
}

std::vector<Button> lay_out_person(const std::vector<Action>& offers, int width, int height,
                                   const Seat& seat) {
    const Measures sizes = measures(width, height);
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    std::vector<Button> out;
    if (const auto panel = stage_of(Arrangement::two_people, width, height).panel) {
        const float gap = 0.5f * sizes.margin;
        const float wide = (0.5f * w - 3.0f * gap) / 2.0f;
        const float left = (seat.on_the_left ? 0.0f : 0.5f * w) + gap;
        const float rows = std::ceil(0.5f * static_cast<float>(offers.size()));
        float y = panel->y + panel->height - 2.0f * sizes.margin - rows * sizes.step;
        for (std::size_t i = 0; i < offers.size(); ++i) {
            const float x = left + (i % 2 == 0 ? 0.0f : wide + gap);
            out.push_back({offers[i], {x, y, wide, sizes.button}, seat.person});
            if (i % 2 == 1) y += sizes.step;
        }
        return out;
    }
    Column column;
    column.actions = offers;
    column.width = widest(sizes, w);
    const Reach reach =
        seat.reach.value_or(Reach{{(seat.on_the_left ? 0.35f : 0.65f) * w, 0.4f * h}, sizes.metre});
    const float body = kBody_m * reach.metre;
    column.x =
        seat.on_the_left ? reach.shoulders.x() - body - column.width : reach.shoulders.x() + body;
    column.x = std::clamp(column.x, sizes.edge, w - sizes.edge - column.width);
    stack(column, reach.shoulders.y() + kLower_m * reach.metre, sizes, h, seat.person, out);
    return out;
}

Button lay_out_beside(Action action, int width, int height, const Seat& seat,
                      const std::vector<Button>& others) {
    const Measures sizes = measures(width, height);
    const auto w = static_cast<float>(width);
    const std::vector<Button> own = lay_out_person({action}, width, height, seat);
    Button out = own.front();
    const bool panel = stage_of(Arrangement::two_people, width, height).panel.has_value();
    const Reach reach = seat.reach.value_or(Reach{{0.5f * w, 0.0f}, 0.0f});
    const bool clear = std::abs(out.rect.centre().x() - reach.shoulders.x()) >=
                       0.5f * out.rect.width + 0.9f * kBody_m * reach.metre;
    if (!panel && clear) return out;
    // No room on the far side: beneath the other one's buttons, or above them.
    const render::Rect* low = nullptr;
    const render::Rect* high = nullptr;
    const auto outward = [&](const Button& button) {
        return seat.on_the_left ? -button.rect.x : button.rect.x;
    };
    float outermost = -w;
    for (const Button& button : others)
        outermost = std::max(outermost, outward(button));
    for (const Button& button : others) {
        if (outward(button) < outermost) continue;
        if (low == nullptr || button.rect.y > low->y) low = &button.rect;
        if (high == nullptr || button.rect.y < high->y) high = &button.rect;
    }
    if (low == nullptr) return out;
    out.rect = *low;
    out.rect.y += sizes.step;
    const float foot = static_cast<float>(height) - 2.0f * sizes.margin;
    if (out.rect.y + out.rect.height > foot) out.rect.y = high->y - sizes.step;
    return out;
}

std::optional<Reach> panel_reach(Arrangement arrangement, int width, int height, bool on_the_left) {
    const Stage stage = stage_of(arrangement, width, height);
    if (!stage.panel) return std::nullopt;
    const Measures sizes = measures(width, height);
    const bool people = arrangement == Arrangement::two_people;
    Reach out;
    out.metre = people ? kPanelOfPeople * sizes.metre : sizes.metre;
    const render::Rect& panel = *stage.panel;
    float x = panel.centre().x();
    if (people) x += (on_the_left ? -0.25f : 0.25f) * panel.width;
    // Buttons of two people stand at the panel's foot, beneath their captions.
    const float y = people ? panel.y + panel.height - 2.0f * sizes.margin - 1.5f * sizes.step
                           : panel.centre().y();
    out.shoulders = {x, y - kLower_m * out.metre};
    return out;
}

} // namespace toile::apps::kiosk
