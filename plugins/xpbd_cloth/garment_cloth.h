// One garment in the cloth world: its constraints, contacts and targets.
#pragma once

#include "cloth/garment_input.h"
#include "cloth/skin_cover.h"
#include "xpbd_cloth/links.h"
#include "xpbd_cloth/row_order.h"
#include "xpbd_cloth/settings.h"

namespace toile::xpbd_cloth {

using cloth::GarmentInput;
using cloth::MovingBody;
using cloth::Vec4;

/// A garment's rows among those of the world; (nv + 1), the last one stays at zero.
struct Rows {
    std::span<Vec4> x, q, v; ///< positions, those at the start of the substep, velocities
};

/// A stretch of one step over a body placed at one moment, its middle.
struct Interval {
    std::uint32_t index, of; ///< its number, and how many the step has
    std::uint32_t substeps;  ///< in it
    float substep;           ///< s
    std::uint32_t frame;     ///< steps since the reset, from 1
    [[nodiscard]] float length() const { return static_cast<float>(substeps) * substep; }
};

/// One substep of a step.
struct Substep {
    std::uint32_t index; ///< in the step
    bool last;           ///< of the step
    bool last_of_interval;
    bool settles;   ///< the step begins anew: cloth finds its shape, but gathers no speed
    float length;   ///< s
    float fraction; ///< of the step that is over at its end
    float share;    ///< of the step that it is
    float since;    ///< s, from the body of the contacts to its end
};

class GarmentCloth {
  public:
    /// \throw Error naming what is wrong with the garment
    GarmentCloth(const GarmentInput& input, const MovingBody& rest_body, const Settings& settings)
        : GarmentCloth(OrderedGarment(input), rest_body, settings) {}

    /// Another body: finds its place on it again.
    void bind(const MovingBody& rest_body) { contacts_.bind(rest_body, start_); }
    /// Where its rows are from now on; they hold its state already, or need a reset.
    void use(const Rows& rows) noexcept { rows_ = rows; }

    /// Substeps a second that hold the strain on this mesh.
    [[nodiscard]] double substep_rate() const noexcept;
    /// Where the targets will be at the end of the step that begins; (nv)
    void begin_step(std::span<const Vec3f> targets, float substep) noexcept;
    /// Starts from the targets, at rest.
    void reset() noexcept;

    /// Finds the contacts of an interval; `body` is placed at its middle.
    void find_contacts(const MovingBody& body, const Interval& interval) noexcept;
    /// A substep in three parts; cloth meets cloth after the first.
    void move(const Substep& now) noexcept;
    void meet_body(const Substep& now) noexcept;
    void update_velocities(const Substep& now) noexcept;

    /// Last look at the full-resolution body, placed at the end of the step, `since_last` seconds
    /// after the middle of the last interval.
    void clean_up(const MovingBody& body, float since_last) noexcept;
    /// False when something broke; the garment then needs a reset.
    [[nodiscard]] bool finite() const noexcept;

    [[nodiscard]] std::size_t vertex_count() const noexcept { return start_.size(); }
    [[nodiscard]] std::span<const Vec4> positions() const noexcept {
        return rows_.x.first(start_.size());
    }
    [[nodiscard]] std::span<const Vec4> velocities() const noexcept {
        return rows_.v.first(start_.size());
    }
    /// (nv) of the garment as given, for each row
    [[nodiscard]] std::span<const std::uint32_t> vertices() const noexcept { return vertex_; }
    [[nodiscard]] std::span<const Triangle> triangles() const noexcept {
        return contacts_.triangles();
    }
    [[nodiscard]] std::span<const Vec3f> start() const noexcept { return start_; }
    [[nodiscard]] std::span<const float> mass() const noexcept { return mass_; }
    [[nodiscard]] std::span<const float> inverse_mass() const noexcept { return inverse_mass_; }
    [[nodiscard]] float mean_edge() const noexcept { return mean_edge_; }
    [[nodiscard]] float thickness() const noexcept { return fabric_.thickness; }
    [[nodiscard]] float friction() const noexcept { return contact_.friction; }
    [[nodiscard]] unsigned layer() const noexcept { return layer_; }

  private:
    GarmentCloth(const OrderedGarment& ordered, const MovingBody& rest_body,
                 const Settings& settings);
    void note_motion(float until_next) noexcept;
    void predict(const Substep& now) noexcept;
    /// The constraints find each row's inverse mass in its w; everything else wants 0 there.
    void weigh() noexcept;
    void unweigh() noexcept;
    void follow_targets(const Substep& now) noexcept;
    void hold_on_leash(std::span<const std::uint32_t> vertices, float fraction) noexcept;
    void find_stretched_leashes() noexcept;
    [[nodiscard]] Vec4 target(std::size_t vertex, float fraction) const noexcept {
        return target_before_[vertex] + fraction * (target_after_[vertex] - target_before_[vertex]);
    }

    Settings settings_;
    Fabric fabric_;
    unsigned layer_;
    cloth::ContactSettings contact_;
    std::vector<std::uint32_t> vertex_;
    std::vector<Vec3f> start_;
    std::vector<float> attachment_;
    std::vector<float> mass_, inverse_mass_; ///< (nv) kg, 1/kg; 0: held
    std::vector<std::uint32_t> held_;        ///< vertices of attachment 1
    std::vector<std::uint32_t> pulled_;      ///< and of less that is not 0
    std::vector<std::uint32_t> free_;        ///< all but the held ones
    std::vector<std::uint32_t> leashed_;     ///< those whose leash this step may stretch
    float mean_edge_ = 0.0f;                 ///< m
    Membrane membrane_;
    Bending bending_;
    Links seams_, limits_, borders_, last_limits_;
    VelocityDamping damping_;
    cloth::BodyContacts contacts_;
    cloth::SkinCover cover_;
    Rows rows_;
    std::vector<Vec4> target_before_, target_after_;
    std::vector<Vec4> noted_, mean_velocity_; ///< (nv) at the last look at the body, and since then
    float since_noted_ = 0.0f;                ///< s; 0: not yet
    float period_ = 0.0f;                     ///< s, of the frame at hand
    float since_damped_ = 0.0f;               ///< s
    bool velocities_known_ = true;            ///< are those of the rows' last substep
    std::uint32_t bend_every_ = 2;            ///< substeps
};

} // namespace toile::xpbd_cloth
