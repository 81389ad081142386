/* toile/abi/part_labels.h - extension "toile.part_labels/1" of a body source that is fed frames:
 * which of 12 body parts each pixel shows, and whose. Costs nothing until it is asked for. */
#ifndef TOILE_ABI_PART_LABELS_H
#define TOILE_ABI_PART_LABELS_H
#include "body_source.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_part_picture {
    uint32_t size;
    uint32_t reserved;
    toile_view_mut parts;  /* U8 (width * height), host's: TOILE_PART_*, 0: nobody            */
    toile_view_mut people; /* U8 (the same), host's: n for the n-th of result, from 1; or
                              count 0                                                        */
} toile_part_picture;

#define TOILE_PART_LABELS "toile.part_labels/1"
typedef struct toile_part_labels {
    uint32_t size, reserved;
    /* Of the frame last fed, after result; frame is that frame once more, whose depth has the
     * size of the pictures. Fills both of them whole.                               [frame] */
    toile_status (*labels)(toile_instance*, const toile_frame* frame, toile_part_picture* out);
} toile_part_labels;

#ifdef __cplusplus
}
#endif
#endif
