// Kind toile.scanner/1 for a class P with
//     void begin(const SizedArray<const toile_stream>& streams);  // [worker]
//     void feed(const SizedArray<const toile_frame>& frames);     // [worker]
//     void finish(toile_scan_sink& sink, Job job);                // [worker]
#pragma once

#include "abi/scanner.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Scanner {
    static constexpr const char* id = TOILE_SCANNER;

    template <class P>
    static toile_status begin(toile_instance* instance, const toile_stream* streams,
                              std::uint32_t count) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (count == 0) throw bad_argument("streams: no camera");
            return p.begin(SizedArray<const toile_stream>(streams, count, "streams"));
        });
    }
    template <class P>
    static toile_status feed(toile_instance* instance, const toile_frame* frames,
                             std::uint32_t count) noexcept {
        return guarded<P>(instance, [&](P& p) {
            return p.feed(SizedArray<const toile_frame>(frames, count, "frames"));
        });
    }
    template <class P>
    static toile_status finish(toile_instance* instance, toile_scan_sink* sink,
                               toile_job* job) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (sink == nullptr || sink->mesh == nullptr) throw bad_argument("sink: null");
            return p.finish(*sink, Job(job));
        });
    }
    template <class P>
    static constexpr toile_scanner table{sizeof(toile_scanner), 0, &begin<P>, &feed<P>, &finish<P>};
};

} // namespace toile::sdk
