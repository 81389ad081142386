#include "scan/depth_filter.h"

#include "core/error.h"

#include <algorithm>
#include <limits>

namespace toile::scan {
namespace {

constexpr std::uint32_t kGrain = 16;  // rows
constexpr float kMostBias_m = 0.005f; // more is another surface

/// Window around the subject with a margin.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

Crop crop_of(const Picture& picture, std::span<const std::uint8_t> subject) {
    constexpr int kMargin = 8;
    const int w = picture.camera.width, h = picture.camera.height;
    Crop out{w, h, 0, 0};
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            if (subject[static_cast<std::size_t>(y * w + x)] != 0)
                out = {std::min(out.x0, x), std::min(out.y0, y), std::max(out.x1, x + 1),
                       std::max(out.y1, y + 1)};
    return {std::max(0, out.x0 - kMargin), std::max(0, out.y0 - kMargin),
            std::min(w, out.x1 + kMargin), std::min(h, out.y1 + kMargin)};
}

DepthView cut_out(const Picture& picture, std::span<const std::uint8_t> subject) {
    const Crop crop = crop_of(picture, subject);
    DepthView out;
    if (crop.x1 <= crop.x0) return out;
    const imaging::Intrinsics& in = picture.camera;
    out.camera = {crop.x1 - crop.x0,
                  crop.y1 - crop.y0,
                  static_cast<float>(in.fx),
                  static_cast<float>(in.fy),
                  static_cast<float>(in.cx - crop.x0),
                  static_cast<float>(in.cy - crop.y0)};
    out.around = {crop.x0, crop.y0, in.width - crop.x1, in.height - crop.y1};
    const std::size_t n = out.camera.count();
    out.depth.assign(n, 0.0f);
    out.beyond.assign(n, Beyond::nothing);
    out.behind.assign(n, 0.0f);
    if (!picture.color.empty()) out.colors.resize(n);
    for (int y = 0; y < out.camera.height; ++y)
        for (int x = 0; x < out.camera.width; ++x) {
            const auto from = static_cast<std::size_t>((y + crop.y0) * in.width + x + crop.x0);
            const std::size_t to = out.camera.at(x, y);
            const float depth = picture.depth[from];
            if (!out.colors.empty()) out.colors[to] = picture.color[from];
            if (!(depth > 0.0f) || !std::isfinite(depth)) continue;
            out.beyond[to] = subject[from] != 0 ? Beyond::subject : Beyond::scene;
            (subject[from] != 0 ? out.depth : out.behind)[to] = depth;
        }
    return out;
}

/// Readings with fewer than half of their eight neighbours at their own depth.
void drop_flying(DepthView& view) {
    const Window& c = view.camera;
    const std::vector<float> from = view.depth;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const float here = from[c.at(x, y)];
            if (here == 0.0f) continue;
            int near = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int u = x + dx, v = y + dy;
                    if ((dx == 0 && dy == 0) || u < 0 || v < 0 || u >= c.width || v >= c.height)
                        continue;
                    const float there = from[c.at(u, v)];
                    if (there > 0.0f && std::abs(there - here) < depth_jump(here)) ++near;
                }
            if (near < 4) view.depth[c.at(x, y)] = 0.0f;
        }
}

/// Readings within `pixels` of another depth, of the scene or of what the sensor did not read; not
/// of a hole in a surface, beyond which it goes on.
void drop_edges(DepthView& view, int pixels) {
    const Window& c = view.camera;
    std::vector<std::uint8_t> edge(c.count(), 0);
    const auto reads = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < c.width && y < c.height && view.depth[c.at(x, y)] > 0.0f;
    };
    const auto jumps = [&](int x, int y, int dx, int dy) {
        const float here = view.depth[c.at(x, y)];
        constexpr int kWidestHole = 16; // pixels
        bool seen_through = false;
        for (int k = 1; k <= kWidestHole; ++k) {
            const int u = x + k * dx, v = y + k * dy;
            if (reads(u, v)) // a single pixel may be anything
                return k != 2 && std::abs(view.depth[c.at(u, v)] - here) > depth_jump(here);
            seen_through = seen_through || u < 0 || v < 0 || u >= c.width || v >= c.height ||
                           view.beyond[c.at(u, v)] == Beyond::scene;
            if (seen_through && k > 1) return true;
        }
        return true;
    };
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x)
            edge[c.at(x, y)] =
                view.depth[c.at(x, y)] > 0.0f && (jumps(x, y, 1, 0) || jumps(x, y, -1, 0) ||
                                                  jumps(x, y, 0, 1) || jumps(x, y, 0, -1))
                    ? 1
                    : 0;
    const int reach = pixels - 1;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            if (edge[c.at(x, y)] == 0) continue;
            for (int v = std::max(0, y - reach); v <= std::min(c.height - 1, y + reach); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(c.width - 1, x + reach); ++u)
                    view.depth[c.at(u, v)] = 0.0f;
        }
}

