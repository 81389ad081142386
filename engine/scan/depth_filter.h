// Clean-up of depth pictures before they are fused (P1 2.4): each step by itself.
#pragma once

#include "core/row_loop.h"
#include "imaging/camera.h"
#include "scan/depth_view.h"

#include <optional>
#include <span>

namespace toile::scan {

struct FilterOptions {
    bool flying_pixels = true; ///< readings without neighbours at their depth are dropped
    int edge_pixels = 2; ///< this many beside a jump of depth or a shadow are dropped; 0: none
    bool joint_bilateral = true; ///< smoothing that stops at edges of depth and colour
    int radius = 3;              ///< of that smoothing, pixels
    double steepest = 1.1;       ///< radians off the normal; steeper readings are dropped
};

/// One picture of a camera: `depth` (width * height) metres, NaN where unknown; `color` of the same
/// size, or empty. Distortion is taken out by `undistorted`.
struct Picture {
    imaging::Intrinsics camera;
    std::span<const float> depth;
    std::span<const Rgba8> color;
};

/// Standard deviation of a triangulating sensor's depth, metres (Nguyen, Izadi, Lovell 2012).
[[nodiscard]] inline float depth_sigma(float metres) {
    return 0.0012f + 0.0019f * (metres - 0.4f) * (metres - 0.4f);
}
/// Least difference of neighbouring depths that is a jump and no slope, metres.
[[nodiscard]] inline float depth_jump(float metres) {
    return 0.012f + 0.009f * metres * metres;
}

/// The subject's pixels (`subject`, 1 for each) of a picture, filtered. \throw Error when the sizes
/// differ
[[nodiscard]] DepthView filtered_view(const Picture& picture, std::span<const std::uint8_t> subject,
                                      const FilterOptions& options, const RowLoop& rows);

/// How much rougher the readings are than `depth_sigma` has it: rms of what smoothing took off.
[[nodiscard]] double roughness(const DepthView& view);

/// Smoothing takes bends off: what it takes off a surface that is nearly the true one, seen from
/// the same place, is put back. `predicted` (pixels): depth of that surface, 0 or NaN where there
/// is none.
void take_off_bias(DepthView& view, std::span<const float> predicted, const FilterOptions& options);

/// The mean of several pictures of one camera and a still subject (P1 2.4): per pixel the mean of
/// the readings near the median; unknown where fewer than half read anything. All (pixels), NaN
/// where unknown.
[[nodiscard]] std::vector<float> averaged_depth(std::span<const std::vector<float>> pictures);

} // namespace toile::scan
