// What the operator's page tells of the room: floor, camera, light.
#pragma once

#include "apps/kiosk/config.h"
#include "imaging/camera.h"
#include "imaging/image.h"

#include <Eigen/Geometry>
#include <optional>

namespace toile::apps::kiosk {

/// Where a camera stands that does not know it: on the Y axis, looking along -Z.
[[nodiscard]] Eigen::Isometry3d camera_place(const CameraSettings& settings);

/// Height and tilt from the floor in a depth picture; nothing when no floor is in view. The lens
/// must not be rolled or tilted by more than 60 degrees.
[[nodiscard]] std::optional<CameraSettings> find_camera(const imaging::DepthImage& depth,
                                                        const imaging::Intrinsics& camera);

enum class LightVerdict { invalid, good, dark, bright };
/// Of a picture's tone: level as in PictureLight, share of white pixels.
[[nodiscard]] LightVerdict judge_light(float level, float clipped);

} // namespace toile::apps::kiosk
