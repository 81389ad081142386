// What programs that scan recordings share: rows on all cores, and a frame's colours.
#pragma once

#include "core/parallel.h"
#include "imaging/capture_folder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace toile::evaluation {

/// A RowLoop on all cores.
inline void rows_on_all(std::uint32_t count, std::uint32_t grain,
                        const std::function<void(std::uint32_t, std::uint32_t)>& body) {
    parallel_for((count + grain - 1) / grain, [&](std::size_t k) {
        const auto begin = static_cast<std::uint32_t>(k) * grain;
        body(begin, std::min(count, begin + grain));
    });
}

/// (pixels), or none.
inline std::vector<std::array<std::uint8_t, 4>> colors_of(const imaging::CaptureCamera& capture,
                                                          std::uint32_t frame) {
    std::vector<std::array<std::uint8_t, 4>> out;
    if (const auto color = capture.load_color(frame))
        for (std::size_t k = 0; k + 3 < color->pixels.size(); k += 4)
            out.push_back({color->pixels[k], color->pixels[k + 1], color->pixels[k + 2], 255});
    return out;
}

} // namespace toile::evaluation
