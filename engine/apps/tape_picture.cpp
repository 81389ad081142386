#include "apps/tape_picture.h"

#include "apps/contact_sheet.h"
#include "apps/label.h"
#include "core/error.h"
#include "render/import.h"
#include "render/views.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

namespace toile::apps {
namespace {

constexpr float kRadius = 0.003f; // metres: half a tape's thickness as drawn
constexpr int kSides = 8;
constexpr float kOff = 0.001f; // metres off the skin, so that it is not half drowned

// sRGB colours that stand apart from skin and from each other.
constexpr std::array<std::array<std::uint8_t, 3>, 12> kColors{{{{200, 30, 40}},
                                                               {{20, 90, 180}},
                                                               {{20, 130, 60}},
                                                               {{230, 130, 0}},
                                                               {{120, 50, 150}},
                                                               {{0, 150, 160}},
                                                               {{180, 60, 120}},
                                                               {{110, 80, 30}},
                                                               {{60, 60, 60}},
                                                               {{150, 150, 0}},
                                                               {{90, 110, 220}},
                                                               {{230, 80, 80}}}};

std::array<std::uint8_t, 3> color_of(std::size_t i) {
    return kColors[i % kColors.size()];
}

float linear(std::uint8_t srgb) {
    return std::pow(static_cast<float>(srgb) / 255.0f, 2.2f);
}

/// A round cord along a curve.
geometry::TriangleMesh cord(const geometry::Loop& loop) {
    geometry::TriangleMesh out;
    const auto n = loop.points.size();
    if (n < 2) return out;
    Vec3f side = (loop.points[1] - loop.points[0]).unitOrthogonal();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3f& before = loop.points[i > 0 ? i - 1 : (loop.closed ? n - 1 : 0)];
        const Vec3f& after = loop.points[i + 1 < n ? i + 1 : (loop.closed ? 0 : n - 1)];
        const Vec3f along = (after - before).normalized();
        side = (side - side.dot(along) * along).normalized();
        const Vec3f other = along.cross(side);
        for (int k = 0; k < kSides; ++k) {
            const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / kSides;
            const Vec3f out_ward = std::cos(angle) * side + std::sin(angle) * other;
            out.positions.push_back(loop.points[i] + (kRadius + kOff) * out_ward);
            out.normals.push_back(out_ward);
        }
    }
    const std::size_t rings = loop.closed ? n : n - 1;
    for (std::size_t i = 0; i < rings; ++i)
        for (int k = 0; k < kSides; ++k) {
            const auto at = [&](std::size_t ring, int s) {
                return static_cast<std::uint32_t>(ring % n * kSides +
                                                  static_cast<std::size_t>(s % kSides));
            };
            out.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
            out.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
        }
    return out;
}

render::Instance add(render::Renderer& renderer, const geometry::TriangleMesh& mesh,
                     const render::Material& material) {
    render::MeshDescription description;
    description.triangles = mesh.triangles;
    description.positions = mesh.positions;
    description.normals = mesh.normals;
    render::Instance out;
    out.mesh = renderer.add_mesh(description);
    out.material = renderer.add_material(material);
    return out;
}

imaging::Image legend(std::span<const body::LaidMeasurement> measurements, int height) {
    constexpr int kLine = 26, kWidth = 380, kTop = 40;
    imaging::Image out;
    out.width = kWidth;
    out.height = height;
    out.pixels.assign(static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(height) * 4, 255);
    int y = kTop;
    for (std::size_t i = 0; i < measurements.size() && y + kLine < height; ++i, y += kLine) {
        fill(out, 16, y - 12, 16, 14, color_of(i));
        char value[32];
        std::snprintf(value, sizeof(value), "%6.1f cm", 100.0 * measurements[i].reading.value_m);
        label(out, 42, y, std::string(measurements[i].definition->name));
        label(out, kWidth - 96, y, value);
    }
    return out;
}

} // namespace

imaging::Image draw_tapes(const body::BodyModel& model,
                          std::span<const body::LaidMeasurement> measurements,
                          const TapePictureOptions& options) {
    const auto context = render::make_offscreen_context();
    render::RendererOptions size;
    size.width = options.width;
    size.height = options.height;
    size.quality = render::Quality::high;
    render::Renderer renderer(*context, size);
    render::Scene scene;
    scene.instances.push_back(add(renderer, model.rest, render::mannequin_material()));
    for (std::size_t i = 0; i < measurements.size(); ++i) {
        const auto color = color_of(i);
        render::Material material = render::mannequin_material();
        material.base_color = Vec4f(linear(color[0]), linear(color[1]), linear(color[2]), 1.0f);
        for (const geometry::Loop& tape : measurements[i].reading.tapes) {
            const geometry::TriangleMesh mesh = cord(tape);
            if (!mesh.triangles.empty()) scene.instances.push_back(add(renderer, mesh, material));
        }
    }
    render::Box box;
    for (const Vec3f& p : model.rest.positions)
        box.add(p);
    std::vector<imaging::Image> pictures;
    for (const render::View& view : render::views_from_names(options.views)) {
        scene.camera = render::frame_view(view, box.low, box.high, size.width, size.height);
        scene.lighting = render::studio_lighting(scene.camera);
        renderer.draw(scene);
        pictures.push_back(renderer.read());
    }
    if (options.legend) pictures.push_back(legend(measurements, size.height));
    return side_by_side(pictures);
}

} // namespace toile::apps
