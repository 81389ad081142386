// What is known of ellipses.
#pragma once

#include <algorithm>
#include <cmath>

namespace toile::test {

/// Of half axes a and b, by the complete elliptic integral: 4 a E(e), e the eccentricity.
inline double ellipse_perimeter(double a, double b) {
    const double major = std::max(a, b), minor = std::min(a, b);
    return 4.0 * major * std::comp_ellint_2(std::sqrt(1.0 - minor * minor / (major * major)));
}

} // namespace toile::test
