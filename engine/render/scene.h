// What is to be drawn, as plain data. World as everywhere: metres, +Y up, floor at y = 0.
#pragma once

#include "core/types.h"
#include "imaging/image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace toile::render {

/// Handles into one Renderer; the value-initialised ones mean "none".
enum class TextureId : std::uint32_t { none = 0 };
enum class MeshId : std::uint32_t { none = 0 };
enum class MaterialId : std::uint32_t { none = 0 };

/// What happened to a per-frame call.
enum class Status { invalid, ok, unknown, wrong_count, not_finite };
[[nodiscard]] const char* text(Status status) noexcept;

/// glTF's rough dielectric with KHR_materials_sheen; metals are drawn as rough dielectrics too.
struct Material {
    Vec4f base_color =
        Vec4f::Ones(); ///< linear RGBA, multiplies the texture; alpha < 0.5 is a hole
    TextureId base_color_texture = TextureId::none;
    TextureId normal_texture = TextureId::none;
    float normal_scale = 1.0f;
    float roughness = 0.8f;
    Vec3f sheen_color = Vec3f::Zero(); ///< linear; light scattered by the fibres at grazing angles
    float sheen_roughness = 0.5f;
    bool double_sided = false;
};

/// Static part of a mesh. A vertex of the surface may be cut into several drawn ones along texture
/// seams: `source` names the surface vertex of each drawn vertex; empty: they are the same (nv =
/// ns).
struct MeshDescription {
    std::span<const Triangle> triangles;   ///< (nt) into the drawn vertices
    std::span<const std::uint32_t> source; ///< (nv) into the surface vertices, or empty
    std::span<const Vec2f> texcoords;      ///< (nv) origin at the top left, or empty
    std::span<const Vec3f> colors;         ///< (nv) linear, multiply the material's; or empty
    std::span<const Vec3f> positions;      ///< (ns) first positions, metres
    std::span<const Vec3f> normals;        ///< (ns) unit, or empty: computed from the triangles
};

/// Looks along its -Z, +Y up. The picture's borders are tangents at depth 1, so that a lens shift
/// or a sensor's principal point need no special case.
struct Camera {
    RigidTransform world_from_camera;
    float left = -0.5f;
    float right = 0.5f;
    float bottom = -0.5f;
    float top = 0.5f;
};

/// A camera with the intrinsics of a sensor (pixels; pixel (0,0) has its centre at (0,0)).
[[nodiscard]] Camera camera_from_intrinsics(const RigidTransform& world_from_camera, double fx,
                                            double fy, double cx, double cy, int width, int height);

/// Directions point towards the light, world; colours are linear irradiance over pi.
struct Lighting {
    Vec3f key_direction = Vec3f(-0.50f, 1.05f, 0.62f);
    Vec3f key_color = Vec3f(0.93f, 0.90f, 0.86f);
    float key_size = 0.22f; ///< tangent of the angle that the soft box is wide; 0: hard shadows
    Vec3f fill_direction = Vec3f(0.8f, 0.25f, 0.6f);
    Vec3f fill_color = Vec3f(0.12f, 0.125f, 0.135f);
    Vec3f rim_direction = Vec3f(0.55f, 0.45f, -0.8f);
    Vec3f rim_color = Vec3f(0.32f, 0.33f, 0.36f);
    Vec3f sky = Vec3f(0.40f, 0.41f, 0.43f);     ///< ambient from above
    Vec3f ground = Vec3f(0.22f, 0.215f, 0.21f); ///< ambient from below
};

/// What stands behind the meshes.
struct Background {
    enum class Kind { invalid, studio, color, camera };
    Kind kind = Kind::studio;
    Vec3f color = Vec3f(0.66f, 0.655f, 0.645f); ///< linear; studio: of the backdrop
    TextureId picture = TextureId::none;        ///< camera: stretched over the whole picture
    TextureId depth = TextureId::none;          ///< camera: metres along its axis, or none
    float depth_tolerance = 0.06f; ///< a real surface hides what lies this much behind it, metres
    bool soft_edges = true;        ///< false: the nearest depth pixel alone decides
    float noise = 0.0f; ///< camera: grain on what is drawn, standard deviation of sRGB values
    std::uint32_t noise_seed = 0; ///< another one each frame
};

/// One mesh in the scene.
struct Instance {
    enum class Draw { invalid, visible, occluder, hidden, receiver };
    MeshId mesh = MeshId::none;
    MaterialId material = MaterialId::none;
    /// occluder: hides what is behind it, is not seen itself. receiver: as an occluder, but the
    /// camera's picture on it takes the shadows of what casts some; its material is its own.
    Draw draw = Draw::visible;
    bool casts_shadow = true;
    RigidTransform world_from_mesh;
};

struct Scene {
    Camera camera;
    Lighting lighting;
    Background background;
    bool floor = true; ///< a floor at y = 0 takes shadows (studio only)
    std::vector<Instance> instances;
};

} // namespace toile::render
