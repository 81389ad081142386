// Kind toile.garment/1 for a class P with
//     void bind(const toile_body& body, const toile_garment_package& package, Job job,
//               const toile_garment_binding& out);       // fill the views of out     [worker]
//     void targets(const toile_body_state& state, toile_view_mut positions);          // [frame]
#pragma once

#include "abi/garment.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Garment {
    static constexpr const char* id = TOILE_GARMENT;

    template <class P>
    static toile_status bind(toile_instance* instance, const toile_body* body,
                             const toile_garment_package* package, toile_job* job,
                             toile_garment_binding* out) noexcept {
        return guarded<P>(instance, [&](P& p) {
            return p.bind(read_struct(body, "body"), read_struct(package, "package"), Job(job),
                          read_struct(out, "out"));
        });
    }
    template <class P>
    static toile_status targets(toile_instance* instance, const toile_body_state* state,
                                toile_view_mut positions) noexcept {
        return guarded<P>(instance,
                          [&](P& p) { return p.targets(read_struct(state, "state"), positions); });
    }
    template <class P>
    static constexpr toile_garment table{sizeof(toile_garment), 0, &bind<P>, &targets<P>};
};

} // namespace toile::sdk
