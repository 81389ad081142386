#include "bench/dressed_scene.h"

#include "geometry/mesh.h"

#include <algorithm>

namespace toile::bench {
namespace {

bool in_shirt(const body::BodyModel& model, std::uint32_t v) {
    const float waist = model.skeleton.rest(body::Joint::hips).y();
    const float neck = model.skeleton.rest(body::Joint::neck).y();
    const Vec3f& p = model.rest.positions[v];
    switch (model.parts[v]) {
    case body::Part::torso:
    case body::Part::pelvis:
        return p.y() > waist - 0.05f && p.y() < neck - 0.02f;
    case body::Part::left_upper_arm:
    case body::Part::right_upper_arm:
        return true;
    default:
        return false;
    }
}

/// Draws each vertex to the mean of its neighbours.
void smooth(std::span<Vec3f> points, const geometry::VertexAdjacency& next) {
    const std::vector<Vec3f> old(points.begin(), points.end());
    for (std::size_t v = 0; v < points.size(); ++v) {
        Vec3f mean = Vec3f::Zero();
        for (std::uint32_t k = next.first[v]; k < next.first[v + 1]; ++k) {
            mean += old[next.neighbours[k]];
        }
        const auto count = static_cast<float>(next.first[v + 1] - next.first[v]);
        if (count > 0.0f) {
            points[v] = 0.5f * (old[v] + mean / count);
        }
    }
}

bullet_cloth::GarmentInput input_of(const Shirt& shirt) {
    bullet_cloth::GarmentInput input;
    input.mesh.positions = shirt.positions;
    input.mesh.triangles = shirt.triangles;
    input.joints = shirt.skin.joints;
    input.weights = shirt.skin.weights;
    return input;
}

} // namespace

Shirt make_shirt(const body::BodyModel& model) {
    constexpr float kOut = 0.015f; // m
    const std::size_t count = model.rest.positions.size();
    // Normals of a smoothed body, so that the shirt bridges its hollows.
    std::vector<Vec3f> base = model.rest.positions;
    const auto adjacency = geometry::vertex_adjacency(count, model.rest.triangles);
    for (int i = 0; i < 6; ++i) {
        smooth(base, adjacency);
    }
    std::vector<Vec3f> normals(count);
    geometry::vertex_normals(base, model.rest.triangles, normals);
    Shirt shirt;
    std::vector<std::uint32_t> index(count, 0);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (in_shirt(model, v)) {
            index[v] = static_cast<std::uint32_t>(shirt.positions.size());
            shirt.positions.push_back(model.rest.positions[v] + kOut * normals[v]);
            shirt.skin.joints.push_back(model.skin.joints[v]);
            shirt.skin.weights.push_back(model.skin.weights[v]);
        }
    }
    for (const Triangle& t : model.rest.triangles) {
        if (in_shirt(model, t[0]) && in_shirt(model, t[1]) && in_shirt(model, t[2])) {
            shirt.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
        }
    }
    return shirt;
}

DressedScene::DressedScene(const body::BodyModel& model, const bullet_cloth::Settings& settings)
    : model_(model), shirt_(make_shirt(model)),
      body_surface_(model.rest.positions, model.rest.normals, model.skin.joints,
                    model.skin.weights),
      shirt_surface_(shirt_.positions, {}, shirt_.skin.joints, shirt_.skin.weights),
      world_(settings), before_(model.rest.positions), after_(model.rest.positions),
      normals_(model.rest.positions.size()), targets_(shirt_.positions),
      positions_(shirt_.positions), shirt_normals_(shirt_.positions.size()) {
    world_.set_body(
        {model.rest.positions, model.rest.triangles, model.skin.joints, model.skin.weights});
    handle_ = world_.add_garment(input_of(shirt_));
}

void DressedScene::pose(const body::JointTransforms& world) noexcept {
    before_.swap(after_);
    const body::JointTransforms skinning = body::skinning_transforms(model_.skeleton, world);
    body_surface_.pose(skinning, body::SkinningMethod::linear_blend, body::VectorRows(after_),
                       body::VectorRows(normals_));
    shirt_surface_.pose(skinning, body::SkinningMethod::linear_blend, body::VectorRows(targets_),
                        {});
}

bool DressedScene::step_cloth(double dt_s, bool reset) noexcept {
    const bullet_cloth::GarmentFrame frame{handle_, targets_, positions_, shirt_normals_};
    const std::span<const Vec3f> before = reset ? after_ : before_;
    return world_.step({before, after_, dt_s, reset, std::span(&frame, 1)}) ==
           bullet_cloth::StepResult::ok;
}

} // namespace toile::bench
