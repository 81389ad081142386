// One person of a scenario, whatever the body is made of: surfaces and joints at any time.
#pragma once

#include "body/surface_cache.h"
#include "simulated_sensor/scenario.h"
#include "simulated_sensor/stage.h"

#include <memory>

namespace toile::simulated_sensor {

/// A surface of a figure and where it is now.
struct FigureSurface {
    Surface surface;
    std::vector<Vec3f> positions; ///< (nv) world
    body::SurfaceRole role = body::SurfaceRole::other;
};

class Figure {
  public:
    virtual ~Figure() = default;
    Figure(const Figure&) = delete;
    Figure& operator=(const Figure&) = delete;

    /// Gives the person what it carries. \throw Error when a file cannot be used
    void take_up(const std::vector<CarriedSettings>& things);
    /// Moves everything to where it is at a time. \throw Error when a recording cannot be read
    void pose(double time_s);

    [[nodiscard]] std::span<const FigureSurface> surfaces() const noexcept { return surfaces_; }
    /// Nothing for a body without joints.
    [[nodiscard]] const std::optional<body::JointTransforms>& joints() const noexcept {
        return joints_;
    }

  protected:
    explicit Figure(const PersonSettings& settings) : settings_(settings) {}
    /// Poses the surfaces; `place` moves the person's own frame into the world.
    virtual void pose_at(double time_s, const RigidTransform& place) = 0;

    PersonSettings settings_;
    std::vector<FigureSurface> surfaces_;
    std::optional<body::JointTransforms> joints_;

  private:
    struct Carried {
        std::size_t surface = 0; ///< into surfaces_
        body::Joint joint = body::Joint::hips;
    };
    std::vector<Carried> carried_;
};

/// \throw Error when its files cannot be used
[[nodiscard]] std::unique_ptr<Figure> make_figure(const PersonSettings& settings);

/// A mesh file's primitives, where they stand at rest. \throw Error
[[nodiscard]] std::vector<FigureSurface> load_surfaces(const std::filesystem::path& mesh);

} // namespace toile::simulated_sensor
