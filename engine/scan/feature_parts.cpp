#include "scan/feature_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::scan {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Slope {
    double strength = 0, direction = 0; ///< direction in [0, 2 pi)
};

Slope slope_at(const Grey& picture, int x, int y) {
    const double dx = picture.at(x + 1, y) - picture.at(x - 1, y);
    const double dy = picture.at(x, y + 1) - picture.at(x, y - 1);
    double direction = std::atan2(dy, dx);
    if (direction < 0.0) direction += kTurn;
    return {std::sqrt(dx * dx + dy * dy), direction};
}

/// visit(dx, dy, slope) of all pixels within `reach` of a place, rims of the picture left out.
template <class Visit>
void around(const Grey& picture, double x, double y, double reach, const Visit& visit) {
    const int left = std::max(1, static_cast<int>(std::ceil(x - reach))),
              right = std::min(picture.width - 2, static_cast<int>(std::floor(x + reach)));
    const int top = std::max(1, static_cast<int>(std::ceil(y - reach))),
              bottom = std::min(picture.height - 2, static_cast<int>(std::floor(y + reach)));
    for (int v = top; v <= bottom; ++v)
        for (int u = left; u <= right; ++u)
            if ((u - x) * (u - x) + (v - y) * (v - y) <= reach * reach)
                visit(u - x, v - y, slope_at(picture, u, v));
}

template <std::size_t n>
void to_unit(std::array<float, n>& values) {
    double square = 0.0;
    for (const float v : values)
        square += static_cast<double>(v) * v;
    const auto scale = static_cast<float>(square > 0.0 ? 1.0 / std::sqrt(square) : 0.0);
    for (float& v : values)
        v *= scale;
}

} // namespace

Grey blurred(const Grey& picture, double sigma) {
    const int reach = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
    std::vector<float> kernel;
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k) {
        kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
        sum += kernel.back();
    }
    for (float& k : kernel)
        k /= static_cast<float>(sum);
    const int w = picture.width, h = picture.height;
    Grey across = picture, out = picture;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            float value = 0.0f;
            for (int k = -reach; k <= reach; ++k)
                value += kernel[static_cast<std::size_t>(k + reach)] *
                         picture.at(std::clamp(x + k, 0, w - 1), y);
            across.values[static_cast<std::size_t>(y * w + x)] = value;
        }
    for (int y = 0; y < h; ++y) {
        float* row = &out.values[static_cast<std::size_t>(y * w)];
        std::fill(row, row + w, 0.0f);
        for (int k = -reach; k <= reach; ++k) {
            const float by = kernel[static_cast<std::size_t>(k + reach)];
            const float* from =
                &across.values[static_cast<std::size_t>(std::clamp(y + k, 0, h - 1) * w)];
            for (int x = 0; x < w; ++x)
                row[x] += by * from[x];
        }
    }
    return out;
}

Grey doubled(const Grey& picture) {
    Grey out{2 * picture.width, 2 * picture.height, {}};
    out.values.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const int x0 = x / 2, y0 = y / 2;
            const int x1 = std::min(picture.width - 1, (x + 1) / 2),
                      y1 = std::min(picture.height - 1, (y + 1) / 2);
            out.values.push_back(0.25f * (picture.at(x0, y0) + picture.at(x1, y0) +
                                          picture.at(x0, y1) + picture.at(x1, y1)));
        }
    return out;
}

Grey halved(const Grey& picture) {
    Grey out{picture.width / 2, picture.height / 2, {}};
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            out.values.push_back(picture.at(2 * x, 2 * y));
    return out;
}

std::vector<double> main_directions(const Grey& picture, double x, double y, double sigma) {
    constexpr int kBins = 36;
    constexpr double kLeast = 0.8;
    const double weight = 1.5 * sigma;
    std::array<double, kBins> raw{}, bins{};
    around(picture, x, y, 3.0 * weight, [&](double dx, double dy, const Slope& slope) {
        const double near = std::exp(-0.5 * (dx * dx + dy * dy) / (weight * weight));
        const auto bin = static_cast<std::size_t>(slope.direction / kTurn * kBins) % kBins;
        raw[bin] += near * slope.strength;
    });
    for (int round = 0; round < 3; ++round) {
        for (std::size_t i = 0; i < kBins; ++i)
            bins[i] =
                0.25 * raw[(i + kBins - 1) % kBins] + 0.5 * raw[i] + 0.25 * raw[(i + 1) % kBins];
        raw = bins;
    }
    const double most = *std::max_element(bins.begin(), bins.end());
    std::vector<double> out;
    for (std::size_t i = 0; i < kBins && most > 0.0; ++i) {
        const double before = bins[(i + kBins - 1) % kBins], after = bins[(i + 1) % kBins];
        if (bins[i] < kLeast * most || bins[i] <= before || bins[i] <= after) continue;
        const double off = 0.5 * (before - after) / (before - 2.0 * bins[i] + after);
        double angle = (static_cast<double>(i) + 0.5 + off) / kBins * kTurn;
        if (angle >= kTurn) angle -= kTurn;
        out.push_back(angle);
    }
    return out;
}

