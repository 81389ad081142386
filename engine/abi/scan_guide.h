/* toile/abi/scan_guide.h - extension "toile.scan_guide/1" of a scanner of people who move: a rough
 * body, found by the host in some of the frames, as it stood in each of them.
 *
 * The host feeds all frames, calls guide for some of them (the first among them) and then finish.
 * It calls nothing when it found no body; the scanner then does without, or says why it cannot.
 */
#ifndef TOILE_ABI_SCAN_GUIDE_H
#define TOILE_ABI_SCAN_GUIDE_H
#include "base.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_scan_template {
    uint32_t size;
    uint32_t instant;       /* number of the feed call, from 0                                */
    toile_mesh surface;     /* as it stood then, closed; the same triangles at every instant;
                               in the cameras' world or, of a single camera that does not know
                               where it stands, in its frame                                  */
    toile_view part_labels; /* U8 (nv), TOILE_PART_*, or count 0                              */
} toile_scan_template;

#define TOILE_SCAN_GUIDE "toile.scan_guide/1"
typedef struct toile_scan_guide {
    uint32_t size, reserved;
    /* Copies what it is given. Forgotten by begin.                                  [worker] */
    toile_status (*guide)(toile_instance*, const toile_scan_template*);
} toile_scan_guide;

#ifdef __cplusplus
}
#endif
#endif
