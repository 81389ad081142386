// Extension toile.truth/1 for a sensor class P with
//     std::uint32_t true_people(std::uint32_t sequence, const SizedArray<toile_person>& people);
//     toile_true_camera true_camera(std::uint32_t stream);                                // [main]
//     std::uint32_t true_surface_count();                                                 // [main]
//     toile_true_surface true_surface(std::uint32_t sequence, std::uint32_t index,
//                                     toile_mesh_sink& sink);                           // [worker]
// and `using Extensions = Kinds<Truth>;`. true_people returns how many it filled.         [worker]
#pragma once

#include "abi/truth.h"
#include "sdk/guard.h"
#include "sdk/structs.h"

namespace toile::sdk {

struct Truth {
    static constexpr const char* id = TOILE_TRUTH;

    template <class P>
    static toile_status people(toile_instance* instance, std::uint32_t sequence,
                               toile_person* people, std::uint32_t* count) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (count == nullptr) throw bad_argument("count: null");
            *count = p.true_people(sequence, SizedArray<toile_person>(people, *count, "people"));
        });
    }
    template <class P>
    static toile_status camera(toile_instance* instance, std::uint32_t stream,
                               toile_true_camera* out) noexcept {
        return guarded<P>(instance, [&](P& p) { write_struct(out, p.true_camera(stream), "out"); });
    }
    template <class P>
    static std::uint32_t surface_count(toile_instance* instance) noexcept {
        std::uint32_t count = 0;
        (void)guarded<P>(instance, [&](P& p) { count = p.true_surface_count(); });
        return count;
    }
    template <class P>
    static toile_status surface(toile_instance* instance, std::uint32_t sequence,
                                std::uint32_t index, toile_true_surface* about,
                                toile_mesh_sink* sink) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (sink == nullptr) throw bad_argument("sink: null");
            const toile_true_surface found = p.true_surface(sequence, index, *sink);
            if (about != nullptr) write_struct(about, found, "about");
        });
    }
    template <class P>
    static constexpr toile_truth table{sizeof(toile_truth), 0,          &people<P>, &camera<P>,
                                       &surface_count<P>,   &surface<P>};
};

} // namespace toile::sdk
