// One person: a body, its garments, and the plugins that move them frame by frame.
#pragma once

#include "garment/layering.h"
#include "host/registry.h"
#include "pipeline/posed_body.h"
#include "pipeline/stage_clock.h"
#include "pipeline/worn_garment.h"

#include <deque>
#include <memory>
#include <vector>

namespace toile::pipeline {

struct DressingOptions {
    toile_limits limits{};
    double longest_step_s = 0.045; ///< longer frame intervals are divided
    std::uint32_t most_steps = 16; ///< of one frame; a longer interval is shortened
    double start_motion_s = 1.0;   ///< from the rest pose into the first frame's
    double start_settle_s = 0.5;   ///< there, before the first frame counts
};

/// As many garments as are worn together.
inline constexpr std::size_t kMostGarments = 4;

/// Not movable. Built on a worker; `start` and `step` belong to the frame thread.
class DressedPerson {
  public:
    /// Finds the default plugins, binds every garment and fills the cloth world. `garments` go from
    /// the innermost to the outermost; what others hide of one is not drawn.
    /// \throw Error naming the plugin or garment that does not work, or when there are more than
    /// `kMostGarments`
    DressedPerson(host::Registry& registry, host::Services& services,
                  std::shared_ptr<const BoundaryBody> body,
                  std::vector<std::shared_ptr<const BoundaryGarment>> garments,
                  const DressingOptions& options, host::Job& job);
    ~DressedPerson();
    DressedPerson(const DressedPerson&) = delete;
    DressedPerson& operator=(const DressedPerson&) = delete;

    /// Moves from the rest pose into the first frame and lets the cloth come to hang.
    void start(const BodyFrame& first, StageClock& clock) noexcept;

    /// Moves on to the next frame, `dt_s` after the last one. Allocates nothing. [frame]
    void step(const BodyFrame& frame, double dt_s, StageClock& clock) noexcept;

    [[nodiscard]] const BoundaryBody& body() const noexcept { return *body_; }
    [[nodiscard]] const PosedBody& posed() const noexcept { return *after_; }
    [[nodiscard]] const std::deque<WornGarment>& garments() const noexcept { return garments_; }
    /// Plugins that were switched off so far, one line each; empty when all work.
    [[nodiscard]] std::vector<std::string> faults();

  private:
    void make_cloth_world(host::Registry& registry, host::Services& services, host::Job& job);
    void advance(const JointArray& joints, double dt_s, StageClock& clock) noexcept;
    void step_cloth(double dt_s) noexcept;
    void order_layers();
    void hide_covered();
    void show() noexcept;

    std::shared_ptr<const BoundaryBody> body_;
    DressingOptions options_;
    BodySkinner skinner_;
    std::unique_ptr<PosedBody> before_;
    std::unique_ptr<PosedBody> after_;
    std::deque<WornGarment> garments_;
    std::unique_ptr<host::Instance> cloth_;
    const toile_cloth* cloth_table_ = nullptr;
    std::vector<toile_garment_target> targets_;
    std::vector<toile_garment_state> states_;
    std::unique_ptr<FrameGuard> cloth_guard_;
    /// An outer garment over an inner one; indices into garments_.
    struct Overlap {
        std::size_t inner;
        std::size_t outer;
        garment::LayerOffset offset;
    };
    std::vector<Overlap> overlaps_;
    bool reset_ = true;
};

} // namespace toile::pipeline
