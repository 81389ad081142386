// What the entries of cloth plugins share: the structs of toile.cloth/1 as a world of cloth takes
// them.
#pragma once

#include "abi/body.h"
#include "cloth/garment_input.h"
#include "cloth/step.h"
#include "sdk/cloth.h"
#include "sdk/host.h"
#include "sdk/views.h"

#include <vector>

namespace toile::boundary {

static_assert(cloth::kBodyJoints == TOILE_JOINT_COUNT);
static_assert(sizeof(Vec3f) == sizeof(sdk::Float3) && alignof(Vec3f) == alignof(sdk::Float3));

inline std::span<const Vec3f> vectors(std::span<const sdk::Float3> rows) noexcept {
    return {reinterpret_cast<const Vec3f*>(rows.data()), rows.size()};
}
inline std::span<Vec3f> vectors(std::span<sdk::Float3> rows) noexcept {
    return {reinterpret_cast<Vec3f*>(rows.data()), rows.size()};
}

inline cloth::Fabric fabric_from(const toile_fabric& in) {
    return {.density = in.density_kg_m2,
            .thickness = in.thickness_m,
            .stretch_warp = in.stretch_warp_n_m,
            .stretch_weft = in.stretch_weft_n_m,
            .shear = in.shear_n_m,
            .bend_warp = in.bend_warp_nm,
            .bend_weft = in.bend_weft_nm,
            .friction = in.friction,
            .damping = in.damping};
}

inline toile_status status_of(cloth::StepResult result) noexcept {
    switch (result) {
    case cloth::StepResult::ok:
    case cloth::StepResult::recovered:
        return TOILE_OK;
    case cloth::StepResult::body_values:
    case cloth::StepResult::target_values:
        return TOILE_E_NUMERIC;
    default:
        return TOILE_E_ARGUMENT;
    }
}

/// Base of a cloth plugin's class. `World` has set_body, add_garment, remove_garment,
/// garment_count and step, as both stock solvers do.
template <class World>
class ClothEntry {
  public:
    void reset() { begin_anew_ = true; }

    void set_body(const toile_body& body, sdk::Job job) {
        world_.set_body({vectors(sdk::span_of<sdk::Float3>(body.rest.positions, "rest.positions")),
                         sdk::span_of<sdk::Triangle>(body.rest.triangles, "rest.triangles"),
                         sdk::span_of<sdk::Index4>(body.joint_indices, "joint_indices"),
                         sdk::span_of<sdk::Float4>(body.joint_weights, "joint_weights")});
        job.progress(1.0);
    }

    std::uint32_t add_garment(const toile_cloth_garment& garment, sdk::Job job) {
        job.progress(0.0);
        const auto coords =
            sdk::span_of<sdk::Float2>(garment.rest.corner_coords, "rest.corner_coords");
        const auto seams = sdk::span_of<toile_seam>(garment.seams, "seams");
        seams_.clear();
        for (const toile_seam& seam : seams)
            seams_.push_back({seam.a, seam.b});
        material_.resize(coords.size());
        for (std::size_t i = 0; i < coords.size(); ++i)
            material_[i] = Vec2f(coords[i][0], coords[i][1]);
        cloth::GarmentInput input;
        input.mesh.positions =
            vectors(sdk::span_of<sdk::Float3>(garment.rest.positions, "rest.positions"));
        input.mesh.triangles =
            sdk::span_of<sdk::Triangle>(garment.rest.triangles, "rest.triangles");
        input.mesh.corner_coords = material_;
        input.mesh.seams = seams_;
        input.fabric = fabric_from(garment.fabric);
        input.joints = sdk::span_of<sdk::Index4>(garment.joint_indices, "joint_indices");
        input.weights = sdk::span_of<sdk::Float4>(garment.joint_weights, "joint_weights");
        input.attachment = sdk::span_of<float>(garment.attachment, "attachment");
        input.layer = garment.layer;
        const std::uint32_t handle = world_.add_garment(input);
        frames_.resize(world_.garment_count());
        job.progress(1.0);
        return handle;
    }

    void remove_garment(std::uint32_t garment) {
        world_.remove_garment(garment);
        frames_.resize(world_.garment_count());
    }

    void step(const toile_cloth_step& step) {
        const auto targets = sdk::targets_of(step);
        const auto states = sdk::states_of(step);
        if (targets.size() != frames_.size())
            throw sdk::bad_argument(cloth::step_result_text(cloth::StepResult::garment_count));
        for (std::uint32_t i = 0; i < frames_.size(); ++i) {
            if (states[i].garment != targets[i].garment)
                throw sdk::bad_argument("step: states and targets name different garments");
            frames_[i] = {
                targets[i].garment,
                vectors(sdk::span_of<sdk::Float3>(targets[i].positions, "targets.positions")),
                vectors(sdk::span_of<sdk::Float3>(states[i].positions, "states.positions")),
                vectors(sdk::span_of<sdk::Float3>(states[i].normals, "states.normals"))};
        }
        const toile_body_state before = sdk::read_struct(step.body_before, "body_before");
        const toile_body_state after = sdk::read_struct(step.body_after, "body_after");
        cloth::StepInput input;
        input.body_before =
            vectors(sdk::span_of<sdk::Float3>(before.positions, "body_before.positions"));
        input.body_after =
            vectors(sdk::span_of<sdk::Float3>(after.positions, "body_after.positions"));
        input.dt_s = step.dt_s;
        input.reset = begin_anew_ || (step.flags & TOILE_STEP_RESET) != 0;
        input.garments = frames_;
        const cloth::StepResult result = world_.step(input);
        if (result == cloth::StepResult::recovered) {
            host_.warning(cloth::step_result_text(result));
        } else if (result != cloth::StepResult::ok) {
            throw sdk::Failure(status_of(result), cloth::step_result_text(result));
        }
        begin_anew_ = false;
    }

  protected:
    explicit ClothEntry(sdk::Host host) : host_(host) {}
    World world_;

  private:
    sdk::Host host_;
    std::vector<cloth::GarmentFrame> frames_; ///< (garments) of the step at hand
    std::vector<Vec2f> material_;
    std::vector<std::array<std::uint32_t, 2>> seams_;
    bool begin_anew_ = false;
};

} // namespace toile::boundary
