#include "garment/block_loft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {
constexpr double kRow = TubeRings::kStep;
}

Loft::Loft(const BodyProbe& body, const double low_m, const double high_m,
           const std::function<double(double)>& girth_m, const double least_ease_m) {
    rings_.low_m = low_m;
    const int rows = std::max(1, static_cast<int>(std::ceil((high_m - low_m) / kRow))) + 1;
    for (int r = 0; r < rows; ++r) {
        const double height = std::min(low_m + r * kRow, high_m);
        const Ring ring = body.ring(height);
        const double ease =
            std::max(least_ease_m, (girth_m(height) - ring.girth()) / (2.0 * std::numbers::pi));
        auto& row = rings_.rows.emplace_back();
        for (int k = 0; k <= 2 * kSamples; ++k) {
            row[k] = ring.at(k / (2.0 * kSamples), ease);
        }
    }
}

Vec3d TubeRings::at(const double fraction, const double height_m) const {
    const double f = std::clamp(fraction, 0.0, 1.0) * kSamples;
    const double g =
        std::clamp((height_m - low_m) / kStep, 0.0, static_cast<double>(rows.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(f), static_cast<std::size_t>(kSamples - 1));
    const auto r = std::min(static_cast<std::size_t>(g), rows.size() - 2);
    const double s = f - static_cast<double>(k);
    const double t = g - static_cast<double>(r);
    Vec3d p = (1.0 - t) * ((1.0 - s) * rows[r][k] + s * rows[r][k + 1]) +
              t * ((1.0 - s) * rows[r + 1][k] + s * rows[r + 1][k + 1]);
    p.y() = height_m;
    return p;
}

Vec3d Loft::at(const double fraction, const double height_m) const {
    return rings_.at(fraction, height_m);
}

double Loft::front_share(const double height_m) const {
    std::array<double, 2> sums{};
    for (int k = 0; k < 2 * kSamples; ++k) {
        sums[k < kSamples ? 0 : 1] +=
            (at((k + 1) / (2.0 * kSamples), height_m) - at(k / (2.0 * kSamples), height_m)).norm();
    }
    return sums[0] / (sums[0] + sums[1]);
}

} // namespace toile::garment::block
