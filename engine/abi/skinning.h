/* toile/abi/skinning.h - kind "toile.skinning/1": joints to a posed surface. */
#ifndef TOILE_ABI_SKINNING_H
#define TOILE_ABI_SKINNING_H
#include "body.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

#define TOILE_SKINNING "toile.skinning/1"
typedef struct toile_skinning {
    uint32_t size, reserved;
    /* Copies what it needs of the body; pose then fits this body until the next bind. [worker] */
    toile_status (*bind)(toile_instance*, const toile_body*, toile_job*);
    /* state->joints in; positions and normals F32X3 (nv) out, host's. No allocation.   [frame] */
    toile_status (*pose)(toile_instance*, const toile_body_state*, toile_view_mut positions,
                         toile_view_mut normals);
} toile_skinning;

#ifdef __cplusplus
}
#endif
#endif
