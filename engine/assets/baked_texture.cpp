#include "assets/baked_texture.h"

#include "core/error.h"
#include "geometry/closest_point.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toile::assets {
namespace {

using geometry::SeamedLayout;
using Corners = std::array<Vec3f, 3>;

/// In texels, the centre of the first at (0, 0); z is 0.
Corners flat(const SeamedLayout& layout, std::size_t f, int side) {
    Corners out;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2f& uv = layout.texcoords[layout.triangles[f][k]];
        out[k] = Vec3f(uv.x() * static_cast<float>(side) - 0.5f,
                       uv.y() * static_cast<float>(side) - 0.5f, 0.0f);
    }
    return out;
}

/// Triangles with a side at their chart's rim.
std::vector<bool> at_rim(const SeamedLayout& layout) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    const auto key = [](std::uint32_t a, std::uint32_t b) {
        return std::pair(std::min(a, b), std::max(a, b));
    };
    for (const Triangle& t : layout.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            ++uses[key(t[k], t[(k + 1) % 3])];
    std::vector<bool> out;
    for (const Triangle& t : layout.triangles) {
        bool rim = false;
        for (std::size_t k = 0; k < 3; ++k)
            rim = rim || uses[key(t[k], t[(k + 1) % 3])] == 1;
        out.push_back(rim);
    }
    return out;
}

/// Finds the colour of a place of the coarse surface on the fine one.
class Painter {
  public:
    explicit Painter(const ColoredMesh& fine)
        : fine_(fine), surface_(fine.mesh.positions, fine.mesh.triangles) {}

    [[nodiscard]] Rgba8 color(const Vec3f& place, const Vec3f& normal) const {
        const geometry::SurfacePoint near = surface_.nearest(place);
        if (near.normal.dot(normal) > 0.0f) return mixed(near.triangle, near.barycentric);
        // The other side of something thin: the same side is met along the normal.
        constexpr float kReach_m = 0.02f;
        std::optional<geometry::RayHit> best;
        for (const float sign : {1.0f, -1.0f}) {
            const auto hit = surface_.first_hit(place, sign * normal, 0.0f, kReach_m);
            if (!hit || normal_of(hit->triangle).dot(normal) <= 0.0f) continue;
            if (!best || hit->distance < best->distance) best = hit;
        }
        return best ? mixed(best->triangle, best->barycentric)
                    : mixed(near.triangle, near.barycentric);
    }

  private:
    [[nodiscard]] Vec3f normal_of(std::uint32_t f) const {
        const Triangle& t = fine_.mesh.triangles[f];
        const auto& p = fine_.mesh.positions;
        return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
    }
    [[nodiscard]] Rgba8 mixed(std::uint32_t f, const Vec3f& weights) const {
        Rgba8 out{0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c) {
            float value = 0.0f;
            for (std::size_t k = 0; k < 3; ++k)
                value += weights[static_cast<Eigen::Index>(k)] *
                         static_cast<float>(fine_.colors[fine_.mesh.triangles[f][k]][c]);
            out[c] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 255.0f)));
        }
        return out;
    }

    const ColoredMesh& fine_;
    geometry::NearestSurface surface_;
};

/// Texels that no triangle is near to get the mean of the others.
void fill_rest(const std::vector<int>& shown, imaging::Image& image) {
    std::array<std::uint64_t, 3> sum{};
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        if (shown[i] == kNone) continue;
        ++count;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += image.pixels[4 * i + c];
    }
    for (std::size_t i = 0; i < shown.size(); ++i) {
        for (std::size_t c = 0; c < 3 && shown[i] == kNone && count > 0; ++c)
            image.pixels[4 * i + c] = static_cast<std::uint8_t>(sum[c] / count);
        image.pixels[4 * i + 3] = 255;
    }
}

template <class T>
void cut(std::vector<T>& values, const std::vector<std::uint32_t>& welded) {
    if (values.empty()) return;
    std::vector<T> out;
    out.reserve(welded.size());
    for (const std::uint32_t v : welded)
        out.push_back(values.at(v));
    values = std::move(out);
}

} // namespace

