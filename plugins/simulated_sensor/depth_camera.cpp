#include "simulated_sensor/depth_camera.h"

#include "imaging/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::simulated_sensor {
namespace {

constexpr std::uint32_t kGrain = 16; // rows a range
constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Neighbours whose depths differ by more than this share lie on different surfaces.
constexpr float kJump = 0.02f;
/// Pixels that lateral noise may carry a silhouette: 4 sigma on a frontal surface.
constexpr int kReach = 3;
/// Steps of disparity by which something must be nearer to the projector to hide a pixel: surfaces
/// that fall off steeply do not shadow themselves.
constexpr float kShadowDisparity = 1.5f;
/// Neighbours whose disparities differ by less than this are one surface seen by the projector.
constexpr float kSameDisparity = 0.6f;

constexpr float kRaggedShare = 0.35f; // of readings right beside a silhouette that are lost
constexpr float kHairShare = 0.3f;    // of readings in hair that are lost
constexpr float kGrazingFrom = 0.21f; // cosine (78 degrees) from which readings begin to be lost
constexpr float kGrazingTo = 0.05f;   // and at which (87 degrees) all are

/// Standard normal variables below this are the given share of all. (Only shares used here.)
float below(float share) {
    // Newton's method on the distribution function, from the middle.
    double x = 0.0;
    for (int i = 0; i < 20; ++i)
        x -= (0.5 * std::erfc(-x / std::numbers::sqrt2) - static_cast<double>(share)) *
             std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
    return static_cast<float>(x);
}

/// Is the pixel in a patch without readings? A smooth standard normal field over the picture, from
/// numbers at every kHoleCell-th pixel, that lies below `bound`.
bool in_hole(const PixelRandom& random, int x, int y, float bound) {
    constexpr int kHoleCell = 10;
    const int cx = x / kHoleCell, cy = y / kHoleCell;
    const float fx = static_cast<float>(x % kHoleCell) / kHoleCell;
    const float fy = static_cast<float>(y % kHoleCell) / kHoleCell;
    float sum = 0.0f, squares = 0.0f;
    for (int k = 0; k < 4; ++k) {
        const int dx = k % 2, dy = k / 2;
        const float weight = (dx == 0 ? 1.0f - fx : fx) * (dy == 0 ? 1.0f - fy : fy);
        sum += weight * random.normal(Draw::holes, cx + dx, cy + dy);
        squares += weight * weight;
    }
    return sum < bound * std::sqrt(squares);
}

bool jump(float a, float b) {
    if (a == b) return false; // both may be infinite
    return !(std::abs(a - b) <= kJump * std::min(a, b));
}

} // namespace

SystematicErrors draw_errors(const NoiseSettings& noise, std::uint64_t seed, std::uint32_t camera) {
    const PixelRandom random(seed, camera, 0xffffffffu);
    const auto normal = [&](int k) {
        return static_cast<double>(random.normal(Draw::systematic, k, 0));
    };
    SystematicErrors out;
    out.depth_scale =
        1.0 + noise.depth_scale *
                  (2.0 * static_cast<double>(random.uniform(Draw::systematic, 0, 1)) - 1.0);
    const Vec3d axis(normal(1), normal(2), normal(3));
    out.pose_error.linear() =
        Eigen::AngleAxisd(noise.extrinsic_rotation * normal(4), axis.normalized())
            .toRotationMatrix();
    out.pose_error.translation() =
        noise.extrinsic_translation_m * Vec3d(normal(5), normal(6), normal(7));
    return out;
}

