#include "apps/kiosk/garment_cards.h"

#include "apps/kiosk/inks.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

using render::Align;
using render::Ink;
using render::Rect;
using render::TextStyle;

constexpr Ink kPaper{240, 240, 238, 255};

const CarouselItem& item_beside(const ScreenView& view, int by) {
    const auto count = static_cast<int>(view.carousel.size());
    const int index = (static_cast<int>(view.chosen) + by) % count;
    return view.carousel[static_cast<std::size_t>((index + count) % count)];
}

} // namespace

void draw_card(render::Canvas& canvas, const CarouselItem& item, const Rect& place, bool chosen) {
    canvas.fill(place, kPaper, 0.05f * place.width);
    if (item.thumbnail != render::PictureId::none)
        canvas.picture(item.thumbnail, place.inset(0.03f * place.width));
    if (chosen) canvas.outline(place, kAccent, 0.05f * place.width, 0.05f * place.width);
}

void draw_carousel(render::Canvas& canvas, const ScreenView& view, const Rect& room) {
    const auto count = static_cast<int>(view.carousel.size());
    const int beside = std::min((count - 1) / 2, 1);
    const float tall = std::min(room.height, room.width / 2.2f);
    const float wide = 0.75f * tall;
    for (int i = -beside; count > 0 && i <= beside; ++i) {
        const float scale = i == 0 ? 1.0f : 0.72f;
        const Vec2f centre = room.centre() + Vec2f(static_cast<float>(i) * 0.95f * wide, 0.0f);
        draw_card(canvas, item_beside(view, i),
                  {centre.x() - 0.5f * scale * wide, centre.y() - 0.5f * scale * tall, scale * wide,
                   scale * tall},
                  i == 0);
    }
}

void draw_neighbours(render::Canvas& canvas, const ScreenView& view) {
    if (view.carousel.size() < 2) return;
    const Measures sizes = measures(canvas.width(), canvas.height());
    const auto w = static_cast<float>(canvas.width());
    const float tall = kCardHeight * static_cast<float>(canvas.height());
    const float wide = 0.75f * tall, y = sizes.cards;
    draw_card(canvas, item_beside(view, -1), {sizes.margin, y, wide, tall}, false);
    draw_card(canvas, item_beside(view, 1), {w - sizes.margin - wide, y, wide, tall}, false);
}

void draw_caption(render::Canvas& canvas, const Caption& caption) {
    const float text = measures(canvas.width(), canvas.height()).text;
    const Rect& place = caption.place;
    const TextStyle name{text, kWhite, Align::middle, true};
    const TextStyle advice{text, kSoft, Align::middle, false};
    const float pad = 0.4f * text;
    const float most = place.width - 2.0f * pad;
    // No wider than its words.
    const float words =
        std::max(canvas.text_width(caption.name, name), canvas.text_width(caption.advice, advice));
    const float room = std::min(most, words + 1.0f);
    const auto tall_of = [&](const std::string& said, const TextStyle& style) {
        return said.empty() ? 0.0f : canvas.paragraph_height(room, said, style);
    };
    const float tall = tall_of(caption.name, name) + tall_of(caption.advice, advice);
    if (tall == 0.0f) return;
    const float wide = room + 2.0f * pad;
    const float x = caption.align == Align::start ? place.x
                    : caption.align == Align::end ? place.x + place.width - wide
                                                  : place.centre().x() - 0.5f * wide;
    canvas.fill({x, place.y, wide, tall + pad}, kPanel, 0.5f * text);
    float y = place.y + 0.4f * pad;
    const float middle = x + 0.5f * wide;
    if (!caption.name.empty()) y += canvas.paragraph({middle, y}, room, caption.name, name);
    if (!caption.advice.empty()) canvas.paragraph({middle, y}, room, caption.advice, advice);
}

} // namespace toile::apps::kiosk
