// Pictures of garments, and what is said of the one that somebody wears.
#pragma once

#include "apps/kiosk/painter.h"

namespace toile::apps::kiosk {

/// One garment on a light card, with a frame when it is the chosen one.
void draw_card(render::Canvas& canvas, const CarouselItem& item, const render::Rect& place,
               bool chosen);

/// The chosen garment between its neighbours, in the middle of `room`.
void draw_carousel(render::Canvas& canvas, const ScreenView& view, const render::Rect& room);

/// What comes before and after the chosen one, in the corners at the shopper's feet.
void draw_neighbours(render::Canvas& canvas, const ScreenView& view);

/// Name and advice on a panel of their own; as tall as they need.
void draw_caption(render::Canvas& canvas, const Caption& caption);

} // namespace toile::apps::kiosk
