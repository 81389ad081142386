// What the shaders know about the whole picture; block Frame of shaders/common.glsl.
#pragma once

#include "core/types.h"
#include "render/scene.h"

#include <cstddef>

namespace toile::render {

struct FrameUniforms {
    Mat4f clip_from_world;
    Mat4f world_from_camera;
    Mat4f light_from_world;
    Vec4f borders;
    Vec4f range;
    Vec4f target_size;
    Vec4f visibility_size;
    Vec4f shadow;
    Vec4f key_direction;
    Vec4f key_color;
    Vec4f fill_direction;
    Vec4f fill_color;
    Vec4f rim_direction;
    Vec4f rim_color;
    Vec4f sky;
    Vec4f ground;
    Vec4f backdrop;
    Vec4f subject;
    Vec4f contact;
    Vec4f occlusion;
    Vec4f meshes;
    Vec4f flags;
};
// No holes before the last member (behind it alignment may pad).
static_assert(offsetof(FrameUniforms, flags) == (3 * 16 + 18 * 4) * sizeof(float));

/// World-aligned bounds; empty when low > high.
struct Box {
    Vec3f low = Vec3f::Constant(1e30f);
    Vec3f high = Vec3f::Constant(-1e30f);

    [[nodiscard]] bool empty() const { return low.x() > high.x(); }
    void add(const Vec3f& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    [[nodiscard]] Vec3f corner(int i) const {
        return {(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                (i & 4) != 0 ? high.z() : low.z()};
    }
};

/// Camera. `visible` bounds everything drawn.
void set_camera(FrameUniforms& frame, const Camera& camera, const Box& visible);
void set_lighting(FrameUniforms& frame, const Lighting& lighting);
/// Which pixels of the target (its size must be set) `visible` can touch.
void set_touched(FrameUniforms& frame, const Box& visible);
/// Fits the shadow map of `side` texels round what casts shadows.
void fit_shadow_map(FrameUniforms& frame, const Vec3f& key_direction, const Box& casters, int side);

} // namespace toile::render
