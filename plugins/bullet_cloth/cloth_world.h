// One person's cloth: the body, the garments on it, and the step that moves them.
#pragma once

#include "bullet_cloth/garment_cloth.h"

#include <memory>
#include <optional>

namespace toile::bullet_cloth {

/// One garment in and out of a step; (nv) each.
struct GarmentFrame {
    std::uint32_t garment = 0; ///< handle
    std::span<const Vec3f> targets;
    std::span<Vec3f> positions, normals;
};

struct StepInput {
    std::span<const Vec3f> body_before, body_after; ///< (body nv) metres
    double dt_s = 0.0;
    bool reset = false;
    std::span<const GarmentFrame> garments; ///< every garment of the world, in any order
};

enum class StepResult {
    ok,
    recovered, ///< a garment had become non-finite and was started anew from its targets
    no_body,
    body_count,    ///< body_before or body_after has another vertex count than the body
    body_values,   ///< not finite, or further than a kilometre
    time,          ///< dt is not in (0, 1] s; with reset [0, 1] s
    garment_count, ///< not exactly the garments of the world
    unknown_garment,
    target_count,
    target_values, ///< not finite, or further than a kilometre
    output_count
};

/// What to tell a person about a result; lives as long as the program.
[[nodiscard]] const char* step_result_text(StepResult result) noexcept;

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
    [[nodiscard]] const GarmentCloth& garment(std::uint32_t handle) const;
    void set_settings(const Settings& settings) { settings_ = settings; }

  private:
    struct Entry {
        std::uint32_t handle;
        bool fresh = true; ///< begins from its targets at the next step
        GarmentCloth cloth;
    };

    [[nodiscard]] StepResult check(const StepInput& input) const noexcept;
    [[nodiscard]] Entry* find(std::uint32_t handle) noexcept;
    float simulate(double dt_s) noexcept;

    Settings settings_;
    std::optional<MovingBody> rest_body_; ///< stays as it was given
    std::optional<MovingBody> body_;
    std::vector<Entry> garments_;
    std::uint32_t next_handle_ = 1;
};

} // namespace toile::bullet_cloth
