// Kind toile.cloth/1 for a class P with
//     void set_body(const toile_body& body, Job job);                                  // [worker]
//     std::uint32_t add_garment(const toile_cloth_garment& garment, Job job); // handle  [worker]
//     void remove_garment(std::uint32_t garment);                                      // [worker]
//     void step(const toile_cloth_step& step);  // see targets_of, states_of              [frame]
#pragma once

#include "abi/cloth.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

#include <span>

namespace toile::sdk {

/// (garment_count) \throw Failure TOILE_E_ARGUMENT when null
[[nodiscard]] inline std::span<const toile_garment_target>
targets_of(const toile_cloth_step& step) {
    if (step.targets == nullptr && step.garment_count > 0) throw bad_argument("targets: null");
    return {step.targets, step.garment_count};
}

/// (garment_count), in the order of the targets. \throw Failure TOILE_E_ARGUMENT
[[nodiscard]] inline SizedArray<toile_garment_state> states_of(const toile_cloth_step& step) {
    return {step.states, step.garment_count, "states"};
}

struct Cloth {
    static constexpr const char* id = TOILE_CLOTH;

    template <class P>
    static toile_status set_body(toile_instance* instance, const toile_body* body,
                                 toile_job* job) noexcept {
        return guarded<P>(instance,
                          [&](P& p) { return p.set_body(read_struct(body, "body"), Job(job)); });
    }
    template <class P>
    static toile_status add_garment(toile_instance* instance, const toile_cloth_garment* garment,
                                    toile_job* job, std::uint32_t* handle) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (handle == nullptr) throw bad_argument("garment: null handle");
            *handle = p.add_garment(read_struct(garment, "garment"), Job(job));
        });
    }
    template <class P>
    static toile_status remove_garment(toile_instance* instance, std::uint32_t garment) noexcept {
        return guarded<P>(instance, [&](P& p) { return p.remove_garment(garment); });
    }
    template <class P>
    static toile_status step(toile_instance* instance, const toile_cloth_step* step) noexcept {
        return guarded<P>(instance, [&](P& p) { return p.step(read_struct(step, "step")); });
    }
    template <class P>
    static constexpr toile_cloth table{sizeof(toile_cloth), 0,       &set_body<P>, &add_garment<P>,
                                       &remove_garment<P>,  &step<P>};
};

} // namespace toile::sdk
