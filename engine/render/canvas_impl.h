// What Canvas keeps and Screen draws. Private to this folder.
#pragma once

#include "render/canvas.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace toile::render {

/// Letters in one weight, at each of the sizes of CanvasFonts.
using FontSizes = std::array<ImFont*, 2>;

class Canvas::Impl {
  public:
    explicit Impl(const CanvasFonts& fonts);

    [[nodiscard]] const ImFont* font(const TextStyle& style) const;

    ImFontAtlas atlas;
    FontSizes regular{};
    FontSizes bold{};
    ImDrawListSharedData shared;
    ImDrawList list;
    int width = 0;
    int height = 0;
};

} // namespace toile::render
