// How the screen is shared out between pictures, buttons and words.
#pragma once

#include "render/canvas.h"

#include <array>
#include <optional>

namespace toile::apps::kiosk {

enum class Arrangement {
    invalid,
    one,        ///< the picture fills the screen, buttons beside the shopper
    two_looks,  ///< of one shopper, side by side
    two_people, ///< each with buttons of their own
};

inline constexpr float kCardHeight = 0.10f; ///< of the screen's height

/// Sizes that follow from the screen's alone.
struct Measures {
    float text = 0.0f; ///< letters: a fortieth of the height, what is read from 2.5 m
    float title = 0.0f;
    float margin = 0.0f;
    float button = 0.0f; ///< height of a button
    float step = 0.0f;   ///< from one button to the next below it
    float edge = 0.0f;   ///< between buttons and the screen's edge: a hand held out is there
    float cards = 0.0f;  ///< top of the cards of the garments beside the chosen one
    float metre = 0.0f;  ///< of a shopper, where hands point to a panel instead of the picture
    render::Rect body;   ///< where sentences stand
};
[[nodiscard]] Measures measures(int width, int height);

/// Nothing stands over a picture of a stage with a panel; else the picture is the whole screen.
struct Stage {
    /// Of each look; the first one alone but for two looks.
    std::array<render::Rect, 2> pictures;
    std::optional<render::Rect> panel; ///< has the buttons, the carousel and the advice
    render::Rect carousel;             ///< in the panel, for two looks
    render::Rect words;                ///< the same, for the advice
};

/// `aspect`: width by height of the camera's picture, for the one that shows all of it.
[[nodiscard]] Stage stage_of(Arrangement arrangement, int width, int height, float aspect = 0.75f);

} // namespace toile::apps::kiosk
