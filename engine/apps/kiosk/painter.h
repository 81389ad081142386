// Draws a screen of the mirror: a pure function of what it is told.
#pragma once

#include "apps/kiosk/guide.h"
#include "apps/kiosk/pointer.h"
#include "apps/kiosk/texts.h"
#include "render/canvas.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace toile::apps::kiosk {

/// One garment of the carousel.
struct CarouselItem {
    render::PictureId thumbnail = render::PictureId::none;
    std::string name;
};

/// What somebody wears, in words, above their buttons.
struct Caption {
    render::Rect place;
    render::Align align = render::Align::middle;
    std::string name = {};
    std::string advice = {};
};

/// A button that a hand rests on, and the share of the dwell that is over.
struct Rest {
    Target target;
    float progress = 0.0f;
};

struct ScreenView {
    ScreenName screen = ScreenName::attract;
    Arrangement arrangement = Arrangement::one;
    double seconds = 0.0; ///< since the screen came up
    std::vector<Button> buttons;
    std::vector<Rest> rests;
    std::optional<Target> focus;
    float attention = 1.0f;   ///< [0, 1]: a hand is raised, or was a moment ago
    std::vector<Vec2f> hands; ///< raised ones, pixels
    bool declined = false;
    bool far_away = false; ///< somebody is there, but not on the mark

    Measuring measuring = Measuring::not_begun;
    double measured = 0.0;        ///< share of the fit that is done
    Side wanted = Side::front;    ///< of the turn
    std::array<bool, 4> turned{}; ///< front, left, back, right

    std::vector<CarouselItem> carousel;
    std::size_t chosen = 0; ///< of the carousel
    std::vector<Caption> captions;
    std::map<std::uint32_t, std::string> size_buttons; ///< by Button::person: words
    std::string note; ///< to the shopper: a picture kept, a moment please

    std::vector<std::string> setup; ///< lines of the operator's page
    std::vector<std::string> operator_lines;
};

/// Lays the screen's words, buttons and figures over what `canvas` has; opaque screens fill it.
void paint(render::Canvas& canvas, const ScreenView& view, const Texts& texts);
/// Does a screen show the camera's picture beneath?
[[nodiscard]] bool shows_picture(ScreenName screen);

} // namespace toile::apps::kiosk
