// One garment in the cloth world: its particles, springs, contacts, targets.
#pragma once

#include "bullet_cloth/link_solver.h"
#include "bullet_cloth/settings.h"
#include "cloth/garment_input.h"
#include "cloth/skin_cover.h"

namespace toile::bullet_cloth {

using cloth::BodyContacts;
using cloth::MovingBody;

using cloth::GarmentInput;

/// A stretch of one step: substeps [first, last) of `count`, over a body placed at one moment.
struct Interval {
    std::uint32_t first, last, count;
    std::uint32_t index, of; ///< this interval's number, and how many the step has
    float substep;           ///< s
};

class GarmentCloth {
  public:
    /// \throw Error naming what is wrong with the garment
    GarmentCloth(const GarmentInput& input, const MovingBody& rest_body, const Settings& settings);

    /// Another body: finds its place on it again.
    void bind(const MovingBody& rest_body) { contacts_.bind(rest_body, start_); }

    /// Where the targets will be at the end of the step that begins; (nv)
    void begin_step(std::span<const Vec3f> targets, float substep) noexcept;
    /// Starts from the targets, at rest.
    void reset() noexcept;
    /// Simulates an interval; `body` is placed at its middle.
    void advance(const MovingBody& body, const Interval& interval) noexcept;
    /// Last look at the full-resolution body, placed at the end of the step, `since_last` seconds
    /// after the middle of the last interval.
    void clean_up(const MovingBody& body, float since_last) noexcept;
    /// False when something broke; the garment then needs a reset.
    [[nodiscard]] bool finite() const noexcept;

    [[nodiscard]] std::size_t vertex_count() const noexcept { return x_.size(); }
    [[nodiscard]] std::span<const Vec4> positions() const noexcept { return x_; }
    [[nodiscard]] std::span<const Vec4> velocities() const noexcept { return v_; }
    [[nodiscard]] std::span<const Triangle> triangles() const noexcept {
        return contacts_.triangles();
    }
    [[nodiscard]] const ClothModel& model() const noexcept { return model_; }

  private:
    void predict(float fraction, float substep) noexcept;
    void limit_lengths() noexcept;
    void follow_targets(float fraction, float share, float substep) noexcept;
    void update_velocities(float substep, bool damp) noexcept;
    [[nodiscard]] Vec4 target(std::size_t vertex, float fraction) const noexcept {
        return target_before_[vertex] + fraction * (target_after_[vertex] - target_before_[vertex]);
    }

    Settings settings_;
    Fabric fabric_;
    cloth::ContactSettings contact_;
    std::vector<Vec3f> start_;
    ClothModel model_;
    std::vector<float> attachment_;
    std::vector<float> inverse_mass_; ///< (nv) 1/kg, 0: held
    LinkSolver links_;
    BodyContacts contacts_;
    cloth::SkinCover cover_;
    std::vector<Vec4> x_, q_, v_; ///< positions, those at the start of the substep, velocities
    std::vector<Vec4> target_before_, target_after_;
    float leash_ = 0.0f;
    float period_ = 0.0f; ///< s, of the frame at hand
};

} // namespace toile::bullet_cloth
