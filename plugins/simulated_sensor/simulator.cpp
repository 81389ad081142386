#include "simulated_sensor/simulator.h"

#include "core/error.h"

#include <algorithm>

namespace toile::simulated_sensor {
namespace {

constexpr float kFloorHalf = 8.0f; // metres

/// A rectangle of two triangles, counter-clockwise seen from its front.
Surface rectangle(const std::string& name, const std::array<Vec3f, 4>& corners,
                  const SurfaceLook& look) {
    Surface out;
    out.name = name;
    out.triangles = {{0, 1, 2}, {0, 2, 3}};
    out.rest.assign(corners.begin(), corners.end());
    out.look = look;
    return out;
}

} // namespace

Simulator::Simulator(Scenario scenario, RowLoop rows)
    : scenario_(std::move(scenario)), rows_(std::move(rows)) {
    build_room();
    for (const PersonSettings& person : scenario_.people) {
        figures_.push_back(make_figure(person));
        std::vector<std::uint32_t>& numbers = numbers_.emplace_back();
        for (const FigureSurface& surface : figures_.back()->surfaces())
            numbers.push_back(stage_.add(surface.surface, surface.positions));
    }
    for (std::size_t i = 0; i < scenario_.cameras.size(); ++i) {
        const auto number = static_cast<std::uint32_t>(i);
        const CameraSettings& settings = scenario_.cameras[i];
        cameras_.push_back({DepthCamera(settings, scenario_.seed, number), std::nullopt});
        if (scenario_.color) cameras_.back().color.emplace(settings, scenario_.seed, number);
    }
}

void Simulator::build_room() {
    const SceneSettings& scene = scenario_.scene;
    const auto add = [&](Surface surface) {
        const std::vector<Vec3f> positions = surface.rest;
        stage_.add(std::move(surface), positions);
    };
    if (scene.floor)
        add(rectangle("floor",
                      {Vec3f(-kFloorHalf, 0, kFloorHalf), Vec3f(kFloorHalf, 0, kFloorHalf),
                       Vec3f(kFloorHalf, 0, -kFloorHalf), Vec3f(-kFloorHalf, 0, -kFloorHalf)},
                      {scene.floor_color, nullptr, Grain::boards}));
    for (const WallSettings& wall : scene.walls) {
        const Quatf turn(Eigen::AngleAxisf(static_cast<float>(wall.turn), Vec3f::UnitY()));
        const Vec3f side = turn * Vec3f(0.5f * static_cast<float>(wall.width_m), 0, 0);
        const Vec3f up(0, static_cast<float>(wall.height_m), 0);
        add(rectangle("wall",
                      {wall.position - side, wall.position + side, wall.position + side + up,
                       wall.position - side + up},
                      {wall.color, nullptr, Grain::plaster}));
    }
    for (const ObjectSettings& object : scene.objects) {
        const Quatf turn(Eigen::AngleAxisf(static_cast<float>(object.turn), Vec3f::UnitY()));
        for (FigureSurface& surface : load_surfaces(object.mesh)) {
            if (!surface.surface.look.texture) surface.surface.look.albedo = object.color;
            for (Vec3f& p : surface.surface.rest)
                p = turn * p + object.position;
            add(std::move(surface.surface));
        }
    }
}

void Simulator::show(std::uint32_t frame) {
    if (shown_ == frame) return;
    shown_.reset();
    for (std::size_t f = 0; f < figures_.size(); ++f) {
        figures_[f]->pose(scenario_.time_of(frame));
        const auto surfaces = figures_[f]->surfaces();
        for (std::size_t s = 0; s < surfaces.size(); ++s)
            stage_.move(numbers_[f][s], surfaces[s].positions);
    }
    stage_.commit();
    shown_ = frame;
}

void Simulator::see(std::size_t camera) {
    if (!shown_) throw Error("no frame of the scenario is shown yet");
    Camera& seeing = cameras_.at(camera);
    seeing.depth.look(stage_, rows_);
    seeing.depth.measure(stage_, *shown_, rows_);
    if (seeing.color)
        seeing.color->shade(stage_, seeing.depth, scenario_.scene.lighting, *shown_, rows_);
}

const imaging::Image& Simulator::picture(std::size_t index) const {
    static const imaging::Image none;
    const Camera& seeing = cameras_.at(index);
    return seeing.color ? seeing.color->picture() : none;
}

std::vector<body::TrackedPerson> Simulator::people() const {
    std::vector<body::TrackedPerson> out;
    for (std::size_t f = 0; f < figures_.size(); ++f) {
        if (!figures_[f]->joints()) continue;
        body::TrackedPerson person;
        person.id = static_cast<std::uint32_t>(f + 1);
        person.state = body::TrackState::tracked;
        person.joints = *figures_[f]->joints();
        person.confidence.fill(1.0f);
        out.push_back(person);
    }
    return out;
}

} // namespace toile::simulated_sensor
