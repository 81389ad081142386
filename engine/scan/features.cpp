#include "scan/features.h"

#include "scan/feature_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace toile::scan {
namespace {

constexpr int kScales = 3; // of an octave
constexpr double kFirstSigma = 1.6;

Grey grey_of(const DepthView& view) {
    Grey out{view.camera.width, view.camera.height, {}};
    out.values.reserve(view.colors.size());
    for (const Rgba8& c : view.colors)
        out.values.push_back((0.299f * c[0] + 0.587f * c[1] + 0.114f * c[2]) / 255.0f);
    return out;
}

/// Where the differences of neighbouring scales have a peak, and how strong it is.
bool is_peak(const std::array<Grey, 3>& d, int x, int y, float value) {
    for (const Grey& level : d)
        for (int v = -1; v <= 1; ++v)
            for (int u = -1; u <= 1; ++u) {
                if (&level == &d[1] && u == 0 && v == 0) continue;
                const float other = level.at(x + u, y + v);
                if (value > 0.0f ? other >= value : other <= value) return false;
            }
    return true;
}

struct Peak {
    double x = 0, y = 0, level = 0; ///< of the octave
    double strength = 0;
};

/// Quadratic through a peak's neighbours; false when it is weak, a line, or lies elsewhere.
bool refine(const std::array<Grey, 3>& d, int x, int y, int level, const FeatureOptions& options,
            Peak& out) {
    const auto at = [&](int u, int v, int s) {
        return static_cast<double>(d[static_cast<std::size_t>(1 + s)].at(x + u, y + v));
    };
    const double middle = at(0, 0, 0);
    const Vec3d g(0.5 * (at(1, 0, 0) - at(-1, 0, 0)), 0.5 * (at(0, 1, 0) - at(0, -1, 0)),
                  0.5 * (at(0, 0, 1) - at(0, 0, -1)));
    const auto second = [&](int u, int v, int s) {
        return at(u, v, s) - 2.0 * middle + at(-u, -v, -s);
    };
    const auto mixed = [&](int u1, int v1, int s1, int u2, int v2, int s2) {
        return 0.25 * (at(u1 + u2, v1 + v2, s1 + s2) - at(u1 - u2, v1 - v2, s1 - s2) -
                       at(u2 - u1, v2 - v1, s2 - s1) + at(-u1 - u2, -v1 - v2, -s1 - s2));
    };
    Eigen::Matrix3d h;
    h(0, 0) = second(1, 0, 0), h(1, 1) = second(0, 1, 0), h(2, 2) = second(0, 0, 1);
    h(0, 1) = h(1, 0) = mixed(1, 0, 0, 0, 1, 0);
    h(0, 2) = h(2, 0) = mixed(1, 0, 0, 0, 0, 1);
    h(1, 2) = h(2, 1) = mixed(0, 1, 0, 0, 0, 1);
    const Vec3d off = -h.fullPivLu().solve(g);
    if (!off.allFinite() || off.cwiseAbs().maxCoeff() > 0.6) return false;
    const double strength = std::abs(middle + 0.5 * g.dot(off));
    const double trace = h(0, 0) + h(1, 1), product = h(0, 0) * h(1, 1) - h(0, 1) * h(0, 1);
    const double r = options.edge_ratio;
    if (strength < options.contrast || product <= 0.0 ||
        trace * trace * r > (r + 1.0) * (r + 1.0) * product)
        return false;
    out = {x + off.x(), y + off.y(), level + off.z(), strength};
    return true;
}

struct Found {
    Peak peak;
    Feature feature;
};

/// All points of one octave; `step`: pixels of the picture per pixel of the octave.
void search(const std::vector<Grey>& blurred, double step, std::span<const std::uint8_t> usable,
            const Grey& picture, Descriptor descriptor, const FeatureOptions& options,
            std::vector<Found>& out) {
    constexpr int kRim = 5;
    std::vector<Grey> difference;
    for (std::size_t s = 0; s + 1 < blurred.size(); ++s) {
        Grey& d = difference.emplace_back(blurred[s]);
        for (std::size_t i = 0; i < d.values.size(); ++i)
            d.values[i] = blurred[s + 1].values[i] - d.values[i];
    }
    for (int s = 1; s <= kScales; ++s) {
        const std::array<Grey, 3> near = {difference[static_cast<std::size_t>(s - 1)],
                                          difference[static_cast<std::size_t>(s)],
                                          difference[static_cast<std::size_t>(s + 1)]};
        const Grey& level = blurred[static_cast<std::size_t>(s)];
        for (int y = kRim; y < level.height - kRim; ++y)
            for (int x = kRim; x < level.width - kRim; ++x) {
                const float value = near[1].at(x, y);
                if (std::abs(value) < 0.5 * options.contrast || !is_peak(near, x, y, value))
                    continue;
                Peak peak;
                if (!refine(near, x, y, s, options, peak)) continue;
                Feature feature;
                feature.x = static_cast<float>(peak.x * step);
                feature.y = static_cast<float>(peak.y * step);
                const int u = static_cast<int>(std::lround(feature.x)),
                          v = static_cast<int>(std::lround(feature.y));
                if (u < 0 || v < 0 || u >= picture.width || v >= picture.height ||
                    (!usable.empty() &&
                     usable[static_cast<std::size_t>(v * picture.width + u)] == 0))
                    continue;
                const double sigma = kFirstSigma * std::pow(2.0, peak.level / kScales);
                feature.scale = static_cast<float>(sigma * step);
                for (const double angle : main_directions(level, peak.x, peak.y, sigma)) {
                    feature.angle = static_cast<float>(angle);
                    const Patch patch{&level, peak.x, peak.y, sigma, angle};
                    if (descriptor == Descriptor::full) describe_fully(patch, feature.full);
                    if (descriptor == Descriptor::simple) describe_simply(patch, feature.simple);
                    out.push_back({peak, feature});
                }
            }
    }
}

template <std::size_t n>
float square_distance(const std::array<float, n>& a, const std::array<float, n>& b) {
    constexpr std::size_t kLanes = 4;
    std::array<float, kLanes> sums{};
    for (std::size_t i = 0; i < n; i += kLanes)
        for (std::size_t k = 0; k < kLanes; ++k) {
            const float d = a[i + k] - b[i + k];
            sums[k] += d * d;
        }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// (a) nearest of b, or -1 when it is not clearly the nearest.
template <class Member>
std::vector<std::int32_t> nearest(std::span<const Feature> a, std::span<const Feature> b,
                                  const Member& member, double ratio) {
    std::vector<std::int32_t> out(a.size(), -1);
    const auto least = static_cast<float>(ratio * ratio);
    for (std::size_t i = 0; i < a.size(); ++i) {
        float best = std::numeric_limits<float>::max(), second = best;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const float d = square_distance(a[i].*member, b[j].*member);
            if (d < best)
                second = best, best = d, out[i] = static_cast<std::int32_t>(j);
            else if (d < second)
                second = d;
        }
        if (!(best < least * second)) out[i] = -1;
    }
    return out;
}

template <class Member>
std::vector<Match> mutual(std::span<const Feature> a, std::span<const Feature> b,
                          const Member& member, double ratio) {
    const auto to_b = nearest(a, b, member, ratio), to_a = nearest(b, a, member, ratio);
    std::vector<Match> out;
    for (std::uint32_t i = 0; i < a.size(); ++i)
        if (to_b[i] >= 0 && to_a[static_cast<std::size_t>(to_b[i])] == static_cast<std::int32_t>(i))
            out.push_back({i, static_cast<std::uint32_t>(to_b[i])});
    return out;
}

} // namespace

