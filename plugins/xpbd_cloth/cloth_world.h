// One person's cloth: the body, the garments on it, and the step that moves them.
#pragma once

#include "cloth/cloth_contacts.h"
#include "cloth/garment_roster.h"
#include "cloth/step.h"
#include "xpbd_cloth/garment_cloth.h"

#include <memory>
#include <optional>

namespace toile::xpbd_cloth {

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
    /// Gives every garment its rows; those that had some keep what they hold.
    void arrange();
    /// \return seconds from the last refresh of the contacts to the end of the step
    float simulate(double dt_s, std::uint32_t substeps) noexcept;
    [[nodiscard]] std::uint32_t substeps_of(double dt_s) const noexcept;

    Settings settings_;
    std::optional<MovingBody> rest_body_; ///< stays as it was given
    std::optional<MovingBody> body_;
    cloth::GarmentRoster<GarmentCloth> garments_;
    std::vector<Vec4> x_, q_, v_; ///< rows of all garments
    cloth::ClothContacts cloth_contacts_;
    std::uint32_t frame_ = 1; ///< steps since the last reset
};

} // namespace toile::xpbd_cloth
