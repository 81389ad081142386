// Four simulated cameras around a person in a room, and what a fit sees of the person.
#pragma once

#include "assets/files.h"
#include "core/parallel.h"
#include "scape_fit/person_finder.h"
#include "simulated_sensor/simulator.h"

#include <chrono>
#include <functional>
#include <numbers>
#include <string>

namespace toile::evaluation {

/// Four walls, 7 m apart; nobody in it, no cameras.
inline simulated_sensor::Scenario empty_room() {
    simulated_sensor::Scenario out;
    out.color = false;
    for (int i = 0; i < 4; ++i) {
        simulated_sensor::WallSettings wall;
        wall.turn = 0.5 * std::numbers::pi * i;
        wall.position = Quatf(Eigen::AngleAxisf(static_cast<float>(wall.turn), Vec3f::UnitY())) *
                        Vec3f(0.0f, 0.0f, -3.5f);
        wall.width_m = 7.0;
        out.scene.walls.push_back(wall);
    }
    return out;
}

/// Kinects v1, upright, 90 degrees apart at 2.4 m, the first one in front. `noise`: none, usual or
/// full.
inline void add_cameras(simulated_sensor::Scenario& scenario, int count, const std::string& noise) {
    namespace sensor = simulated_sensor;
    for (int i = 0; i < count; ++i) {
        sensor::CameraSettings camera = sensor::camera_of(sensor::CameraModel::kinect_v1);
        const double angle = 0.5 * std::numbers::pi * i;
        camera.name = "side" + std::to_string(i);
        const Vec3d place(2.4 * std::sin(angle), 1.0, 2.4 * std::cos(angle));
        camera.upright = true;
        camera.world_from_camera = sensor::look_at(place, Vec3d(0.0, 0.9, 0.0));
        camera.noise = noise == "none"   ? sensor::no_noise()
                       : noise == "full" ? sensor::full_noise(camera.model)
                                         : sensor::usual_noise(camera.model);
        scenario.cameras.push_back(camera);
    }
}

inline scape_fit::ObservedPerson observe(simulated_sensor::Simulator& simulator,
                                         std::size_t instant) {
    std::vector<std::shared_ptr<scape_fit::DepthView>> views;
    for (std::size_t c = 0; c < simulator.camera_count(); ++c) {
        simulator.see(c);
        auto view = std::make_shared<scape_fit::DepthView>();
        view->camera = simulator.camera(c).intrinsics();
        view->world_from_camera = simulator.camera(c).reported_pose();
        view->depth = simulator.camera(c).depth();
        view->color = simulator.picture(c);
        views.push_back(view);
    }
    return scape_fit::observe_person(views, instant);
}

/// A surface of one colour (linear) for a scene that simulated people are made of.
inline void add_mesh(assets::Scene& scene, const geometry::TriangleMesh& mesh, const Vec3f& color) {
    assets::Material material;
    material.base_color.head<3>() = color;
    assets::Primitive primitive;
    primitive.positions = mesh.positions;
    primitive.triangles = mesh.triangles;
    primitive.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    assets::Node node;
    node.name = "surface" + std::to_string(scene.nodes.size());
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back({node.name, {std::move(primitive)}, {}});
    scene.nodes.push_back(node);
}

inline void rows_on_all_cores(std::uint32_t count, std::uint32_t grain,
                              const std::function<void(std::uint32_t, std::uint32_t)>& work) {
    const std::uint32_t ranges = (count + grain - 1) / grain;
    parallel_for(ranges, [&](std::size_t r) {
        const auto begin = static_cast<std::uint32_t>(r) * grain;
        work(begin, std::min(count, begin + grain));
    });
}

inline double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

} // namespace toile::evaluation
