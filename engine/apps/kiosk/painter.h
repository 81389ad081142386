// Draws a screen of the mirror: a pure function of what it is told.
#pragma once

#include "apps/kiosk/guide.h"
#include "apps/kiosk/pointer.h"
#include "apps/kiosk/texts.h"
#include "render/canvas.h"

#include <array>
#include <string>
#include <vector>

namespace toile::apps::kiosk {

/// One garment of the carousel.
struct CarouselItem {
    render::PictureId thumbnail = render::PictureId::none;
    std::string name;
};

struct ScreenView {
    ScreenName screen = ScreenName::attract;
    double seconds = 0.0; ///< since the screen came up
    std::vector<Button> buttons;
    Action rested_on = Action::invalid;
    float progress = 0.0f; ///< of the dwell
    std::optional<Action> focus;
    float attention = 1.0f;   ///< [0, 1]: a hand is raised, or was a moment ago
    std::vector<Vec2f> hands; ///< raised ones, pixels
    bool declined = false;
    bool far_away = false; ///< somebody is there, but not on the mark

    Measuring measuring = Measuring::not_begun;
    double measured = 0.0;        ///< share of the fit that is done
    Side wanted = Side::front;    ///< of the turn
    std::array<bool, 4> turned{}; ///< front, left, back, right

    std::vector<CarouselItem> carousel;
    std::size_t chosen = 0;  ///< of the carousel
    std::string advice;      ///< the line on the size
    std::string size_button; ///< words of the button that changes it
    std::string note;        ///< to the shopper: a picture kept, a moment please
    bool comparing = false;

    std::vector<std::string> setup; ///< lines of the operator's page
    std::vector<std::string> operator_lines;
};

/// Lays the screen's words, buttons and figures over what `canvas` has; opaque screens fill it.
void paint(render::Canvas& canvas, const ScreenView& view, const Texts& texts);
/// Does a screen show the camera's picture beneath?
[[nodiscard]] bool shows_picture(ScreenName screen);

} // namespace toile::apps::kiosk