void describe_fully(const Patch& patch, std::array<float, 128>& out) {
    constexpr int kFields = 4, kDirections = 8;
    constexpr float kMost = 0.2f;
    const double field = 3.0 * patch.sigma;
    const double c = std::cos(patch.angle), s = std::sin(patch.angle);
    out.fill(0.0f);
    around(
        *patch.picture, patch.x, patch.y, field * 0.5 * std::numbers::sqrt2 * (kFields + 1),
        [&](double dx, double dy, const Slope& slope) {
            // Fields along the patch's own direction and across it.
            const double u = (c * dx + s * dy) / field, v = (-s * dx + c * dy) / field;
            const double column = u + 0.5 * kFields - 0.5, row = v + 0.5 * kFields - 0.5;
            if (column <= -1.0 || row <= -1.0 || column >= kFields || row >= kFields) return;
            double turn = slope.direction - patch.angle;
            if (turn < 0.0) turn += kTurn;
            const double direction = turn / kTurn * kDirections;
            const double near = std::exp(-(u * u + v * v) / (0.5 * kFields * kFields));
            const int x0 = static_cast<int>(std::floor(column)),
                      y0 = static_cast<int>(std::floor(row)),
                      d0 = static_cast<int>(std::floor(direction));
            for (int k = 0; k < 8; ++k) {
                const int x = x0 + (k & 1), y = y0 + (k >> 1 & 1), d = d0 + (k >> 2);
                if (x < 0 || y < 0 || x >= kFields || y >= kFields) continue;
                const double share = (1.0 - std::abs(column - x)) * (1.0 - std::abs(row - y)) *
                                     (1.0 - std::abs(direction - d));
                out[static_cast<std::size_t>((y * kFields + x) * kDirections + d % kDirections)] +=
                    static_cast<float>(share * near * slope.strength);
            }
        });
    to_unit(out);
    for (float& value : out)
        value = std::min(value, kMost);
    to_unit(out);
}

void describe_simply(const Patch& patch, std::array<float, 12>& out) {
    constexpr int kRings = 3, kDirections = 4;
    const double ring = 2.5 * patch.sigma;
    out.fill(0.0f);
    around(*patch.picture, patch.x, patch.y, kRings * ring,
           [&](double dx, double dy, const Slope& slope) {
               double turn = slope.direction - patch.angle;
               if (turn < 0.0) turn += kTurn;
               const double direction = turn / kTurn * kDirections;
               const double at = std::sqrt(dx * dx + dy * dy) / ring - 0.5;
               const int r0 = static_cast<int>(std::floor(at)),
                         d0 = static_cast<int>(std::floor(direction));
               for (int k = 0; k < 4; ++k) {
                   const int r = std::clamp(r0 + (k & 1), 0, kRings - 1), d = d0 + (k >> 1);
                   const double share =
                       (1.0 - std::abs(at - (r0 + (k & 1)))) * (1.0 - std::abs(direction - d));
                   out[static_cast<std::size_t>(r * kDirections + d % kDirections)] +=
                       static_cast<float>(share * slope.strength);
               }
           });
    // Each ring by itself: outer ones have more pixels, not more to say.
    for (int r = 0; r < kRings; ++r) {
        double sum = 0.0;
        for (int d = 0; d < kDirections; ++d)
            sum += out[static_cast<std::size_t>(r * kDirections + d)];
        for (int d = 0; d < kDirections; ++d) {
            float& value = out[static_cast<std::size_t>(r * kDirections + d)];
            value = sum > 0.0 ? static_cast<float>(value / sum - 1.0 / kDirections) : 0.0f;
        }
    }
    to_unit(out);
}

} // namespace toile::scan