DepthCamera::DepthCamera(const CameraSettings& settings, std::uint64_t seed, std::uint32_t number)
    : settings_(settings), intrinsics_(settings.intrinsics()), seed_(seed), number_(number),
      errors_(draw_errors(settings.noise, seed, number)) {
    const int width = intrinsics_.width;
    const int height = intrinsics_.height;
    hits_.resize(width, height);
    const std::size_t pixels = hits_.depth.size();
    directions_.reserve(pixels);
    const Eigen::Matrix3d R = settings_.world_from_camera.linear();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto ray = imaging::unproject(intrinsics_, Eigen::Vector2d(x, y), 1.0);
            directions_.push_back(ray ? Vec3f((R * *ray).cast<float>())
                                      : Vec3f(Vec3f::Constant(kUnknown)));
        }
    near_silhouette_.resize(pixels);
    reach_.resize(pixels);
    shadowed_.resize(pixels);
    seen_.resize(pixels);
    dark_.resize(pixels);
    noise_.resize(pixels);
    white_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height + 4));
    const auto lines = static_cast<std::size_t>(settings_.upright ? width : height);
    const auto along = static_cast<std::size_t>(settings_.upright ? height : width);
    const auto most =
        static_cast<std::size_t>(settings_.baseline_focal() / settings_.nearest_m) + 3;
    nearest_.resize(lines * (along + most));
    depth_ = {width, height, std::vector<float>(pixels, kUnknown)};
}

void DepthCamera::look(const Stage& stage, const RowLoop& rows) {
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    const Vec3f from = origin();
    rows(static_cast<std::uint32_t>(intrinsics_.height), kGrain,
         [&](std::uint32_t begin, std::uint32_t end) {
             stage.trace(from, directions_, begin * width, end * width, hits_);
         });
}

void DepthCamera::measure(const Stage& stage, std::uint32_t frame, const RowLoop& rows,
                          bool round_to_mm) {
    const NoiseSettings& noise = settings_.noise;
    const PixelRandom random(seed_, number_, frame);
    const double focal = settings_.baseline_focal();
    find_silhouettes(rows);
    if (noise.shadow)
        cast_shadow(rows);
    else
        std::fill(shadowed_.begin(), shadowed_.end(), std::uint8_t{0});
    shift_silhouettes(stage, random, rows);
    if (noise.axial > 0.0) fill_noise(random, rows);
    const float hole = noise.holes > 0.0 ? below(static_cast<float>(noise.holes)) : 0.0f;

    rows(static_cast<std::uint32_t>(intrinsics_.height), kGrain,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                 for (int x = 0; x < intrinsics_.width; ++x) {
                     const std::size_t i = at(x, y);
                     depth_.metres[i] = kUnknown;
                     const Hit& hit = seen_[i];
                     if (!(hit.depth < kNothing) || dark_[i] != 0) continue;
                     if (noise.ragged && lost(stage, random, x, y)) continue;
                     if (noise.holes > 0.0 && in_hole(random, x, y, hole)) continue;
                     auto z = static_cast<double>(hit.depth);
                     if (noise.axial > 0.0) {
                         // Below 60 degrees the tilt does not count.
                         const double tilt =
                             hit.cosine < 0.5f ? std::acos(static_cast<double>(hit.cosine)) : 0.0;
                         z += noise.axial * imaging::axial_sigma(z, tilt) *
                              static_cast<double>(noise_[i]);
                     }
                     if (noise.quantisation) z = imaging::quantise_disparity(z, focal);
                     z *= errors_.depth_scale;
                     if (round_to_mm) z = std::rint(1e3 * z) * 1e-3;
                     if (z >= settings_.nearest_m && z <= settings_.farthest_m)
                         depth_.metres[i] = static_cast<float>(z);
                 }
         });
}

// Marks the pixels within kReach (a square) of a jump in depth.
void DepthCamera::find_silhouettes(const RowLoop& rows) {
    const int width = intrinsics_.width;
    const int height = intrinsics_.height;
    const auto& depth = hits_.depth;
    const auto spread_along_rows = [&](std::uint32_t begin, std::uint32_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            std::fill_n(reach_.begin() + static_cast<std::ptrdiff_t>(at(0, y)), width,
                        std::uint8_t{0});
            for (int x = 0; x < width; ++x) {
                const float z = depth[at(x, y)];
                const bool right = x + 1 < width && jump(z, depth[at(x + 1, y)]);
                const bool below = y + 1 < height && jump(z, depth[at(x, y + 1)]);
                if (!right && !below) continue;
                const int last = std::min(width - 1, x + kReach + (right ? 1 : 0));
                for (int k = std::max(0, x - kReach); k <= last; ++k)
                    reach_[at(k, y)] = 1;
            }
        }
    };
    const auto spread_along_columns = [&](std::uint32_t begin, std::uint32_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            std::uint8_t* out = near_silhouette_.data() + at(0, y);
            std::fill_n(out, width, std::uint8_t{0});
            const int last = std::min(height - 1, y + kReach);
            for (int k = std::max(0, y - kReach - 1); k <= last; ++k) {
                const std::uint8_t* row = reach_.data() + at(0, k);
                for (int x = 0; x < width; ++x)
                    out[x] |= row[x];
            }
        }
    };
    rows(static_cast<std::uint32_t>(height), kGrain, spread_along_rows);
    rows(static_cast<std::uint32_t>(height), kGrain, spread_along_columns);
}

