// One person's cloth: the body, the garments on it, and the step that moves them.
#pragma once

#include "bullet_cloth/garment_cloth.h"
#include "cloth/garment_roster.h"
#include "cloth/step.h"

#include <memory>
#include <optional>

namespace toile::bullet_cloth {

using cloth::BodyRest;
using cloth::GarmentFrame;
using cloth::step_result_text;
using cloth::StepInput;
using cloth::StepResult;

class ClothWorld {
  public:
    explicit ClothWorld(const Settings& settings = {}) : settings_(settings) {}

    /// Garments already here are bound to the new body and begin anew. \throw Error
    void set_body(const BodyRest& rest);
    /// Handle, never 0. \throw Error naming what is wrong with the garment
    std::uint32_t add_garment(const GarmentInput& input);
    /// \throw Error when there is no such garment
    void remove_garment(std::uint32_t garment);

    /// Moves every garment by one frame. Allocates nothing; refuses before it changes anything.
    StepResult step(const StepInput& input) noexcept;

    [[nodiscard]] std::size_t garment_count() const noexcept { return garments_.size(); }
    /// \throw Error when there is no such garment
    [[nodiscard]] const GarmentCloth& garment(std::uint32_t handle) const {
        return garments_.at(handle);
    }
    void set_settings(const Settings& settings) { settings_ = settings; }

  private:
    using Entry = cloth::GarmentRoster<GarmentCloth>::Entry;
    float simulate(double dt_s) noexcept;

    Settings settings_;
    std::optional<MovingBody> rest_body_; ///< stays as it was given
    std::optional<MovingBody> body_;
    cloth::GarmentRoster<GarmentCloth> garments_;
};

} // namespace toile::bullet_cloth
