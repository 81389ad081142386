#include "imaging/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace toile::imaging {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSteepFrom = 60.0 * kDegree; // where the paper's second term begins
constexpr double kSteepest = 82.0 * kDegree;  // both terms have a pole at 90 degrees

/// Neighbours whose depths differ by more than this share lie on different surfaces; in a coarse
/// picture a slope may do the same over one pixel, which is let pass up to `kJump_m`.
constexpr double kJump = 0.02;
constexpr double kJump_m = 0.08;
constexpr double kRaggedShare = 0.35; // of the sensor's readings right beside a silhouette
constexpr double kGrazingFrom = 78.0 * kDegree;
constexpr double kGrazingTo = 87.0 * kDegree;
constexpr float kShadowDisparity = 1.5f; // of the sensor's pixels: see simulated_sensor
constexpr float kSameDisparity = 0.6f;

bool jump(std::uint16_t a, std::uint16_t b) {
    if (a == 0 || b == 0) return a != b;
    return std::abs(a - b) > std::max(kJump * std::min(a, b), 1000.0 * kJump_m);
}

} // namespace

double axial_sigma(double z, double tilt) {
    const double t = std::min(tilt, kSteepest);
    double sigma = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    if (t > kSteepFrom) {
        const double rest = 0.5 * std::numbers::pi - t;
        sigma += 0.0001 / std::sqrt(z) * t * t / (rest * rest);
    }
    return sigma;
}

double lateral_sigma(double tilt) {
    const double t = std::min(tilt, kSteepest);
    return 0.8 + 0.035 * t / (0.5 * std::numbers::pi - t);
}

double quantise_disparity(double z, double baseline_focal) {
    const double steps = std::rint(kDisparitySteps * baseline_focal / z);
    return steps > 0.0 ? kDisparitySteps * baseline_focal / steps
                       : std::numeric_limits<double>::infinity();
}

void DepthNoiseMaker::apply(int width, int height, float focal_px, std::span<std::uint16_t> mm,
                            std::span<std::uint32_t> source, Random& random) {
    width_ = width;
    height_ = height;
    focal_px_ = focal_px;
    clean_.assign(mm.begin(), mm.end());
    shadowed_.assign(mm.size(), 0);
    if (noise_.shadow) cast_shadow();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x);
            source[i] = static_cast<std::uint32_t>(i);
            mm[i] = read(x, y, source[i], random);
        }
}

std::uint16_t DepthNoiseMaker::clean(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return 0;
    return clean_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
}

// The tilt follows from the gentler of both slopes along each axis: the other may lead off the
// surface.
DepthNoiseMaker::Lie DepthNoiseMaker::lie(int x, int y) const {
    const int z = clean(x, y);
    Lie out;
    double squares = 0.0;
    const auto look = [&](int dx, int dy) {
        double slope = 1e9;
        for (const int side : {-1, 1}) {
            const std::uint16_t beside = clean(x + side * dx, y + side * dy);
            if (jump(static_cast<std::uint16_t>(z), beside))
                out.edge = true;
            else
                slope = std::min(slope, std::abs(static_cast<double>(beside - z)));
        }
        const double gradient = slope < 1e9 ? slope * static_cast<double>(focal_px_) / z : 0.0;
        squares += gradient * gradient;
    };
    look(1, 0);
    look(0, 1);
    out.tilt = std::atan(std::sqrt(squares));
    return out;
}

// A depth buffer of the projector, row by row; disparities in pixels of this picture.
void DepthNoiseMaker::cast_shadow() {
    const float baseline_focal = focal_px_ * static_cast<float>(kKinectBaseline_m);
    const float coarse = focal_px_ / static_cast<float>(kKinectFocal_px);
    const auto most = std::ceil(baseline_focal / 0.3f) + 1.0f;
    const auto disparity = [&](int x, int y) {
        const std::uint16_t z = clean(x, y);
        return z == 0 ? 0.0f : std::min(most, 1000.0f * baseline_focal / static_cast<float>(z));
    };
    const auto bin = [&](float place) {
        return static_cast<std::size_t>(std::lround(place + most));
    };
    for (int y = 0; y < height_; ++y) {
        met_.assign(static_cast<std::size_t>(width_) + static_cast<std::size_t>(most) + 2, 0.0f);
        float before = -1.0f;
        for (int x = 0; x < width_; ++x) {
            const float d = disparity(x, y);
            const float between = 0.5f * (d + before);
            float& met = met_[bin(static_cast<float>(x) - d)];
            met = std::max(met, d);
            if (x > 0 && std::abs(d - before) < kSameDisparity) { // no gap within a surface
                float& gap = met_[bin(static_cast<float>(x) - 0.5f - between)];
                gap = std::max(gap, between);
            }
            before = d;
        }
        for (int x = 0; x < width_; ++x) {
            const float d = disparity(x, y);
            shadowed_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                      static_cast<std::size_t>(x)] =
                met_[bin(static_cast<float>(x) - d)] > d + kShadowDisparity * coarse ? 1 : 0;
        }
    }
}

std::uint16_t DepthNoiseMaker::read(int x, int y, std::uint32_t& source, Random& random) const {
    const double coarse = std::min(1.0, static_cast<double>(focal_px_) / kKinectFocal_px);
    const Lie here = lie(x, y);
    int u = x, v = y;
    if (noise_.lateral && here.edge) {
        const double sigma = coarse * lateral_sigma(here.tilt);
        u = std::clamp(static_cast<int>(std::lround(x + sigma * random.normal())), 0, width_ - 1);
        v = std::clamp(static_cast<int>(std::lround(y + sigma * random.normal())), 0, height_ - 1);
        // Within a surface the axial noise already holds what shifts do there.
        if (!jump(clean(x, y), clean(u, v))) u = x, v = y;
    }
    source = static_cast<std::uint32_t>(v * width_ + u);
    const std::uint16_t mm = clean(u, v);
    if (mm == 0 || shadowed_[source] != 0) return 0;
    if (noise_.ragged) {
        const double lost = (here.tilt - kGrazingFrom) / (kGrazingTo - kGrazingFrom);
        if (random.uniform() < std::max(lost, here.edge ? kRaggedShare * coarse : 0.0)) return 0;
    }
    double z = 0.001 * mm;
    if (noise_.axial) z += axial_sigma(z, here.tilt) * random.normal();
    if (noise_.quantisation) z = quantise_disparity(z, kKinectBaseline_m * kKinectFocal_px);
    return static_cast<std::uint16_t>(std::clamp(std::rint(1000.0 * z), 0.0, 65535.0));
}

} // namespace toile::imaging
