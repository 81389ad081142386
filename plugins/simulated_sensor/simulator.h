// A scenario being played: cameras that see people move.
#pragma once

#include "simulated_sensor/color_camera.h"
#include "simulated_sensor/depth_camera.h"
#include "simulated_sensor/figure.h"
#include "simulated_sensor/scenario.h"

#include <deque>
#include <memory>

namespace toile::simulated_sensor {

/// Frames may be shown in any order; each is the same whenever it is shown. Not movable.
///
///     Simulator simulator(load_scenario("two_people.json"));
///     simulator.show(0);
///     simulator.see(0);
///     simulator.camera(0).depth();   simulator.picture(0);   simulator.people();
class Simulator {
  public:
    /// \throw Error when a file of the scenario cannot be used
    explicit Simulator(Scenario scenario, RowLoop rows = &serial_rows);
    Simulator(const Simulator&) = delete;
    Simulator& operator=(const Simulator&) = delete;

    /// Poses everybody. Nothing is done when the frame is shown already. \throw Error
    void show(std::uint32_t frame);
    /// One camera's pictures of the frame shown. \throw Error before `show`
    void see(std::size_t camera);

    [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
    [[nodiscard]] std::size_t camera_count() const noexcept { return cameras_.size(); }
    /// Depth, calibration and errors of a camera.
    [[nodiscard]] const DepthCamera& camera(std::size_t index) const {
        return cameras_.at(index).depth;
    }
    /// Its colour picture; empty when the scenario wants none.
    [[nodiscard]] const imaging::Image& picture(std::size_t index) const;

    /// Truth of the frame shown: everybody with joints, numbered from 1 in the scenario's order.
    [[nodiscard]] std::vector<body::TrackedPerson> people() const;
    [[nodiscard]] std::span<const std::unique_ptr<Figure>> figures() const noexcept {
        return figures_;
    }
    [[nodiscard]] const Stage& stage() const noexcept { return stage_; }

  private:
    struct Camera {
        DepthCamera depth;
        std::optional<ColorCamera> color;
    };
    void build_room();

    Scenario scenario_;
    RowLoop rows_;
    Stage stage_;
    std::vector<std::unique_ptr<Figure>> figures_;
    std::vector<std::vector<std::uint32_t>> numbers_; // of the figures' surfaces on the stage
    std::deque<Camera> cameras_;
    std::optional<std::uint32_t> shown_;
};

} // namespace toile::simulated_sensor