std::vector<Feature> find_features(const Grey& picture, std::span<const std::uint8_t> usable,
                                   Descriptor descriptor, const FeatureOptions& options) {
    constexpr int kLeastSide = 16;
    constexpr double kOwnBlur = 0.5; // of a camera's picture, pixels
    std::vector<Found> found;
    double step = 0.5;
    Grey base =
        blurred(doubled(picture), std::sqrt(kFirstSigma * kFirstSigma - 4.0 * kOwnBlur * kOwnBlur));
    while (std::min(base.width, base.height) >= kLeastSide) {
        std::vector<Grey> levels = {std::move(base)};
        for (int s = 1; s < kScales + 3; ++s) {
            const double before = kFirstSigma * std::pow(2.0, (s - 1.0) / kScales),
                         after = kFirstSigma * std::pow(2.0, double(s) / kScales);
            levels.push_back(blurred(levels.back(), std::sqrt(after * after - before * before)));
        }
        search(levels, step, usable, picture, descriptor, options, found);
        base = halved(levels[kScales]);
        step *= 2.0;
    }
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return a.peak.strength > b.peak.strength;
    });
    std::vector<Feature> out;
    for (std::size_t i = 0; i < std::min(found.size(), options.most); ++i)
        out.push_back(found[i].feature);
    return out;
}

std::vector<Feature> find_features(const DepthView& view, Descriptor descriptor,
                                   const FeatureOptions& options) {
    if (view.colors.empty()) return {};
    std::vector<std::uint8_t> usable(view.depth.size());
    for (std::size_t i = 0; i < usable.size(); ++i)
        usable[i] = view.depth[i] > 0.0f ? 1 : 0;
    std::vector<Feature> out = find_features(grey_of(view), usable, descriptor, options);
    for (Feature& feature : out) {
        const auto u = static_cast<int>(std::lround(feature.x)),
                   v = static_cast<int>(std::lround(feature.y));
        feature.point = view.depth[view.camera.at(u, v)] * view.camera.ray(feature.x, feature.y);
    }
    return out;
}

std::vector<Match> match(std::span<const Feature> a, std::span<const Feature> b,
                         Descriptor descriptor, double ratio) {
    return descriptor == Descriptor::simple ? mutual(a, b, &Feature::simple, ratio)
                                            : mutual(a, b, &Feature::full, ratio);
}

} // namespace toile::scan