// A depth buffer of the projector, line by line: projector and camera lines are the same.
// A pixel s towards the projector with disparity d is met at s - d.
void DepthCamera::cast_shadow(const RowLoop& rows) {
    const int lines = settings_.upright ? intrinsics_.width : intrinsics_.height;
    const int along = settings_.upright ? intrinsics_.height : intrinsics_.width;
    const std::size_t bins = nearest_.size() / static_cast<std::size_t>(lines);
    const auto most = static_cast<float>(bins - static_cast<std::size_t>(along) - 2);
    const auto focal = static_cast<float>(settings_.baseline_focal());
    const auto pixel = [&](int line, int s) { // landscape: to the right; upright: upwards
        return settings_.upright ? at(line, along - 1 - s) : at(s, line);
    };
    rows(static_cast<std::uint32_t>(lines), kGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (int line = static_cast<int>(begin); line < static_cast<int>(end); ++line) {
            float* met = nearest_.data() + static_cast<std::size_t>(line) * bins;
            std::fill_n(met, bins, 0.0f);
            const auto disparity = [&](int s) {
                return std::min(most, focal / hits_.depth[pixel(line, s)]);
            };
            const auto splat = [&](float place, float d) {
                float& bin = met[static_cast<std::size_t>(std::lround(place + most))];
                bin = std::max(bin, d);
            };
            float before = -1.0f;
            for (int s = 0; s < along; ++s) {
                const float d = disparity(s);
                splat(static_cast<float>(s) - d, d);
                if (s > 0 && std::abs(d - before) < kSameDisparity) // no gap within a surface
                    splat(static_cast<float>(s) - 0.5f - 0.5f * (d + before), 0.5f * (d + before));
                before = d;
            }
            for (int s = 0; s < along; ++s) {
                const float d = disparity(s);
                const auto bin =
                    static_cast<std::size_t>(std::lround(static_cast<float>(s) - d + most));
                shadowed_[pixel(line, s)] = met[bin] > d + kShadowDisparity ? 1 : 0;
            }
        }
    });
}

// Tilt of the nearest surface around a pixel: both sides of a silhouette shift by the same law.
float DepthCamera::nearest_tilt(int x, int y) const {
    float nearest = kNothing;
    float cosine = 1.0f;
    for (int k = std::max(0, y - kReach); k <= std::min(intrinsics_.height - 1, y + kReach); ++k)
        for (int i = std::max(0, x - kReach); i <= std::min(intrinsics_.width - 1, x + kReach); ++i)
            if (hits_.depth[at(i, k)] < nearest) {
                nearest = hits_.depth[at(i, k)];
                cosine = hits_.cosine[at(i, k)];
            }
    return std::acos(cosine);
}

// Does a place in the picture lie beside a pixel that a jump in depth parts from pixel i?
bool DepthCamera::crosses(std::size_t i, const Eigen::Vector2d& place) const {
    const int u = std::clamp(static_cast<int>(std::floor(place.x())), 0, intrinsics_.width - 2);
    const int v = std::clamp(static_cast<int>(std::floor(place.y())), 0, intrinsics_.height - 2);
    const auto& depth = hits_.depth;
    return jump(depth[at(u, v)], depth[i]) || jump(depth[at(u + 1, v)], depth[i]) ||
           jump(depth[at(u, v + 1)], depth[i]) || jump(depth[at(u + 1, v + 1)], depth[i]);
}

