// A scenario: who stands where and moves how, what is around, and which cameras look at it.
// The file format stands in docs/file_formats.md and docs/schemas/scenario.schema.json.
#pragma once

#include "body/skeleton.h"
#include "simulated_sensor/camera_model.h"
#include "simulated_sensor/color_camera.h"
#include "simulated_sensor/hair_cap.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace toile::simulated_sensor {

enum class BodyKind : std::uint8_t { invalid, avatar, mesh, surfaces, test_person };

/// A thing that goes with a joint as if it were grown to it: a bag, a stick, a hat.
struct CarriedSettings {
    std::filesystem::path mesh; ///< metres, as it hangs on the person at rest, facing +Z
    body::Joint joint = body::Joint::hips;
    Vec3f position = Vec3f::Zero(); ///< of the mesh's origin from the joint, at rest
    Vec3f color = Vec3f(0.05f, 0.04f, 0.03f);
};

struct PersonSettings {
    BodyKind kind = BodyKind::invalid;
    std::filesystem::path source; ///< the avatar's or person's folder, mesh file, or cache
    std::vector<double> shape;    ///< coefficients of an avatar's shape components
    std::filesystem::path motion; ///< moves through it once, then stays; empty: none
    std::vector<std::filesystem::path> poses; ///< one after the other, then stays in the last
    double hold_s = 0.0;                      ///< how long each pose is held
    double change_s = 1.0;                    ///< and how long the way to the next takes
    double turntable_s = 0.0;                 ///< seconds a turn; 0: does not turn
    double breath_m = 0.0;                    ///< how far the chest rises, every four seconds
    Vec3f position = Vec3f::Zero();           ///< where the person's own x = z = 0 is, metres
    double turn = 0.0;                        ///< about +Y, radians
    std::optional<HairSettings> hair;
    std::vector<CarriedSettings> carried;
    std::optional<Vec3f> skin; ///< linear; instead of the body's own colours
    bool suit = false;         ///< a test person wears a printed sports suit, as tight as skin
};

struct ObjectSettings {
    std::filesystem::path mesh;
    Vec3f position = Vec3f::Zero();
    double turn = 0.0; ///< about +Y, radians
    Vec3f color = Vec3f::Constant(0.4f);
};

/// An upright wall through a point, with its face towards +Z turned about +Y.
struct WallSettings {
    Vec3f position = Vec3f(0.0f, 0.0f, -1.2f); ///< middle of its foot, metres
    double turn = 0.0;                         ///< radians
    double width_m = 6.0;
    double height_m = 3.0;
    Vec3f color = Vec3f(0.55f, 0.53f, 0.5f);
};

struct SceneSettings {
    bool floor = true;
    Vec3f floor_color = Vec3f(0.22f, 0.15f, 0.09f);
    std::vector<WallSettings> walls;
    std::vector<ObjectSettings> objects;
    Lighting lighting;
};

struct Scenario {
    std::string name;
    std::uint64_t seed = 1;
    std::uint32_t frames = 1;
    double frames_per_second = 30.0;
    bool color = true; ///< the cameras deliver colour pictures too
    std::vector<PersonSettings> people;
    SceneSettings scene;
    std::vector<CameraSettings> cameras;

    [[nodiscard]] double time_of(std::uint32_t frame) const { return frame / frames_per_second; }
};

/// Reads a scenario; relative paths in it start at its folder. \throw Error naming the place and
/// what is wrong: an unknown key, a missing file, no camera, a number out of range ...
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file);

} // namespace toile::simulated_sensor
