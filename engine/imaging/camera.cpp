#include "imaging/camera.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::imaging {
namespace {

using Eigen::Vector2d;

// Normalised image coordinates (x right, y down, at depth 1), without and with distortion:
// Brown 1966 with OpenCV's rational radial part.
Vector2d distort(const std::array<double, 8>& d, const Vector2d& p) {
    const double r2 = p.squaredNorm();
    const double radial = (1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) /
                          (1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
    const double xy = p.x() * p.y();
    return {p.x() * radial + 2.0 * d[2] * xy + d[3] * (r2 + 2.0 * p.x() * p.x()),
            p.y() * radial + d[2] * (r2 + 2.0 * p.y() * p.y()) + 2.0 * d[3] * xy};
}

std::optional<Vector2d> undistort(const std::array<double, 8>& d, const Vector2d& wanted) {
    constexpr double kStep = 1e-6;
    constexpr double kTolerance = 1e-10; // of the depth: a ten-millionth of a pixel
    Vector2d p = wanted;
    for (int i = 0; i < 30; ++i) {
        const Vector2d miss = distort(d, p) - wanted;
        if (!miss.allFinite()) return std::nullopt;
        if (miss.norm() < kTolerance) return p;
        Eigen::Matrix2d J;
        J.col(0) = (distort(d, p + Vector2d(kStep, 0)) - distort(d, p - Vector2d(kStep, 0))) /
                   (2.0 * kStep);
        J.col(1) = (distort(d, p + Vector2d(0, kStep)) - distort(d, p - Vector2d(0, kStep))) /
                   (2.0 * kStep);
        if (!(J.determinant() > 1e-6)) return std::nullopt; // the picture folds over here
        p -= J.inverse() * miss;
    }
    return std::nullopt;
}

// Colour between four pixels; (x, y) is within the picture.
std::array<std::uint8_t, 4> sample(const Image& image, double x, double y) {
    const int x0 = std::min(static_cast<int>(x), image.width - 1);
    const int y0 = std::min(static_cast<int>(y), image.height - 1);
    const int x1 = std::min(x0 + 1, image.width - 1);
    const int y1 = std::min(y0 + 1, image.height - 1);
    const double u = x - x0;
    const double v = y - y0;
    const auto at = [&image](int px, int py, std::size_t k) {
        const std::size_t pixel =
            static_cast<std::size_t>(py) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(px);
        return static_cast<double>(image.pixels[4 * pixel + k]);
    };
    std::array<std::uint8_t, 4> result{};
    for (std::size_t k = 0; k < 4; ++k)
        result[k] = static_cast<std::uint8_t>(
            std::lround((1 - v) * ((1 - u) * at(x0, y0, k) + u * at(x1, y0, k)) +
                        v * ((1 - u) * at(x0, y1, k) + u * at(x1, y1, k))));
    return result;
}

} // namespace

bool Intrinsics::distorted() const {
    return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; });
}

Vector2d Intrinsics::field_of_view() const {
    return {std::atan((cx + 0.5) / fx) + std::atan((width - 0.5 - cx) / fx),
            std::atan((cy + 0.5) / fy) + std::atan((height - 0.5 - cy) / fy)};
}

void check_intrinsics(const Intrinsics& camera) {
    if (camera.width <= 0 || camera.height <= 0 || camera.width > 16384 || camera.height > 16384)
        throw Error("camera intrinsics: a picture of " + std::to_string(camera.width) + " x " +
                    std::to_string(camera.height) + " pixels makes no sense");
    const auto finite = [](double v) { return std::isfinite(v); };
    if (!(camera.fx > 0.0 && camera.fy > 0.0 && finite(camera.fx) && finite(camera.fy)))
        throw Error("camera intrinsics: the focal lengths must be positive");
    if (!finite(camera.cx) || !finite(camera.cy) ||
        !std::all_of(camera.distortion.begin(), camera.distortion.end(), finite))
        throw Error("camera intrinsics: a number is not finite");
}

std::optional<Vector2d> project(const Intrinsics& camera, const Vec3d& point) {
    const double depth = -point.z();
    if (!(depth > 0.0)) return std::nullopt;
    Vector2d p(point.x() / depth, -point.y() / depth);
    if (camera.distorted()) p = distort(camera.distortion, p);
    return Vector2d(camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy);
}

std::optional<Vec3d> unproject(const Intrinsics& camera, const Vector2d& pixel, double depth) {
    Vector2d p((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
    if (camera.distorted()) {
        const std::optional<Vector2d> straight = undistort(camera.distortion, p);
        if (!straight) return std::nullopt;
        p = *straight;
    }
    return Vec3d(p.x() * depth, -p.y() * depth, -depth);
}

DepthUnprojector::DepthUnprojector(const Intrinsics& camera) : camera_(camera) {
    check_intrinsics(camera);
    rays_.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
    const Vec3f unknown = Vec3f::Constant(std::numeric_limits<float>::quiet_NaN());
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::optional<Vec3d> ray = unproject(camera, Vector2d(x, y), 1.0);
            rays_.push_back(ray ? Vec3f(ray->cast<float>()) : unknown);
        }
}

void DepthUnprojector::points(std::span<const float> depth,
                              std::span<Vec3f> points) const noexcept {
    const std::size_t count = std::min({depth.size(), points.size(), rays_.size()});
    for (std::size_t i = 0; i < count; ++i)
        points[i] = depth[i] * rays_[i]; // NaN stays NaN
}

Image register_color(const DepthImage& depth, const Intrinsics& depth_camera, const Image& color,
                     const Intrinsics& color_camera, const Eigen::Isometry3d& color_from_depth) {
    check_intrinsics(depth_camera);
    check_intrinsics(color_camera);
    if (depth.width != depth_camera.width || depth.height != depth_camera.height ||
        color.width != color_camera.width || color.height != color_camera.height)
        throw Error("colour cannot be registered: a picture is not of its camera's size");
    Image result{depth.width, depth.height, std::vector<std::uint8_t>(depth.metres.size() * 4, 0)};
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.width) +
                static_cast<std::size_t>(x);
            const auto metres = static_cast<double>(depth.metres[i]);
            if (!(metres > 0.0)) continue;
            const std::optional<Vec3d> place = unproject(depth_camera, Vector2d(x, y), metres);
            if (!place) continue;
            const std::optional<Vector2d> pixel = project(color_camera, color_from_depth * *place);
            if (!pixel || !(pixel->x() >= 0.0 && pixel->x() <= color.width - 1.0 &&
                            pixel->y() >= 0.0 && pixel->y() <= color.height - 1.0))
                continue;
            const auto rgba = sample(color, pixel->x(), pixel->y());
            std::copy(rgba.begin(), rgba.end(),
                      result.pixels.begin() + static_cast<std::ptrdiff_t>(4 * i));
        }
    return result;
}

} // namespace toile::imaging
