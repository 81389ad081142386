// Extension toile.body_fit/1 for a body source class P with
//     void fit(const toile_body_fit_options& options, Job job);             // [worker]
//     void fitted_surface(std::uint32_t instant, toile_mesh_sink& sink);    // [worker]
//     std::string fit_report();                                             // JSON  [main]
// and `using Extensions = Kinds<BodyFit>;`.
#pragma once

#include "abi/body_fit.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

#include <string>

namespace toile::sdk {

struct BodyFit {
    static constexpr const char* id = TOILE_BODY_FIT;

    template <class P>
    static toile_status fit(toile_instance* instance, const toile_body_fit_options* options,
                            toile_job* job) noexcept {
        return guarded<P>(instance,
                          [&](P& p) { p.fit(read_struct(options, "options"), Job(job)); });
    }
    template <class P>
    static toile_status surface(toile_instance* instance, std::uint32_t instant,
                                toile_mesh_sink* sink) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (sink == nullptr) throw bad_argument("sink: null");
            p.fitted_surface(instant, *sink);
        });
    }
    template <class P>
    static toile_status report(toile_instance* instance, char* text,
                               std::uint64_t* bytes) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (bytes == nullptr) throw bad_argument("bytes: null");
            const std::string json = p.fit_report();
            const std::uint64_t room = *bytes;
            *bytes = json.size();
            if (room < json.size() || text == nullptr)
                throw Failure(TOILE_E_CAPACITY, "text: too small for the report");
            std::memcpy(text, json.data(), json.size());
        });
    }
    template <class P>
    static constexpr toile_body_fit table{sizeof(toile_body_fit), 0, &fit<P>, &surface<P>,
                                          &report<P>};
};

} // namespace toile::sdk