std::vector<int> atlas_triangles(const SeamedLayout& layout, int side, int gutter) {
    const auto row = static_cast<std::size_t>(side);
    std::vector<int> out(row * row, kNone);
    constexpr float kInside = 1e-6f; // square of what counts as no distance, texels
    std::vector<float> off(row * row, static_cast<float>(gutter * gutter) + kInside);
    const std::vector<bool> rim = at_rim(layout);
    for (std::size_t f = 0; f < layout.triangles.size(); ++f) {
        const Corners t = flat(layout, f, side);
        const float reach = rim[f] ? static_cast<float>(gutter) : 0.0f;
        const Vec3f low = t[0].cwiseMin(t[1]).cwiseMin(t[2]).array() - reach;
        const Vec3f high = t[0].cwiseMax(t[1]).cwiseMax(t[2]).array() + reach;
        const auto clamped = [&](float v) { return std::clamp(static_cast<int>(v), 0, side - 1); };
        for (int y = clamped(std::ceil(low.y())); y <= clamped(std::floor(high.y())); ++y)
            for (int x = clamped(std::ceil(low.x())); x <= clamped(std::floor(high.x())); ++x) {
                const Vec3f at(static_cast<float>(x), static_cast<float>(y), 0.0f);
                const float squared =
                    (geometry::closest_point(at, t[0], t[1], t[2]).point - at).squaredNorm();
                const std::size_t i =
                    static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x);
                if (squared >= off[i] || (reach == 0.0f && squared > kInside)) continue;
                off[i] = squared;
                out[i] = static_cast<int>(f);
            }
    }
    return out;
}

imaging::Image bake_colors(const ColoredMesh& fine, const geometry::TriangleMesh& coarse,
                           const SeamedLayout& layout, int side, int gutter, const RowLoop& rows) {
    if (fine.colors.empty() || fine.colors.size() != fine.mesh.positions.size())
        throw Error("a texture cannot be made: the surface has no colours");
    if (layout.triangles.size() != coarse.triangles.size())
        throw Error("a texture cannot be made: its atlas is of another surface");
    const Painter painter(fine);
    const std::vector<int> shown = atlas_triangles(layout, side, gutter);
    std::vector<Vec3f> normals(coarse.positions.size());
    geometry::vertex_normals(coarse.positions, coarse.triangles, normals);
    imaging::Image out{side, side, std::vector<std::uint8_t>(4 * shown.size())};
    const auto row = static_cast<std::size_t>(side);
    constexpr std::uint32_t kGrain = 16;
    rows(static_cast<std::uint32_t>(side), kGrain, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::size_t i = begin * row; i < end * row; ++i) {
            if (shown[i] == kNone) continue;
            const auto f = static_cast<std::size_t>(shown[i]);
            const Corners t = flat(layout, f, side);
            const std::size_t x = i % row, y = i / row;
            const Vec3f at(static_cast<float>(x), static_cast<float>(y), 0.0f);
            const Vec3f w = geometry::closest_point(at, t[0], t[1], t[2]).barycentric;
            Vec3f place = Vec3f::Zero(), normal = Vec3f::Zero();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = coarse.triangles[f][k];
                place += w[static_cast<Eigen::Index>(k)] * coarse.positions[v];
                normal += w[static_cast<Eigen::Index>(k)] * normals[v];
            }
            const Rgba8 color = painter.color(place, normal.normalized());
            std::copy(color.begin(), color.end(),
                      out.pixels.begin() + static_cast<std::ptrdiff_t>(4 * i));
        }
    });
    fill_rest(shown, out);
    return out;
}

void put_on(Scene& scene, const SeamedLayout& layout, Texture texture) {
    if (scene.meshes.size() != 1 || scene.meshes.front().primitives.size() != 1 ||
        scene.meshes.front().primitives.front().triangles.size() != layout.triangles.size() ||
        !scene.meshes.front().primitives.front().morphs.empty())
        throw Error("a texture cannot be put on a scene that its atlas is not of");
    Primitive& primitive = scene.meshes.front().primitives.front();
    cut(primitive.positions, layout.welded);
    cut(primitive.normals, layout.welded);
    cut(primitive.joints, layout.welded);
    cut(primitive.weights, layout.welded);
    primitive.colors.clear();
    primitive.texcoords = layout.texcoords;
    primitive.triangles = layout.triangles;
    if (primitive.material == kNone) {
        primitive.material = static_cast<int>(scene.materials.size());
        scene.materials.emplace_back();
        scene.materials.back().double_sided = true;
    }
    Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    if (material.name.empty()) material.name = texture.name;
    material.base_color_texture = static_cast<int>(scene.textures.size());
    scene.textures.push_back(std::move(texture));
}

} // namespace toile::assets