// Lateral noise: a silhouette's pixels see what lies a random shift beside them. Within a surface
// depth stays what it is, since the measured axial noise already holds what shifts do there.
void DepthCamera::shift_silhouettes(const Stage& stage, const PixelRandom& random,
                                    const RowLoop& rows) {
    const auto shift_rows = [&](std::uint32_t begin, std::uint32_t end) {
        const Vec3f from = origin();
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < intrinsics_.width; ++x) {
                const std::size_t i = at(x, y);
                seen_[i] = {hits_.depth[i], hits_.cosine[i], hits_.surface[i]};
                dark_[i] = shadowed_[i];
                if (near_silhouette_[i] == 0 || settings_.noise.lateral <= 0.0) continue;
                const double sigma =
                    settings_.noise.lateral *
                    imaging::lateral_sigma(static_cast<double>(nearest_tilt(x, y)));
                const Eigen::Vector2d place(
                    x + sigma * static_cast<double>(random.smooth_normal(Draw::shift_x, x, y)),
                    y + sigma * static_cast<double>(random.smooth_normal(Draw::shift_y, x, y)));
                if (!crosses(i, place)) continue;
                const auto ray = imaging::unproject(intrinsics_, place, 1.0);
                if (!ray) continue;
                const Vec3f direction = (settings_.world_from_camera.linear() * *ray).cast<float>();
                const Hit beside = stage.trace(from, direction);
                if (!jump(beside.depth, hits_.depth[i])) continue;
                seen_[i] = beside;
                const int u =
                    std::clamp(static_cast<int>(std::lround(place.x())), 0, intrinsics_.width - 1);
                const int v =
                    std::clamp(static_cast<int>(std::lround(place.y())), 0, intrinsics_.height - 1);
                dark_[i] = shadowed_[at(u, v)];
            }
    };
    rows(static_cast<std::uint32_t>(intrinsics_.height), kGrain, shift_rows);
}

// Standard normal numbers for every pixel; correlated ones as PixelRandom::smooth_normal, but
// filtered in two passes.
void DepthCamera::fill_noise(const PixelRandom& random, const RowLoop& rows) {
    const int width = intrinsics_.width;
    const auto height = static_cast<std::uint32_t>(intrinsics_.height);
    if (!settings_.noise.correlated) {
        rows(height, kGrain, [&](std::uint32_t begin, std::uint32_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < width; ++x)
                    noise_[at(x, y)] = random.normal(Draw::depth, x, y);
        });
        return;
    }
    rows(height + 4, kGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            std::array<float, 5> window{};
            for (int x = -2; x < width + 2; ++x) {
                std::rotate(window.begin(), window.begin() + 1, window.end());
                window[4] = random.normal(Draw::depth, x, y - 2);
                if (x < 2) continue;
                float sum = 0.0f;
                for (std::size_t k = 0; k < 5; ++k)
                    sum += kSmoothKernel[k] * window[k];
                white_[at(x - 2, y)] = sum;
            }
        }
    });
    rows(height, kGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                float sum = 0.0f;
                for (int k = 0; k < 5; ++k)
                    sum += kSmoothKernel[static_cast<std::size_t>(k)] * white_[at(x, y + k)];
                noise_[at(x, y)] = sum;
            }
    });
}

// Readings that the sensor cannot make although light comes back.
bool DepthCamera::lost(const Stage& stage, const PixelRandom& random, int x, int y) const {
    static const float ragged = below(kRaggedShare);
    static const float hair = below(kHairShare);
    const Hit& hit = seen_[at(x, y)];
    if (hit.cosine < kGrazingFrom) {
        const float share = (kGrazingFrom - hit.cosine) / (kGrazingFrom - kGrazingTo);
        if (random.uniform(Draw::grazing, x, y) < share) return true;
    }
    if (stage.surface(hit.surface).look.grain == Grain::hair &&
        random.smooth_normal(Draw::hair, x, y) < hair)
        return true;
    if (near_silhouette_[at(x, y)] == 0) return false;
    const auto beside = [&](int u, int v) {
        return u >= 0 && v >= 0 && u < intrinsics_.width && v < intrinsics_.height &&
               jump(hit.depth, seen_[at(u, v)].depth);
    };
    const bool edge = beside(x - 1, y) || beside(x + 1, y) || beside(x, y - 1) || beside(x, y + 1);
    return edge && random.smooth_normal(Draw::ragged, x, y) < ragged;
}

} // namespace toile::simulated_sensor
