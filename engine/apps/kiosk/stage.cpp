#include "apps/kiosk/stage.h"

#include <algorithm>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

using render::Rect;

constexpr float kGap = 0.28f;            // between buttons, of a button's height
constexpr float kTall_m = 2.2f;          // that a mirror shows
constexpr float kRowsOfLooks = 4.0f;     // of buttons, in two columns
constexpr float kRowsOfPeople = 3.0f;    // in two columns for each
constexpr float kCaptionLines = 4.2f;    // above each one's buttons
constexpr float kBesideMiddle_m = 0.17f; // columns between two looks

// Two pictures above, buttons below.
Stage looks_upright(const Measures& sizes, float w, float h) {
    Stage out;
    const float tall = kRowsOfLooks * sizes.step + 2.0f * sizes.margin;
    const Rect panel{0.0f, h - tall, w, tall};
    const float top = 1.5f * sizes.margin + 1.5f * sizes.text;
    for (std::size_t i = 0; i < 2; ++i)
        out.pictures[i] = {static_cast<float>(i) * 0.5f * w, top, 0.5f * w, panel.y - top};
    const float column = 0.26f * w;
    out.carousel = {column, panel.y + sizes.margin, w - 2.0f * column, 0.42f * tall};
    out.words = {column, out.carousel.y + out.carousel.height + sizes.margin, w - 2.0f * column,
                 0.40f * tall};
    out.panel = panel;
    return out;
}

// Two pictures at the sides, buttons between them.
Stage looks_wide(const Measures& sizes, float w, float h) {
    Stage out;
    const float half = kBesideMiddle_m * sizes.metre + 3.4f * sizes.button + sizes.margin;
    const Rect panel{0.5f * w - half, 0.0f, 2.0f * half, h};
    const float top = 1.5f * sizes.margin + 1.5f * sizes.text;
    out.pictures[0] = {0.0f, top, panel.x, h - top};
    out.pictures[1] = {panel.x + panel.width, top, panel.x, h - top};
    const float below = 0.5f * (h + kRowsOfLooks * sizes.step);
    out.carousel = {panel.x, below + 0.5f * sizes.margin, panel.width, 0.12f * h};
    out.words = {panel.x, out.carousel.y + out.carousel.height + 0.5f * sizes.margin, panel.width,
                 3.0f * sizes.text};
    out.panel = panel;
    return out;
}

// The whole of the camera's picture above, each one's buttons below.
Stage people_upright(const Measures& sizes, float w, float h, float aspect) {
    Stage out;
    const float tall =
        kRowsOfPeople * sizes.step + kCaptionLines * sizes.text + 2.0f * sizes.margin;
    out.panel = Rect{0.0f, h - tall, w, tall};
    const float room = h - tall;
    const float wide = std::min(w, room * aspect);
    out.pictures[0] = {0.5f * (w - wide), 0.5f * (room - wide / aspect), wide, wide / aspect};
    return out;
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
    out.step = (1.0f + kGap) * out.button;
    out.edge = 0.25f * out.margin;
    out.metre = h / kTall_m;
    out.cards = h - out.margin - 1.2f * out.text - kCardHeight * h;
    const float wide = std::min(w - 2.0f * out.margin, 1.1f * h);
    out.body = {0.5f * (w - wide), out.margin, wide, h - 2.0f * out.margin};
    return out;
}

Stage stage_of(Arrangement arrangement, int width, int height, float aspect) {
    const Measures sizes = measures(width, height);
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    const bool upright = h > w;
    if (arrangement == Arrangement::two_looks)
        return upright ? looks_upright(sizes, w, h) : looks_wide(sizes, w, h);
    if (arrangement == Arrangement::two_people && upright)
        return people_upright(sizes, w, h, aspect);
    Stage out;
    out.pictures[0] = {0.0f, 0.0f, w, h};
    return out;
}

} // namespace toile::apps::kiosk
