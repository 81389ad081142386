// Extension toile.part_labels/1 for a body source class P with
//     void label_pixels(const toile_frame& frame, std::span<std::uint8_t> parts,
//                       std::span<std::uint8_t> people);  // people may be empty  [frame]
// and `using Extensions = Kinds<PartLabels>;`. Both spans are as long as the frame's depth, or the
// call is refused before.
#pragma once

#include "abi/part_labels.h"
#include "sdk/guard.h"
#include "sdk/structs.h"
#include "sdk/views.h"

namespace toile::sdk {

struct PartLabels {
    static constexpr const char* id = TOILE_PART_LABELS;

    template <class P>
    static toile_status labels(toile_instance* instance, const toile_frame* frame,
                               toile_part_picture* out) noexcept {
        return guarded<P>(instance, [&](P& p) {
            const toile_frame known = read_struct(frame, "frame");
            const toile_part_picture picture = read_struct(out, "out");
            const std::size_t pixels = known.depth_m.count;
            if (picture.parts.count != pixels)
                throw bad_argument("parts: not of the depth picture's size");
            if (picture.people.count != 0 && picture.people.count != pixels)
                throw bad_argument("people: not of the depth picture's size");
            p.label_pixels(known, span_of<std::uint8_t>(picture.parts, "parts"),
                           span_of<std::uint8_t>(picture.people, "people"));
        });
    }
    template <class P>
    static constexpr toile_part_labels table{sizeof(toile_part_labels), 0, &labels<P>};
};

} // namespace toile::sdk
