#include "simulated_sensor/color_camera.h"

#include "imaging/srgb.h"

#include <algorithm>
#include <cmath>

namespace toile::simulated_sensor {
namespace {

constexpr std::uint32_t kGrain = 16; // rows a range
constexpr float kShot = 8e-4f;       // variance of the noise per unit of light
constexpr float kRead = 4e-6f;       // and without any
constexpr float kBlurSide = 1.0f / 6.0f;
constexpr std::size_t kEncodings = 4096;

std::uint8_t encode(float linear) {
    static const std::vector<std::uint8_t> table = [] {
        std::vector<std::uint8_t> made(kEncodings);
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = static_cast<std::uint8_t>(std::lround(
                255.0f * imaging::srgb_from_linear(static_cast<float>(i) / (kEncodings - 1))));
        return made;
    }();
    const float clamped = std::clamp(linear, 0.0f, 1.0f);
    return table[static_cast<std::size_t>(clamped * (kEncodings - 1) + 0.5f)];
}

float decode(std::uint8_t value) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = imaging::linear_from_srgb(static_cast<float>(i) / 255.0f);
        return made;
    }();
    return table[value];
}

// Linear colour between four texels; coordinates outside [0, 1] repeat the picture.
Vec3f sample(const imaging::Image& image, const Vec2f& coords) {
    const float u = (coords.x() - std::floor(coords.x())) * static_cast<float>(image.width) - 0.5f;
    const float v = (coords.y() - std::floor(coords.y())) * static_cast<float>(image.height) - 0.5f;
    const auto wrap = [](int i, int n) { return (i % n + n) % n; };
    const int x = static_cast<int>(std::floor(u));
    const int y = static_cast<int>(std::floor(v));
    const auto texel = [&](int dx, int dy) {
        const std::size_t i = 4 * (static_cast<std::size_t>(wrap(y + dy, image.height)) *
                                       static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(wrap(x + dx, image.width)));
        return Vec3f(decode(image.pixels[i]), decode(image.pixels[i + 1]),
                     decode(image.pixels[i + 2]));
    };
    const float a = u - static_cast<float>(x);
    const float b = v - static_cast<float>(y);
    return (1 - b) * ((1 - a) * texel(0, 0) + a * texel(1, 0)) +
           b * ((1 - a) * texel(0, 1) + a * texel(1, 1));
}

std::uint32_t hash(int x, int y, int z) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                      static_cast<std::uint32_t>(y) * 0xd8163841u ^
                      static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

// Uniform in [-1, 1) at whole coordinates, smooth between them.
float value_noise(const Vec3f& p) {
    std::array<int, 3> cell{};
    Vec3f t;
    for (int k = 0; k < 3; ++k) {
        const float low = std::floor(p[k]);
        cell[static_cast<std::size_t>(k)] = static_cast<int>(low);
        const float f = p[k] - low;
        t[k] = f * f * (3.0f - 2.0f * f);
    }
    float sum = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1;
        const int dy = (corner >> 1) & 1;
        const int dz = corner >> 2;
        const float weight = (dx != 0 ? t.x() : 1.0f - t.x()) * (dy != 0 ? t.y() : 1.0f - t.y()) *
                             (dz != 0 ? t.z() : 1.0f - t.z());
        sum += weight *
               (static_cast<float>(hash(cell[0] + dx, cell[1] + dy, cell[2] + dz)) * 0x1.0p-31f -
                1.0f);
    }
    return sum;
}

// One dark spot in every few cells of 3 cm, 1 to 2.5 mm wide.
float spots(const Vec3f& p) {
    constexpr float kCell = 0.03f;
    const Vec3f q = p / kCell;
    const int x = static_cast<int>(std::floor(q.x()));
    const int y = static_cast<int>(std::floor(q.y()));
    const int z = static_cast<int>(std::floor(q.z()));
    const std::uint32_t h = hash(x, y, z);
    if ((h & 7u) != 0) return 1.0f;
    const Vec3f centre(static_cast<float>(x) + static_cast<float>((h >> 8) & 255u) / 255.0f,
                       static_cast<float>(y) + static_cast<float>((h >> 16) & 255u) / 255.0f,
                       static_cast<float>(z) + static_cast<float>(h >> 24) / 255.0f);
    const float radius = 0.001f + 0.0015f * static_cast<float>((h >> 3) & 31u) / 31.0f;
    return (q - centre).norm() * kCell < radius ? 0.55f : 1.0f;
}

struct Shader {
    const Stage& stage;
    const HitMap& hits;
    const Lighting& lighting;
    Vec3f origin;

    [[nodiscard]] Vec3f light(std::size_t pixel, const Vec3f& direction) const {
        if (!(hits.depth[pixel] < std::numeric_limits<float>::infinity()))
            return Vec3f::Constant(0.01f);
        const Surface& surface = stage.surface(hits.surface[pixel]);
        const Triangle& corners = surface.triangles[hits.triangle[pixel]];
        const auto& [v, w] = hits.place[pixel];
        const std::array<float, 3> weight = {1.0f - v - w, v, w};
        const auto between = [&](const auto& values) {
            return Vec3f(weight[0] * values[corners[0]] + weight[1] * values[corners[1]] +
                         weight[2] * values[corners[2]]);
        };
        Vec3f color = surface.look.albedo.cwiseProduct(
            grain_color(surface.look.grain, between(surface.rest)));
        if (!surface.tint.empty()) color = color.cwiseProduct(between(surface.tint));
        if (surface.look.texture && !surface.corner_coords.empty()) {
            const Vec2f* coords = surface.corner_coords.data() + 3 * hits.triangle[pixel];
            color = color.cwiseProduct(sample(
                *surface.look.texture,
                Vec2f(weight[0] * coords[0] + weight[1] * coords[1] + weight[2] * coords[2])));
        }
        Vec3f normal = between(stage.normals(hits.surface[pixel])).normalized();
        if (normal.dot(direction) > 0.0f) normal = -normal;
        const Vec3f point = origin + hits.depth[pixel] * direction;
        return color.cwiseProduct(ambient(normal) + lamp(point, normal));
    }

