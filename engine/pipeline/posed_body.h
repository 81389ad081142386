// A body posed by the skinning plugin: buffers, and the state that garments and cloth read.
#pragma once

#include "body/skinning.h"
#include "host/instance.h"
#include "pipeline/body_frame.h"
#include "pipeline/boundary_views.h"
#include "pipeline/frame_guard.h"

#include <memory>
#include <string>

namespace toile::pipeline {

/// One posed surface; not movable, `state` points into it.
class PosedBody {
  public:
    explicit PosedBody(const BoundaryBody& body);
    PosedBody(const PosedBody&) = delete;
    PosedBody& operator=(const PosedBody&) = delete;

    JointArray joints;
    std::vector<Vec3f> positions; ///< (nv)
    std::vector<Vec3f> normals;   ///< (nv)

    /// Header fields of the frame it shows; joints are copied.
    void set_frame(const BodyFrame& frame) noexcept;
    [[nodiscard]] const toile_body_state& state() const noexcept { return state_; }

  private:
    toile_body_state state_{};
};

/// The skinning plugin bound to one body. Where it fails, the engine's own linear blend skinning
/// steps in.
class BodySkinner {
  public:
    /// \throw Error when the plugin cannot bind the body [worker]
    BodySkinner(std::shared_ptr<const host::Plugin> plugin, host::Services& services,
                const BoundaryBody& body, const toile_limits& limits, host::Job& job);

    /// Fills positions and normals from the joints. [frame]
    void pose(PosedBody& body) noexcept;

    /// Empty, or why the plugin was switched off.
    [[nodiscard]] std::string fault() { return guard_.fault(); }

  private:
    const BoundaryBody& body_;
    host::Instance instance_;
    const toile_skinning& table_;
    FrameGuard guard_;
    body::SkinnedSurface fallback_;
};

} // namespace toile::pipeline
