// Colours that the mirror's pages share.
#pragma once

#include "render/canvas.h"

namespace toile::apps::kiosk {

inline constexpr render::Ink kWhite{255, 255, 255, 255};
inline constexpr render::Ink kSoft{214, 219, 222, 255};
inline constexpr render::Ink kAccent{244, 186, 96, 255};
inline constexpr render::Ink kPanel{12, 17, 20, 176};

} // namespace toile::apps::kiosk
