#include "pipeline/sensor_views.h"

#include "host/views.h"

#include <algorithm>

namespace toile::pipeline {

toile_stream stream_view(const SensorStream& stream, std::uint32_t number) {
    auto out = host::sized<toile_stream>();
    out.camera = number;
    const imaging::Intrinsics& in = stream.depth;
    out.depth.width = static_cast<std::uint32_t>(in.width);
    out.depth.height = static_cast<std::uint32_t>(in.height);
    out.depth.fx = in.fx;
    out.depth.fy = in.fy;
    out.depth.cx = in.cx;
    out.depth.cy = in.cy;
    std::copy(in.distortion.begin(), in.distortion.end(), out.depth.distortion);
    out.has_world = stream.world_from_camera ? 1 : 0;
    const Eigen::Matrix4d place =
        stream.world_from_camera.value_or(Eigen::Isometry3d::Identity()).matrix();
    std::copy_n(place.data(), 16, out.world_from_camera);
    out.frame_period_s = stream.frame_period_s;
    return out;
}

toile_frame frame_view(const SensorFrame& frame, std::uint32_t number) noexcept {
    auto out = host::sized<toile_frame>();
    out.camera = number;
    out.sequence = frame.sequence;
    out.timestamp_ns = frame.timestamp_ns;
    out.depth_m = host::view_of(frame.depth.metres);
    const std::size_t pixels = frame.color.pixels.size() / 4;
    out.color = {frame.color.pixels.data(), static_cast<std::uint32_t>(pixels), 4, TOILE_U8X4, 0};
    return out;
}

} // namespace toile::pipeline
