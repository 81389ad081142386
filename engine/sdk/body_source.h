// Kind toile.body_source/1 for a class P with
//     toile_body_source_info describe();            // what it points to is the plugin's    [main]
//     void begin(const toile_body_source_setup& setup, Job job);                         //
//     [worker] toile_status feed(const toile_body_source_input& input); // or NO_NEW_DATA, END_...
//     [frame] std::uint32_t result(const SizedArray<toile_person>& people); // how many filled
//     [frame] void end(); // [main]
#pragma once

#include "abi/body_source.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct BodySource {
    static constexpr const char* id = TOILE_BODY_SOURCE;

    template <class P>
    static toile_status describe(toile_instance* instance, toile_body_source_info* out) noexcept {
        return guarded<P>(instance, [&](P& p) { write_struct(out, p.describe(), "out"); });
    }
    template <class P>
    static toile_status begin(toile_instance* instance, const toile_body_source_setup* setup,
                              toile_job* job) noexcept {
        return guarded<P>(instance,
                          [&](P& p) { return p.begin(read_struct(setup, "setup"), Job(job)); });
    }
    /// An own source may be fed null.
    template <class P>
    static toile_status feed(toile_instance* instance,
                             const toile_body_source_input* input) noexcept {
        return guarded<P>(instance, [&](P& p) {
            toile_body_source_input nothing{};
            nothing.size = sizeof(nothing);
            return p.feed(read_struct(input == nullptr ? &nothing : input, "input"));
        });
    }
    template <class P>
    static toile_status result(toile_instance* instance, toile_person* people,
                               std::uint32_t* count) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (count == nullptr) throw bad_argument("count: null");
            *count = p.result(SizedArray<toile_person>(people, *count, "people"));
        });
    }
    template <class P>
    static void end(toile_instance* instance) noexcept {
        (void)guarded<P>(instance, [](P& p) { p.end(); });
    }
    template <class P>
    static constexpr toile_body_source table{
        sizeof(toile_body_source), 0, &describe<P>, &begin<P>, &feed<P>, &result<P>, &end<P>};
};

} // namespace toile::sdk
