#include "render/frame_uniforms.h"

#include <algorithm>
#include <cmath>

namespace toile::render {
namespace {

Vec4f with(const Vec3f& v, float w = 0.0f) {
    return {v.x(), v.y(), v.z(), w};
}

Mat4f matrix(const RigidTransform& t) {
    Mat4f m = Mat4f::Identity();
    m.topLeftCorner<3, 3>() = t.rotation.toRotationMatrix();
    m.topRightCorner<3, 1>() = t.translation;
    return m;
}

// OpenGL's perspective projection of a camera whose picture borders are tangents.
Mat4f projection(const Camera& c, float near_plane, float far_plane) {
    Mat4f m = Mat4f::Zero();
    m(0, 0) = 2.0f / (c.right - c.left);
    m(0, 2) = (c.right + c.left) / (c.right - c.left);
    m(1, 1) = 2.0f / (c.top - c.bottom);
    m(1, 2) = (c.top + c.bottom) / (c.top - c.bottom);
    m(2, 2) = -(far_plane + near_plane) / (far_plane - near_plane);
    m(2, 3) = -2.0f * far_plane * near_plane / (far_plane - near_plane);
    m(3, 2) = -1.0f;
    return m;
}

} // namespace

void set_camera(FrameUniforms& frame, const Camera& camera, const Box& visible) {
    const RigidTransform camera_from_world = camera.world_from_camera.inverse();
    float nearest = 0.5f;
    float farthest = 5.0f;
    Vec3f centre = Vec3f(0.0f, 0.9f, 0.0f);
    float radius = 1.0f;
    if (!visible.empty()) {
        nearest = 1e30f;
        farthest = 0.0f;
        for (int i = 0; i < 8; ++i) {
            const float depth = -(camera_from_world * visible.corner(i)).z();
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
        centre = 0.5f * (visible.low + visible.high);
        radius = std::max(0.5f * (visible.high - visible.low).norm(), 0.05f);
    }
    // Steps of a quarter metre: depths do not swim with the subject's motion.
    nearest = std::max(0.05f, std::floor(4.0f * (nearest - 0.25f)) / 4.0f);
    farthest = std::max(nearest + 1.0f, std::ceil(4.0f * (farthest + 1.5f)) / 4.0f);
    frame.clip_from_world = projection(camera, nearest, farthest) * matrix(camera_from_world);
    frame.world_from_camera = matrix(camera.world_from_camera);
    frame.borders = {camera.left, camera.right, camera.bottom, camera.top};
    frame.range = {nearest, farthest, 1.0f / (farthest - nearest), frame.range.w()};
    frame.subject = with(centre, radius);
}

void set_touched(FrameUniforms& frame, const Box& visible) {
    const Vec4f whole(0.0f, 0.0f, frame.target_size.x(), frame.target_size.y());
    frame.meshes = Vec4f::Zero();
    if (visible.empty()) return;
    Vec2f low = Vec2f::Constant(1e30f);
    Vec2f high = Vec2f::Constant(-1e30f);
    for (int i = 0; i < 8; ++i) {
        const Vec4f clip = frame.clip_from_world * with(visible.corner(i), 1.0f);
        if (clip.w() < frame.range.x()) { // behind the near plane: no bound
            frame.meshes = whole;
            return;
        }
        const Vec2f pixel = (clip.head<2>() / clip.w() * 0.5f + Vec2f::Constant(0.5f))
                                .cwiseProduct(frame.target_size.head<2>());
        low = low.cwiseMin(pixel);
        high = high.cwiseMax(pixel);
    }
    frame.meshes = {std::floor(low.x()) - 2.0f, std::floor(low.y()) - 2.0f,
                    std::ceil(high.x()) + 2.0f, std::ceil(high.y()) + 2.0f};
}

void set_lighting(FrameUniforms& frame, const Lighting& lighting) {
    frame.key_direction = with(lighting.key_direction.normalized(), lighting.key_size);
    frame.key_color = with(lighting.key_color);
    frame.fill_direction = with(lighting.fill_direction.normalized());
    frame.fill_color = with(lighting.fill_color);
    frame.rim_direction = with(lighting.rim_direction.normalized());
    frame.rim_color = with(lighting.rim_color);
    frame.sky = with(lighting.sky);
    frame.ground = with(lighting.ground);
}

void fit_shadow_map(FrameUniforms& frame, const Vec3f& key_direction, const Box& casters,
                    int side) {
    const Vec3f away = -key_direction.normalized();
    const Vec3f helper = std::abs(away.y()) < 0.95f ? Vec3f::UnitY() : Vec3f::UnitX();
    const Vec3f across = helper.cross(away).normalized();
    Mat3f R;
    R.row(0) = across;
    R.row(1) = across.cross(away); // up, as the light sees it
    R.row(2) = away;

    Vec3f low = Vec3f::Constant(1e30f);
    Vec3f high = Vec3f::Constant(-1e30f);
    for (int i = 0; i < 8 && !casters.empty(); ++i) {
        const Vec3f p = R * casters.corner(i);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    if (casters.empty()) {
        low = Vec3f::Constant(-0.5f);
        high = Vec3f::Constant(0.5f);
    }
    // Steps of 10 cm, so that shadows do not shimmer while the subject moves.
    constexpr float kStep = 0.1f;
    for (int i = 0; i < 3; ++i) {
        low[i] = kStep * (std::floor(low[i] / kStep) - 1.0f);
        high[i] = kStep * (std::ceil(high[i] / kStep) + 1.0f);
    }
    const Vec3f size = high - low;
    frame.light_from_world = Mat4f::Identity();
    frame.light_from_world.topLeftCorner<3, 3>() = R;
    frame.light_from_world.topRightCorner<3, 1>() = -low;
    frame.shadow = {1.0f / size.x(), 1.0f / size.y(), size.z(),
                    std::max(size.x(), size.y()) / static_cast<float>(side)};
}

} // namespace toile::render
