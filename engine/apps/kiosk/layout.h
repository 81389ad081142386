// Where buttons stand: for any screen, and within reach of whoever stands before it.
#pragma once

#include "apps/kiosk/screens.h"
#include "apps/kiosk/stage.h"

#include <optional>
#include <vector>

namespace toile::apps::kiosk {

/// A shopper's place on the screen, pixels: what a raised hand reaches.
struct Reach {
    Vec2f shoulders = Vec2f::Zero(); ///< middle between them
    float metre = 0.0f;              ///< pixels that a metre takes at the shopper's distance
};

struct Button {
    Action action = Action::invalid;
    render::Rect rect;
    std::uint32_t person = 0; ///< whose hands press it; 0: anybody's
};

/// Whose buttons are laid out.
struct Seat {
    std::uint32_t person = 0;
    bool on_the_left = true; ///< of two people, as seen on the screen
    std::optional<Reach> reach;
};

/// Buttons for a screen's offers, in their order. With somebody there they stand in two columns
/// beside the shopper's body, from hip to a hand's breadth above the head: what one reaches with
/// the elbow at the side, also from a wheelchair. Nobody there: at two thirds of the height.
[[nodiscard]] std::vector<Button> lay_out(const std::vector<Action>& offers, int width, int height,
                                          const Seat& seat);

/// The same for one shopper with two looks: in the panel.
[[nodiscard]] std::vector<Button> lay_out_looks(const std::vector<Action>& offers, int width,
                                                int height, const Seat& seat);

/// The same for one of two people: in the panel, or in a column on the far side of the other one.
[[nodiscard]] std::vector<Button> lay_out_person(const std::vector<Action>& offers, int width,
                                                 int height, const Seat& seat);

/// One button for somebody who stands beside a shopper that has `others`.
[[nodiscard]] Button lay_out_beside(Action action, int width, int height, const Seat& seat,
                                    const std::vector<Button>& others);

/// Where shoulders are when hands point to a panel instead of the picture: a hand beside the own
/// shoulder points beside this place. Nothing where there is no panel.
[[nodiscard]] std::optional<Reach> panel_reach(Arrangement arrangement, int width, int height,
                                               bool on_the_left);

} // namespace toile::apps::kiosk
