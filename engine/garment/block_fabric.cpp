#include "garment/block_fabric.h"

#include "core/error.h"
#include "core/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace toile::garment::block {
namespace {

constexpr std::array<std::pair<std::string_view, Weave>, 6> kWeaves = {{{"jersey", Weave::jersey},
                                                                        {"rib", Weave::rib},
                                                                        {"twill", Weave::twill},
                                                                        {"plain", Weave::plain},
                                                                        {"satin", Weave::satin},
                                                                        {"fleece", Weave::fleece}}};

constexpr double kTau = 2.0 * std::numbers::pi;

double fraction(const double x) {
    return x - std::floor(x);
}

// One noise value per thread or stitch of the tile, repeating with it.
double yarn_noise(const int i, const int j, const int period) {
    const auto a = static_cast<std::uint64_t>((i % period + period) % period);
    const auto b = static_cast<std::uint64_t>((j % period + period) % period);
    return Random(a * 7919 + b * 104729 + 1).uniform();
}

// The front of plain knit: columns of V's, two slanted legs to a stitch.
double jersey_height(const double u, const double v) {
    constexpr int kWales = 16;
    constexpr int kCourses = 20;
    const double x = fraction(u * kWales) - 0.5;
    const double across = std::abs(x); // 0 between the legs, 0.5 between the wales
    const double y = v * kCourses + 0.9 * across;
    const double leg = std::sin(std::numbers::pi * std::clamp(across * 2.0, 0.0, 1.0));
    const double stitch = 0.5 + 0.5 * std::cos(kTau * y);
    const int row = static_cast<int>(std::floor(y));
    const int column = static_cast<int>(std::floor(u * kWales));
    return (0.35 + 0.65 * std::pow(stitch, 0.7)) * std::pow(leg, 0.6) *
           (0.90 + 0.10 * yarn_noise(column, row, 20));
}

// 1x1 rib: ridges along v.
double rib_height(const double u, const double v) {
    constexpr int kRibs = 8;
    const double ridge = 0.5 + 0.5 * std::cos(kTau * u * kRibs);
    const double stitch = 0.5 + 0.5 * std::cos(kTau * (v * 20.0 + 0.5 * ridge));
    return std::pow(ridge, 0.7) * (0.85 + 0.15 * stitch);
}

// 2/1 twill: warp floats over two wefts, shifted by one from thread to thread.
double twill_height(const double u, const double v) {
    constexpr int kThreads = 24; // a multiple of 3
    const double s = u * kThreads;
    const double t = v * kThreads;
    const int i = static_cast<int>(std::floor(s));
    const int j = static_cast<int>(std::floor(t));
    const double x = fraction(s) - 0.5;
    const double y = fraction(t) - 0.5;
    const int phase = ((i + j) % 3 + 3) % 3; // 0: weft above; 1, 2: halves of a warp float
    const double noise = 0.92 + 0.08 * yarn_noise(phase == 0 ? 100 + j : i, 3, kThreads);
    if (phase == 0) {
        return 0.55 * noise * std::sqrt(std::max(0.0, 1.0 - 3.2 * y * y)) *
               (0.75 + 0.25 * std::cos(kTau * x));
    }
    const double along = (phase == 1 ? y : y + 1.0) / 2.0 - 0.0; // -0.25 .. 0.75 over the float
    const double bow = std::cos(std::numbers::pi * (along - 0.25));
    return noise * std::sqrt(std::max(0.0, 1.0 - 3.4 * x * x)) *
           (0.62 + 0.38 * std::sqrt(std::max(0.0, bow)));
}

// 1/1 plain weave: warp and weft over each other in turn.
double plain_height(const double u, const double v) {
    constexpr int kThreads = 24;
    const double s = u * kThreads;
    const double t = v * kThreads;
    const int i = static_cast<int>(std::floor(s));
    const int j = static_cast<int>(std::floor(t));
    const double x = fraction(s) - 0.5;
    const double y = fraction(t) - 0.5;
    const bool warp = (i + j) % 2 == 0;
    const double across = warp ? x : y;
    const double along = warp ? y : x;
    const double noise = 0.88 + 0.12 * yarn_noise(warp ? i : 50 + j, 5, kThreads);
    return noise * std::sqrt(std::max(0.0, 1.0 - 3.2 * across * across)) *
           (0.6 + 0.4 * std::cos(std::numbers::pi * along));
}

// Long floats of smooth thread: fine lines along the warp, hardly any relief.
double satin_height(const double u, const double v) {
    constexpr int kThreads = 40;
    const double x = fraction(u * kThreads) - 0.5;
    const int i = static_cast<int>(std::floor(u * kThreads));
    const double lift = 0.5 + 0.5 * std::cos(kTau * (v * 8.0 + 0.6 * i));
    return 0.8 + 0.2 * (1.0 - 2.0 * x * x) * (0.7 + 0.3 * lift);
}

// Brushed: soft clumps of fibre of several sizes.
double fleece_height(const double u, const double v) {
    double sum = 0.0;
    double weight = 0.0;
    for (const int cells : {12, 24, 48}) {
        const double x = u * cells;
        const double y = v * cells;
        const int i = static_cast<int>(std::floor(x));
        const int j = static_cast<int>(std::floor(y));
        const double s = 0.5 - 0.5 * std::cos(std::numbers::pi * fraction(x));
        const double t = 0.5 - 0.5 * std::cos(std::numbers::pi * fraction(y));
        const double low = (1.0 - s) * yarn_noise(i, j, cells) + s * yarn_noise(i + 1, j, cells);
        const double high =
            (1.0 - s) * yarn_noise(i, j + 1, cells) + s * yarn_noise(i + 1, j + 1, cells);
        sum += ((1.0 - t) * low + t * high) * 12.0 / cells;
        weight += 12.0 / cells;
    }
    return 0.4 + 0.6 * sum / weight;
}

std::uint8_t byte(const double x) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
}

} // namespace

