// A scene that holds one of everything we can write.
#pragma once

#include "assets/scene.h"
#include "assets/skins.h"
#include "core/random.h"
#include "support/meshes.h"

namespace toile::test {

// A skinned, morphing, textured, animated tube with two materials.
inline assets::Scene everything() {
    using namespace assets;
    Scene scene;
    const geometry::TriangleMesh tube = test::tube(0.2f, 0.1f, 1.0f, 12, 6);
    Primitive p;
    p.positions = tube.positions;
    p.triangles = tube.triangles;
    p.normals.resize(p.positions.size());
    geometry::vertex_normals(p.positions, p.triangles, p.normals);
    MorphTarget wide{"wide", {}, {}};
    for (const Vec3f& v : p.positions) {
        p.texcoords.emplace_back(v.x(), v.y());
        p.joints.push_back({1, 2, 0, 0});
        p.weights.push_back({1.0f - v.y(), v.y(), 0.0f, 0.0f});
        wide.positions.emplace_back(0.1f * v.x(), 0.0f, 0.1f * v.z());
    }
    p.morphs = {wide};
    p.material = 0;
    p.variant_materials = {kNone, 1};
    scene.meshes = {{"tube", {p}, {0.25f}}};

    scene.nodes.resize(5);
    scene.nodes[0].name = "root";
    scene.nodes[1] = {"hips", 0, Vec3f(0, 0.1f, 0), Quatf::Identity(), Vec3f::Ones(), kNone, kNone};
    scene.nodes[2] = {"spine",
                      1,
                      Vec3f(0, 0.5f, 0),
                      Quatf(Eigen::AngleAxisf(0.3f, Vec3f::UnitX())),
                      Vec3f::Ones(),
                      kNone,
                      kNone};
    scene.nodes[3] = {"idle", 2, Vec3f(0, 0.4f, 0), Quatf::Identity(), Vec3f::Ones(), kNone, kNone};
    scene.nodes[4] = {"body", kNone, Vec3f::Zero(), Quatf::Identity(), Vec3f::Ones(), 0, 0};
    const auto world = node_transforms(scene);
    Skin skin{"skin", {1, 2, 3}, {}};
    for (const int j : skin.joints)
        skin.inverse_bind.push_back(world[static_cast<std::size_t>(j)].inverse());
    for (auto& row : scene.meshes[0].primitives[0].joints)
        row = {0, 1, 0, 0};
    for (std::size_t v = 0; v < p.positions.size(); ++v) // no joint without weight
        if (p.weights[v][1] == 0.0f) scene.meshes[0].primitives[0].joints[v][1] = 0;
    scene.skins = {skin};

    Texture texture{"weave", {8, 8, {}}, false};
    Random random(7);
    for (int i = 0; i < 8 * 8 * 4; ++i)
        texture.image.pixels.push_back(static_cast<std::uint8_t>(random.next()));
    scene.textures = {texture};
    Material cloth;
    cloth.name = "cloth";
    cloth.base_color_texture = 0;
    cloth.sheen_color = Vec3f(0.5f, 0.4f, 0.3f);
    cloth.sheen_roughness = 0.3f;
    Material plain;
    plain.name = "plain";
    plain.base_color = Vec4f(0.1f, 0.2f, 0.3f, 1.0f);
    plain.double_sided = true;
    scene.materials = {cloth, plain};
    scene.variants = {"red", "blue"};

    Channel channel{2, Channel::Path::rotation, {0.0f, 0.5f}, {}};
    channel.values = {Quatf::Identity().coeffs(),
                      Quatf(Eigen::AngleAxisf(1.0f, Vec3f::UnitZ())).coeffs()};
    scene.animations = {{"wave", {channel}}};
    return scene;
}

} // namespace toile::test
