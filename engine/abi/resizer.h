/* toile/abi/resizer.h - kind "toile.resizer/1": a body or garment to other girths (P3).  DRAFT. */
#ifndef TOILE_ABI_RESIZER_H
#define TOILE_ABI_RESIZER_H
#include "body.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_resize_request {
    uint32_t size, strips;     /* number of horizontal strips, 0: the plugin's default        */
    const toile_mesh* subject; /* mesh to change (mannequin with its garment, or a body)      */
    const toile_mesh* target;  /* body whose proportions are wanted, or null                  */
    toile_view region_weight;  /* F32 (nv) where it may act, or count 0: found by the plugin  */
    toile_view girths;         /* STRUCT toile_measurement wanted, or count 0                 */
} toile_resize_request;

#define TOILE_RESIZER "toile.resizer/1"
typedef struct toile_resizer {
    uint32_t size, reserved;
    /* positions F32X3 (nv of the subject), host's.                                  [worker] */
    toile_status (*resize)(toile_instance*, const toile_resize_request*, toile_view_mut positions,
                           toile_job*);
} toile_resizer;

#ifdef __cplusplus
}
#endif
#endif
