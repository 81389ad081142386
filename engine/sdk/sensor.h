// Kind toile.sensor/1 for a class P with
//     void open(const char* uri, Job job);                                             // [worker]
//     std::uint32_t stream_count();                                                      // [main]
//     toile_stream describe(std::uint32_t stream);                                       // [main]
//     toile_status poll(std::uint32_t stream, toile_frame& out);                        // [frame]
//     void release(const toile_frame& frame);                                           // [frame]
// The views that poll gives live until release.
#pragma once

#include "abi/sensor.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Sensor {
    static constexpr const char* id = TOILE_SENSOR;

    template <class P>
    static toile_status open(toile_instance* instance, const char* uri, toile_job* job) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (uri == nullptr) throw bad_argument("uri: null");
            return p.open(uri, Job(job));
        });
    }
    template <class P>
    static std::uint32_t stream_count(toile_instance* instance) noexcept {
        std::uint32_t count = 0;
        (void)guarded<P>(instance, [&](P& p) { count = p.stream_count(); });
        return count;
    }
    template <class P>
    static toile_status describe(toile_instance* instance, std::uint32_t stream,
                                 toile_stream* out) noexcept {
        return guarded<P>(instance, [&](P& p) { write_struct(out, p.describe(stream), "out"); });
    }
    template <class P>
    static toile_status poll(toile_instance* instance, std::uint32_t stream,
                             toile_frame* out) noexcept {
        return guarded<P>(instance, [&](P& p) -> toile_status {
            toile_frame frame{};
            frame.size = sizeof(frame);
            const toile_status status = p.poll(stream, frame);
            if (status == TOILE_OK) write_struct(out, frame, "out");
            return status;
        });
    }
    template <class P>
    static void release(toile_instance* instance, const toile_frame* frame) noexcept {
        (void)guarded<P>(instance, [&](P& p) { p.release(read_struct(frame, "frame")); });
    }
    template <class P>
    static constexpr toile_sensor table{
        sizeof(toile_sensor), 0, &open<P>, &stream_count<P>, &describe<P>, &poll<P>, &release<P>};
};

} // namespace toile::sdk
