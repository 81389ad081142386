// What a Kinect makes of a clean depth picture: formulas, and a whole picture's noise.
#pragma once

#include "core/random.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::imaging {

/// Projector to camera of a Kinect v1, metres.
inline constexpr double kKinectBaseline_m = 0.075;
/// Focal length of a Kinect v1's own picture (640 columns, 57 degrees), pixels.
inline constexpr double kKinectFocal_px = 589.4;
/// Steps of disparity a pixel.
inline constexpr double kDisparitySteps = 8.0;

/// Nguyen, Izadi, Lovell 2012: deviation of the depth `z` metres of a surface whose normal is
/// `tilt` radians from the ray, metres. Tilts beyond 82 degrees count as 82 (they measured to 80).
[[nodiscard]] double axial_sigma(double z, double tilt);
/// The same for a silhouette's place in the picture, pixels of the sensor.
[[nodiscard]] double lateral_sigma(double tilt);
/// Depth whose disparity is the nearest multiple of 1/8 pixel. `baseline_focal` metres x pixels.
[[nodiscard]] double quantise_disparity(double z, double baseline_focal);

/// Each effect has a switch.
struct DepthNoise {
    bool axial = true;        ///< see axial_sigma
    bool lateral = true;      ///< silhouettes wander: see lateral_sigma
    bool quantisation = true; ///< see quantise_disparity
    bool shadow = true;       ///< no reading where the projector, to the right, does not reach
    bool ragged = true;       ///< readings lost beside silhouettes and on grazing surfaces
};

/// Makes a picture noisy that may be coarser than the sensor's: each of its pixels is one of the
/// sensor's, so that what happens along silhouettes becomes rarer. Buffers are kept between calls.
class DepthNoiseMaker {
  public:
    explicit DepthNoiseMaker(const DepthNoise& noise) : noise_(noise) {}

    /// Changes `mm` (width * height), 0 = nothing there, in place; `source` (the same size)
    /// becomes the pixel that each reading was taken from, so that labels can follow. Draws from
    /// `random` only, so that the same state gives the same picture.
    void apply(int width, int height, float focal_px, std::span<std::uint16_t> mm,
               std::span<std::uint32_t> source, Random& random);

  private:
    /// How one pixel's clean surface lies, and whether it lies beside a silhouette.
    struct Lie {
        double tilt = 0.0;
        bool edge = false;
    };
    [[nodiscard]] Lie lie(int x, int y) const;
    void cast_shadow();
    [[nodiscard]] std::uint16_t clean(int x, int y) const;
    [[nodiscard]] std::uint16_t read(int x, int y, std::uint32_t& source, Random& random) const;

    DepthNoise noise_;
    int width_ = 0, height_ = 0;
    float focal_px_ = 0.0f;
    std::vector<std::uint16_t> clean_;   // (width * height)
    std::vector<std::uint8_t> shadowed_; // (width * height)
    std::vector<float> met_;             // nearest disparity in each direction of the projector
};

} // namespace toile::imaging
