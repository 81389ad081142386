// A small sound garment package, made in memory.
#pragma once

#include "garment/package.h"

#include <cmath>
#include <numbers>

namespace toile::test {

/// A tube around the y axis from `low` to `high`, closed to a ring by a seam at angle 0: a skirt of
/// `around` x `rows` quads. Material coordinates are exact: u along the ring, v up.
inline garment::GarmentSize tube_size(const std::string& name, float radius, float low, float high,
                                      int around = 24, int rows = 8) {
    garment::GarmentSize size;
    size.entry.name = name;
    size.entry.mesh = name + ".glb";
    size.entry.chart["waist_girth"] = {0.6, 0.8};
    auto& mesh = size.simulation;
    const auto height = static_cast<float>(rows);
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < around; ++i) {
            const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) /
                                static_cast<float>(around);
            mesh.positions.emplace_back(radius * std::sin(angle),
                                        low + (high - low) * static_cast<float>(j) / height,
                                        radius * std::cos(angle));
        }
    const float step =
        2.0f * radius * std::sin(std::numbers::pi_v<float> / static_cast<float>(around));
    const auto vertex = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * around + i % around);
    };
    const auto material = [&](int i, int j) {
        return Vec2f(step * static_cast<float>(i), (high - low) * static_cast<float>(j) / height);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
            size.material_coords.insert(size.material_coords.end(),
                                        {material(i, j), material(i + 1, j), material(i + 1, j + 1),
                                         material(i, j), material(i + 1, j + 1),
                                         material(i, j + 1)});
        }
    // The render mesh: the same surface 1 mm further out, cut along the seam, textured.
    assets::Primitive p;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= around; ++i) {
            const Vec3f& x = mesh.positions[vertex(i, j)];
            const Vec3f out = Vec3f(x.x(), 0.0f, x.z()).normalized();
            p.positions.push_back(x + 0.001f * out);
            p.normals.push_back(out);
            p.texcoords.emplace_back(static_cast<float>(i) / static_cast<float>(around),
                                     1.0f - static_cast<float>(j) / height);
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (around + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            p.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            p.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    p.material = 0;
    assets::Texture texture;
    texture.name = "checks";
    texture.image = {
        2, 2, {200, 30, 40, 255, 240, 240, 240, 255, 240, 240, 240, 255, 200, 30, 40, 255}};
    size.render.textures.push_back(texture);
    assets::Material cloth;
    cloth.name = "cloth";
    cloth.base_color_texture = 0;
    assets::Material dark = cloth;
    dark.name = "dark";
    dark.base_color = Vec4f(0.02f, 0.02f, 0.05f, 1.0f);
    size.render.materials = {cloth, dark};
    size.render.variants = {"red", "navy"};
    p.variant_materials = {0, 1};
    assets::Mesh drawn;
    drawn.name = "render";
    drawn.primitives.push_back(p);
    size.render.meshes.push_back(drawn);
    assets::Node node;
    node.name = "render";
    node.mesh = 0;
    size.render.nodes.push_back(node);
    return size;
}

/// A knee-length skirt in two sizes with a pinned waist and two colourways.
inline garment::GarmentPackage small_package() {
    garment::GarmentPackage package;
    auto& m = package.manifest;
    m.id = "test-skirt";
    m.version = "1.2.3";
    m.name = "Test skirt";
    m.maker = "Toile";
    m.licence = "Apache-2.0";
    m.kind = "skirt";
    m.layer = 1;
    package.sizes = {tube_size("S", 0.20f, 0.5f, 1.0f), tube_size("M", 0.22f, 0.5f, 1.0f)};
    for (const auto& size : package.sizes)
        m.sizes.push_back(size.entry);
    garment::PinGroup waist;
    waist.name = "waistband";
    for (std::uint32_t i = 0; i < 24; ++i)
        waist.vertices.push_back(8 * 24 + i);
    m.pins.push_back(waist);
    m.variants = {{"Red", "red", std::nullopt}, {"Navy", "navy", Vec3f(0.2f, 0.2f, 0.4f)}};
    m.body_mask = {body::Part::pelvis, body::Part::left_upper_leg};
    return package;
}

} // namespace toile::test