/// Weighted least squares of a + b dx + c dy through nearby inverse depths: a plane in space is one
/// there too, and a triangulating sensor's noise is even.
struct PlaneFit {
    float s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, d = 0, dx = 0, dy = 0;

    void add(float x, float y, float value, float weight) {
        const float wx = weight * x, wy = weight * y;
        s += weight;
        sx += wx;
        sy += wy;
        sxx += wx * x;
        sxy += wx * y;
        syy += wy * y;
        d += weight * value;
        dx += wx * value;
        dy += wy * value;
    }
    [[nodiscard]] bool solve(Eigen::Vector3d& out) const {
        Eigen::Matrix3d a;
        a << s, sx, sy, sx, sxx, sxy, sy, sxy, syy;
        const double det = a.determinant();
        if (s < 6.0f || det < 0.02 * double{s} * s * s) return false;
        out = a.inverse() * Eigen::Vector3d(d, dx, dy);
        return true;
    }
};

float color_likeness(const DepthView& view, std::size_t a, std::size_t b) {
    if (view.colors.empty()) return 1.0f;
    float square = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
        const float step =
            static_cast<float>(view.colors[a][k]) - static_cast<float>(view.colors[b][k]);
        square += step * step;
    }
    constexpr float kSigma = 40.0f; // of 255; beyond camera noise and shading
    const float x = square / (kSigma * kSigma);
    return 1.0f / (1.0f + x * x);
}

/// Normal of the plane a + b dx + c dy in inverse depth at a pixel, towards the camera.
Vec3f normal_of(const Window& camera, const Eigen::Vector3d& plane, float x, float y) {
    // n . p = 1 with p = depth * ray gives 1 / depth = n . ray.
    const auto nx = static_cast<float>(plane[1] * camera.fx);
    const auto ny = static_cast<float>(-plane[2] * camera.fy);
    const Vec3f ray = camera.ray(x, y);
    const auto nz = -static_cast<float>(plane[0]) + nx * ray.x() + ny * ray.y();
    return -Vec3f(nx, ny, nz).normalized();
}

void fit_pixel(const DepthView& from, int x, int y, const FilterOptions& options, float& depth,
               Vec3f& normal) {
    const Window& c = from.camera;
    const std::size_t at = c.at(x, y);
    const float here = from.depth[at];
    const float reach = std::max(0.5f * depth_jump(here), 3.0f * depth_sigma(here));
    const int radius = options.radius;
    const float spread = 1.0f / (0.5f * static_cast<float>(radius * radius) + 0.5f);
    PlaneFit fit;
    for (int v = std::max(0, y - radius); v <= std::min(c.height - 1, y + radius); ++v)
        for (int u = std::max(0, x - radius); u <= std::min(c.width - 1, x + radius); ++u) {
            const std::size_t to = c.at(u, v);
            const float there = from.depth[to];
            if (there == 0.0f || std::abs(there - here) > reach) continue;
            const auto dx = static_cast<float>(u - x), dy = static_cast<float>(v - y);
            float weight = 1.0f / (1.0f + spread * (dx * dx + dy * dy));
            if (options.joint_bilateral) weight *= color_likeness(from, at, to);
            // Differences from the middle keep the digits of single precision.
            fit.add(dx, dy, (here - there) / (here * there), weight);
        }
    Eigen::Vector3d plane;
    if (!fit.solve(plane)) return;
    plane[0] += 1.0 / here;
    if (!(plane[0] > 0.0)) return;
    normal = normal_of(c, plane, static_cast<float>(x), static_cast<float>(y));
    if (options.joint_bilateral) depth = static_cast<float>(1.0 / plane[0]);
}

} // namespace

