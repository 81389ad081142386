// Where a run's body frames come from: a body source plugin, or a motion being played.
#pragma once

#include "host/job.h"
#include "host/registry.h"
#include "pipeline/body_frame.h"
#include "pipeline/boundary_views.h"

#include <memory>
#include <string>

namespace toile::pipeline {

class FrameSource {
  public:
    FrameSource() = default;
    virtual ~FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;

    /// TOILE_OK with the next frame, TOILE_NO_NEW_DATA, TOILE_END_OF_STREAM, or an error. Never
    /// blocks. [frame]
    virtual toile_status next(BodyFrame& out) noexcept = 0;
    /// What the last error was about; empty when there was none. [main]
    [[nodiscard]] virtual std::string error() = 0;
};

/// Opens a source URI ("kinect-log:FILE") by the plugin whose scheme it is; people are given the
/// bones of `body`, which must outlive the source.
/// \throw UsageError for a URI without a scheme, Error when it cannot be opened [worker]
[[nodiscard]] std::unique_ptr<FrameSource>
open_source(const std::string& uri, host::Registry& registry, host::Services& services,
            const BoundaryBody& body, const toile_limits& limits, host::Job& job);

} // namespace toile::pipeline
