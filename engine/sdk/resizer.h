// Kind toile.resizer/1 for a class P with
//     void resize(const toile_resize_request& request, toile_view_mut positions, Job job);
//     // [worker]
#pragma once

#include "abi/resizer.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Resizer {
    static constexpr const char* id = TOILE_RESIZER;

    template <class P>
    static toile_status resize(toile_instance* instance, const toile_resize_request* request,
                               toile_view_mut positions, toile_job* job) noexcept {
        return guarded<P>(instance, [&](P& p) {
            return p.resize(read_struct(request, "request"), positions, Job(job));
        });
    }
    template <class P>
    static constexpr toile_resizer table{sizeof(toile_resizer), 0, &resize<P>};
};

} // namespace toile::sdk