DepthView filtered_view(const Picture& picture, std::span<const std::uint8_t> subject,
                        const FilterOptions& options, const RowLoop& rows) {
    const auto pixels = static_cast<std::size_t>(picture.camera.width) *
                        static_cast<std::size_t>(picture.camera.height);
    if (picture.depth.size() != pixels || subject.size() != pixels ||
        (!picture.color.empty() && picture.color.size() != pixels))
        throw Error("a depth picture, its colours or its mask are not of the camera's size");
    DepthView out = cut_out(picture, subject);
    if (options.flying_pixels) drop_flying(out);
    if (options.edge_pixels > 0) drop_edges(out, options.edge_pixels);
    for (std::size_t i = 0; i < out.depth.size(); ++i)
        if (out.depth[i] == 0.0f && out.beyond[i] == Beyond::subject)
            out.beyond[i] = Beyond::unknown;
    const DepthView from = out;
    out.raw = out.depth;
    out.normals.assign(out.depth.size(), Vec3f::Zero());
    out.weight.assign(out.depth.size(), 0.0f);
    const auto least_cosine = static_cast<float>(std::cos(options.steepest));
    rows(static_cast<std::uint32_t>(out.camera.height), kGrain,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                 for (int x = 0; x < out.camera.width; ++x) {
                     const std::size_t i = out.camera.at(x, y);
                     if (from.depth[i] == 0.0f) continue;
                     fit_pixel(from, x, y, options, out.depth[i], out.normals[i]);
                     const Vec3f ray =
                         out.camera.ray(static_cast<float>(x), static_cast<float>(y)).normalized();
                     const float cosine = -ray.dot(out.normals[i]);
                     if (cosine < least_cosine) {
                         out.depth[i] = 0.0f;
                         out.normals[i].setZero();
                         out.beyond[i] = Beyond::unknown;
                         continue;
                     }
                     const float sigma = depth_sigma(out.depth[i]) / depth_sigma(1.0f);
                     out.weight[i] = cosine * cosine / std::max(1.0f, sigma * sigma);
                 }
         });
    out.smoothed = out.depth;
    return out;
}

double roughness(const DepthView& view) {
    double square = 0.0, count = 0.0;
    for (std::size_t i = 0; i < view.depth.size(); ++i) {
        if (view.weight[i] <= 0.0f) continue;
        const double off = (view.raw[i] - view.smoothed[i]) / depth_sigma(view.raw[i]);
        square += off * off;
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(square / count) : 0.0;
}

void take_off_bias(DepthView& view, std::span<const float> predicted,
                   const FilterOptions& options) {
    if (predicted.size() != view.depth.size())
        throw Error("a predicted depth picture is not of the view's size");
    DepthView from;
    from.camera = view.camera;
    from.colors = view.colors;
    from.depth.assign(view.depth.size(), 0.0f);
    for (std::size_t i = 0; i < from.depth.size(); ++i)
        if (view.raw[i] > 0.0f && predicted[i] > 0.0f) from.depth[i] = predicted[i];
    for (int y = 0; y < view.camera.height; ++y)
        for (int x = 0; x < view.camera.width; ++x) {
            const std::size_t i = view.camera.at(x, y);
            if (view.depth[i] == 0.0f || from.depth[i] == 0.0f) continue;
            float smoothed = 0.0f;
            Vec3f normal;
            fit_pixel(from, x, y, options, smoothed, normal);
            if (smoothed == 0.0f) continue;
            view.depth[i] =
                view.smoothed[i] + std::clamp(predicted[i] - smoothed, -kMostBias_m, kMostBias_m);
        }
}

std::vector<float> averaged_depth(std::span<const std::vector<float>> pictures) {
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    if (pictures.empty()) return {};
    std::vector<float> out(pictures.front().size(), unknown), readings;
    for (std::size_t i = 0; i < out.size(); ++i) {
        readings.clear();
        for (const auto& picture : pictures)
            if (picture[i] > 0.0f) readings.push_back(picture[i]);
        if (2 * readings.size() < pictures.size() || readings.empty()) continue;
        const auto middle = readings.begin() + static_cast<std::ptrdiff_t>(readings.size() / 2);
        std::nth_element(readings.begin(), middle, readings.end());
        const float median = *middle;
        double sum = 0.0;
        int count = 0;
        for (const float reading : readings)
            if (std::abs(reading - median) < depth_jump(median)) sum += reading, ++count;
        out[i] = static_cast<float>(sum / count);
    }
    return out;
}

} // namespace toile::scan
