// Where buttons stand: for any screen, and within reach of whoever stands before it.
#pragma once

#include "apps/kiosk/screens.h"
#include "render/canvas.h"

#include <optional>
#include <vector>

namespace toile::apps::kiosk {

/// The shopper's place on the screen, pixels: what a raised hand reaches.
struct Reach {
    Vec2f shoulders = Vec2f::Zero(); ///< middle between them
    float metre = 0.0f;              ///< pixels that a metre takes at the shopper's distance
};

struct Button {
    Action action = Action::invalid;
    render::Rect rect;
};

/// Sizes that follow from the screen's alone.
struct Measures {
    float text = 0.0f; ///< letters: a fortieth of the height, what is read from 2.5 m
    float title = 0.0f;
    float margin = 0.0f;
    float button = 0.0f; ///< height of a button
    render::Rect body;   ///< where sentences stand
};
[[nodiscard]] Measures measures(int width, int height);

/// Buttons for a screen's offers, in their order. With somebody there they stand in two columns
/// beside the shopper's body, from hip to a hand's breadth above the head: what one reaches with
/// the elbow at the side, also from a wheelchair. Nobody there: at two thirds of the height.
[[nodiscard]] std::vector<Button> lay_out(ScreenName screen, const std::vector<Action>& offers,
                                          int width, int height, const std::optional<Reach>& reach);

} // namespace toile::apps::kiosk
