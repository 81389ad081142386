// What features are made of: blurred pictures, the main direction of a patch, its description.
#pragma once

#include "scan/features.h"

namespace toile::scan {

/// Gaussian blur, sigma in pixels; the rim goes on.
[[nodiscard]] Grey blurred(const Grey& picture, double sigma);
/// Twice the size, between the pixels; and every other pixel.
[[nodiscard]] Grey doubled(const Grey& picture);
[[nodiscard]] Grey halved(const Grey& picture);

/// Where a feature lies in a blurred picture, how large it is and how it is turned.
struct Patch {
    const Grey* picture = nullptr;
    double x = 0, y = 0, sigma = 1, angle = 0;
};

/// Directions of the strongest slopes around a place (weighed within 1.5 sigma), the best and all
/// of four fifths of its strength; radians, x towards y.
[[nodiscard]] std::vector<double> main_directions(const Grey& picture, double x, double y,
                                                  double sigma);

/// Slopes in 4 x 4 fields of 3 sigma by 8 directions, relative to the patch's own; unit length,
/// strong ones cut at 0.2 (Lowe 2004).
void describe_fully(const Patch& patch, std::array<float, 128>& out);

/// P1 names 12 numbers but not which: here slopes in three rings (out to 2.5, 5 and 7.5 sigma) by
/// four directions relative to the patch's own, less what rings have in common.
void describe_simply(const Patch& patch, std::array<float, 12>& out);

} // namespace toile::scan
