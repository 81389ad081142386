#include "render/scene.h"

namespace toile::render {

const char* text(Status status) noexcept {
    switch (status) {
    case Status::ok:
        return "ok";
    case Status::unknown:
        return "the renderer has no such mesh or texture";
    case Status::wrong_count:
        return "the count differs from when it was added";
    case Status::not_finite:
        return "a value is not finite";
    case Status::invalid:
        break;
    }
    return "invalid";
}

Camera camera_from_intrinsics(const RigidTransform& world_from_camera, double fx, double fy,
                              double cx, double cy, int width, int height) {
    Camera c;
    c.world_from_camera = world_from_camera;
    c.left = static_cast<float>((-0.5 - cx) / fx);
    c.right = static_cast<float>((width - 0.5 - cx) / fx);
    c.top = static_cast<float>((cy + 0.5) / fy);
    c.bottom = static_cast<float>((cy + 0.5 - height) / fy);
    return c;
}

} // namespace toile::render
