// A tube of rings around the trunk: where a garment starts before it is draped.
#pragma once

#include "garment/block_body.h"

namespace toile::garment::block {

/// A tube of level rings, a centimetre apart.
struct TubeRings {
    static constexpr int kSamples = 64;   ///< pieces of a ring
    static constexpr double kStep = 0.01; ///< metres between rings
    double low_m = 0.0;
    std::vector<std::array<Vec3d, kSamples + 1>> rows; ///< at least 2

    /// Bilinear; fraction 0..1 along the ring, heights are clamped to the tube's ends but the place
    /// keeps `height_m`. Metres, world.
    [[nodiscard]] Vec3d at(double fraction, double height_m) const;
};

/// Rings every centimetre, each widened until the tube is as long round as the cloth.
class Loft {
  public:
    /// `girth_m(height)` is the cloth's girth; never nearer the body than `least_ease_m`.
    Loft(const BodyProbe& body, double low_m, double high_m,
         const std::function<double(double)>& girth_m, double least_ease_m);

    /// Fraction as in Ring::at; heights are clamped to the tube's ends. Metres, world.
    [[nodiscard]] Vec3d at(double fraction, double height_m) const;

    /// Share of the girth that lies in front of the side points, 0..1.
    [[nodiscard]] double front_share(double height_m) const;

  private:
    static constexpr int kSamples = TubeRings::kSamples / 2; ///< on each of front and back
    TubeRings rings_;
};

} // namespace toile::garment::block