    [[nodiscard]] Vec3f ambient(const Vec3f& normal) const {
        return (0.7f + 0.3f * normal.y()) * lighting.ambient_color;
    }

    [[nodiscard]] Vec3f lamp(const Vec3f& point, const Vec3f& normal) const {
        const Vec3f way = lighting.lamp_position - point;
        const float square = way.squaredNorm();
        const float facing = normal.dot(way);
        if (!(facing > 0.0f) || stage.blocked(point + 0.002f * normal, lighting.lamp_position))
            return Vec3f::Zero();
        return facing / (square * std::sqrt(square)) * lighting.lamp_color;
    }
};

} // namespace

Vec3f grain_color(Grain grain, const Vec3f& p) noexcept {
    switch (grain) {
    case Grain::skin: {
        const float fine = 1.0f + 0.04f * value_noise(40.0f * p) + 0.05f * value_noise(160.0f * p);
        const float red = 1.0f + 0.03f * value_noise(15.0f * p);
        return spots(p) * fine * Vec3f(red, 1.0f, 1.0f);
    }
    case Grain::cloth:
        return Vec3f::Constant(1.0f + 0.08f * value_noise(90.0f * p) +
                               0.06f * value_noise(220.0f * p));
    case Grain::hair:
        return Vec3f::Constant(
            1.0f + 0.5f * value_noise(Vec3f(250.0f * p.x(), 25.0f * p.y(), 250.0f * p.z())));
    case Grain::boards: { // 12 cm wide, along z
        const int board = static_cast<int>(std::floor(p.x() / 0.12f));
        const float tone = 0.12f * (static_cast<float>(hash(board, 0, 7)) * 0x1.0p-31f - 1.0f);
        const float groove = p.x() / 0.12f - static_cast<float>(board) < 0.03f ? 0.6f : 1.0f;
        return groove *
               Vec3f::Constant(1.0f + tone +
                               0.1f * value_noise(Vec3f(60.0f * p.x(), 0.0f,
                                                        3.0f * p.z() + static_cast<float>(board))));
    }
    case Grain::plaster:
        return Vec3f::Constant(1.0f + 0.03f * value_noise(12.0f * p) +
                               0.02f * value_noise(2.0f * p));
    case Grain::print: { // dark and light patches, 2 to 5 cm wide
        const float n = value_noise(22.0f * p) + 0.5f * value_noise(50.0f * p);
        const float t = std::clamp((n + 0.15f) / 0.3f, 0.0f, 1.0f);
        return Vec3f::Constant(0.35f + 0.9f * t * t * (3.0f - 2.0f * t));
    }
    default:
        return Vec3f::Ones();
    }
}

ColorCamera::ColorCamera(const CameraSettings& settings, std::uint64_t seed, std::uint32_t number)
    : noise_(settings.noise.color), seed_(seed), number_(number) {
    const imaging::Intrinsics in = settings.intrinsics();
    const std::size_t pixels =
        static_cast<std::size_t>(in.width) * static_cast<std::size_t>(in.height);
    light_.resize(pixels);
    blurred_.resize(pixels);
    picture_ = {in.width, in.height, std::vector<std::uint8_t>(4 * pixels, 255)};
}

void ColorCamera::shade(const Stage& stage, const DepthCamera& depth, const Lighting& lighting,
                        std::uint32_t frame, const RowLoop& rows) {
    const int width = picture_.width;
    const int height = picture_.height;
    const auto at = [width](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    };
    const Shader shader{stage, depth.hits(), lighting, depth.origin()};
    const auto light_rows = [&](std::uint32_t begin, std::uint32_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x)
                light_[at(x, y)] = shader.light(at(x, y), depth.directions()[at(x, y)]);
            for (int x = 0; x < width; ++x)
                blurred_[at(x, y)] = (1.0f - 2.0f * kBlurSide) * light_[at(x, y)] +
                                     kBlurSide * (light_[at(std::max(0, x - 1), y)] +
                                                  light_[at(std::min(width - 1, x + 1), y)]);
        }
    };
    const PixelRandom random(seed_, number_, frame);
    const auto develop_rows = [&](std::uint32_t begin, std::uint32_t end) {
        constexpr std::array<Draw, 3> draws = {Draw::red, Draw::green, Draw::blue};
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                const Vec3f mean = (1.0f - 2.0f * kBlurSide) * blurred_[at(x, y)] +
                                   kBlurSide * (blurred_[at(x, std::max(0, y - 1))] +
                                                blurred_[at(x, std::min(height - 1, y + 1))]);
                for (std::size_t k = 0; k < 3; ++k) {
                    float value = mean[static_cast<Eigen::Index>(k)];
                    if (noise_ > 0.0)
                        value += static_cast<float>(noise_) *
                                 std::sqrt(kShot * std::max(0.0f, value) + kRead) *
                                 random.normal(draws[k], x, y);
                    picture_.pixels[4 * at(x, y) + k] = encode(value);
                }
            }
    };
    rows(static_cast<std::uint32_t>(height), kGrain, light_rows);
    rows(static_cast<std::uint32_t>(height), kGrain, develop_rows);
}

} // namespace toile::simulated_sensor