std::optional<Weave> weave_from_name(const std::string_view name) {
    for (const auto& [known, weave] : kWeaves) {
        if (name == known) {
            return weave;
        }
    }
    return std::nullopt;
}

std::string weave_names() {
    std::string names;
    for (const auto& [known, weave] : kWeaves) {
        names += (names.empty() ? "" : ", ") + std::string(known);
    }
    return names;
}

FabricTile make_fabric_tile(const Weave weave, const int pixels) {
    std::function<double(double, double)> height;
    FabricTile tile;
    double relief = 0.0; // of the height, as a share of the tile
    double darkest = 0.0;
    switch (weave) {
    case Weave::jersey:
        height = jersey_height, tile.width_m = 0.020, relief = 0.010, darkest = 0.72;
        break;
    case Weave::rib:
        height = rib_height, tile.width_m = 0.020, relief = 0.030, darkest = 0.62;
        break;
    case Weave::twill:
        height = twill_height, tile.width_m = 0.016, relief = 0.008, darkest = 0.70;
        break;
    case Weave::plain:
        height = plain_height, tile.width_m = 0.010, relief = 0.008, darkest = 0.80;
        break;
    case Weave::satin:
        height = satin_height, tile.width_m = 0.012, relief = 0.003, darkest = 0.86;
        break;
    case Weave::fleece:
        height = fleece_height, tile.width_m = 0.030, relief = 0.014, darkest = 0.72;
        break;
    case Weave::invalid:
        throw Error("no such weave");
    }
    // Supersampled heights, with v upwards.
    constexpr int kSub = 3;
    std::vector<double> h(static_cast<std::size_t>(pixels) * pixels, 0.0);
    for (int y = 0; y < pixels; ++y) {
        for (int x = 0; x < pixels; ++x) {
            for (int k = 0; k < kSub * kSub; ++k) {
                const double u = (x + (k % kSub + 0.5) / kSub) / pixels;
                const double v = 1.0 - (y + (k / kSub + 0.5) / kSub) / pixels;
                h[static_cast<std::size_t>(y) * pixels + x] += height(u, v) / (kSub * kSub);
            }
        }
    }
    const auto at = [&](const int x, const int y) {
        return h[static_cast<std::size_t>((y + pixels) % pixels) * pixels + (x + pixels) % pixels];
    };
    tile.shade = {pixels, pixels, {}};
    tile.normal = {pixels, pixels, {}};
    for (int y = 0; y < pixels; ++y) {
        for (int x = 0; x < pixels; ++x) {
            const std::uint8_t grey = byte(darkest + (1.0 - darkest) * std::min(1.0, at(x, y)));
            tile.shade.pixels.insert(tile.shade.pixels.end(), {grey, grey, grey, 255});
            const double scale = 0.5 * relief * pixels;
            const double dx = (at(x + 1, y) - at(x - 1, y)) * scale;
            const double dy = (at(x, y - 1) - at(x, y + 1)) * scale; // v upwards
            const double size = std::sqrt(dx * dx + dy * dy + 1.0);
            tile.normal.pixels.insert(tile.normal.pixels.end(),
                                      {byte(0.5 - 0.5 * dx / size), byte(0.5 - 0.5 * dy / size),
                                       byte(0.5 + 0.5 / size), 255});
        }
    }
    return tile;
}

} // namespace toile::garment::block
