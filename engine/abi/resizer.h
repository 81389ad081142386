/* toile/abi/resizer.h - kind "toile.resizer/1": a surface to other proportions (P3).
 *
 * Two ways, told apart by what the request holds:
 *   target       the region of the subject gets the target's proportions, strip by strip;
 *   body_before  the subject lies on, or hangs around, a body that is known before and after a
 *   body_after   change: it follows, and keeps its room to it.
 * Surfaces stand upright (+Y up) and face +Z.
 */
#ifndef TOILE_ABI_RESIZER_H
#define TOILE_ABI_RESIZER_H
#include "body.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_resize_request {
    uint32_t size, strips;     /* number of horizontal strips, 0: the plugin's default         */
    const toile_mesh* subject; /* to be changed: a body, or a mannequin with its garment       */
    const toile_mesh* target;  /* whose proportions are wanted, or null                        */
    toile_view region;         /* F32 (nv of the subject): 1 to 0.5 is resized; below 0.5 it is
                                  trunk beside that, which moves along at the seams; 0 stays.
                                  Count 0: the plugin finds the abdomen                        */
    toile_view target_region;  /* F32 (nv of the target), the same                             */
    const toile_mesh* body_before; /* or null                                                  */
    const toile_mesh* body_after;  /* the same vertices and triangles, or null                 */
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
