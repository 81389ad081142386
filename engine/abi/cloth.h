/* toile/abi/cloth.h - kind "toile.cloth/1": one cloth world per person. The solver sees all
 * layers at once and the body's motion within the step. */
#ifndef TOILE_ABI_CLOTH_H
#define TOILE_ABI_CLOTH_H
#include "garment.h"
#ifdef __cplusplus
extern "C" {
#endif

/* A spring of zero rest length between two vertices of one garment (closing a seam). */
typedef struct toile_seam {
    uint32_t a, b;
} toile_seam;

typedef struct toile_cloth_garment {
    uint32_t size, layer;
    toile_mesh rest;          /* positions: start; corner_coords (3 nf) metres: rest state    */
    toile_view joint_indices; /* U16X4 (nv) as bound                                          */
    toile_view joint_weights; /* F32X4 (nv)                                                   */
    toile_view attachment;    /* F32 (nv) 0 free .. 1 held to its target                      */
    toile_view seams;         /* STRUCT toile_seam, or count 0                                */
    toile_fabric fabric;
} toile_cloth_garment;

enum {
    TOILE_STEP_NONE = 0,
    TOILE_STEP_RESET = 1 /* forget velocities; start from the targets                         */
};

typedef struct toile_garment_target {
    uint32_t garment, reserved; /* handle                                                     */
    toile_view positions;       /* F32X3 (nv) at the end of the step                          */
} toile_garment_target;

/* Filled by step; host's buffers. */
typedef struct toile_garment_state {
    uint32_t size, garment;
    toile_view_mut positions, normals; /* F32X3 (nv)                                          */
} toile_garment_state;

typedef struct toile_cloth_step {
    uint32_t size, flags;                /* TOILE_STEP_*                                      */
    const toile_body_state* body_before; /* at the start of the step; equal to after at first */
    const toile_body_state* body_after;  /* at its end                                        */
    double dt_s;
    const toile_garment_target* targets; /* (garment_count)                                   */
    toile_garment_state* states;         /* (garment_count)                                   */
    uint32_t garment_count, reserved;
} toile_cloth_step;

#define TOILE_CLOTH "toile.cloth/1"
typedef struct toile_cloth {
    uint32_t size, reserved;
    /* Copies what it needs: topology, parts, weights of the body to collide with. [worker] */
    toile_status (*set_body)(toile_instance*, const toile_body*, toile_job*);
    /* *garment out: a handle, never 0.                                            [worker] */
    toile_status (*add_garment)(toile_instance*, const toile_cloth_garment*, toile_job*,
                                uint32_t* garment);
    toile_status (*remove_garment)(toile_instance*, uint32_t garment); /* [worker] */
    toile_status (*step)(toile_instance*, const toile_cloth_step*);    /* [frame]  */
} toile_cloth;

#ifdef __cplusplus
}
#endif
#endif
