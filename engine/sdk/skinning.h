// Kind toile.skinning/1 for a class P with
//     void bind(const toile_body& body, Job job);                                      // [worker]
//     void pose(const toile_body_state& state, toile_view_mut positions,
//               toile_view_mut normals);                                               // [frame]
#pragma once

#include "abi/skinning.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Skinning {
    static constexpr const char* id = TOILE_SKINNING;

    template <class P>
    static toile_status bind(toile_instance* instance, const toile_body* body,
                             toile_job* job) noexcept {
        return guarded<P>(instance,
                          [&](P& p) { return p.bind(read_struct(body, "body"), Job(job)); });
    }
    template <class P>
    static toile_status pose(toile_instance* instance, const toile_body_state* state,
                             toile_view_mut positions, toile_view_mut normals) noexcept {
        return guarded<P>(instance, [&](P& p) {
            return p.pose(read_struct(state, "state"), positions, normals);
        });
    }
    template <class P>
    static constexpr toile_skinning table{sizeof(toile_skinning), 0, &bind<P>, &pose<P>};
};

} // namespace toile::sdk
