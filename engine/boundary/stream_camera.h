// A sensor's stream as the plugin boundary tells it, as a camera of the engine.
#pragma once

#include "abi/frame.h"
#include "imaging/camera.h"

#include <algorithm>
#include <optional>

namespace toile::boundary {

struct StreamCamera {
    imaging::Intrinsics intrinsics;
    std::optional<Eigen::Isometry3d> world_from_camera; ///< when the sensor knows its place
};

/// Of the depth pictures. \throw Error naming what is wrong with the intrinsics
[[nodiscard]] inline StreamCamera camera_of(const toile_stream& stream) {
    constexpr std::uint32_t kWidest = 1u << 14; // pixels
    StreamCamera out;
    out.intrinsics.width = static_cast<int>(std::min(stream.depth.width, kWidest));
    out.intrinsics.height = static_cast<int>(std::min(stream.depth.height, kWidest));
    out.intrinsics.fx = stream.depth.fx;
    out.intrinsics.fy = stream.depth.fy;
    out.intrinsics.cx = stream.depth.cx;
    out.intrinsics.cy = stream.depth.cy;
    std::copy_n(stream.depth.distortion, 8, out.intrinsics.distortion.begin());
    imaging::check_intrinsics(out.intrinsics);
    if (stream.has_world != 0) {
        out.world_from_camera.emplace(Eigen::Isometry3d::Identity());
        std::copy_n(stream.world_from_camera, 16, out.world_from_camera->matrix().data());
    }
    return out;
}

} // namespace toile::boundary
