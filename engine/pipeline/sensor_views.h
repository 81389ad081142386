// A sensor's streams and frames as body sources want them.
#pragma once

#include "abi/frame.h"
#include "pipeline/sensor_source.h"

namespace toile::pipeline {

[[nodiscard]] toile_stream stream_view(const SensorStream& stream, std::uint32_t number);
/// Borrows the pictures.
[[nodiscard]] toile_frame frame_view(const SensorFrame& frame, std::uint32_t number) noexcept;

} // namespace toile::pipeline
