/* toile/abi/garment.h - kind "toile.garment/1": binds a garment package to a body and says each
 * frame where the cloth would like to be. The package is parsed and checked by the host. */
#ifndef TOILE_ABI_GARMENT_H
#define TOILE_ABI_GARMENT_H
#include "body.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Units as in garment.json turned to SI. Warp runs along v, weft along u of corner_coords. */
typedef struct toile_fabric {
    uint32_t size, reserved;
    float density_kg_m2;
    float thickness_m;
    float stretch_warp_n_m, stretch_weft_n_m; /* N/m: force per width per unit strain         */
    float shear_n_m;                          /* N/m                                          */
    float bend_warp_nm, bend_weft_nm;         /* N m: bending rigidity per width              */
    float friction;                           /* against skin, Coulomb                        */
    float damping;                            /* 1/s, share of relative velocity lost         */
} toile_fabric;

/* One size of one design. nv: vertices of the welded simulation mesh. */
typedef struct toile_garment_package {
    uint32_t size;
    uint32_t layer; /* 0 next to the skin                                           */
    const char* id; /* "t-shirt"                                                    */
    const char* version;
    const char* size_name;     /* "M"                                                          */
    toile_mesh simulation;     /* as made, on the body below; corner_coords: metres, rest state */
    toile_view joint_indices;  /* U16X4 (nv), or count 0: the plugin finds them                */
    toile_view joint_weights;  /* F32X4 (nv)                                                   */
    toile_view pins;           /* F32 (nv) 0 free .. 1 held to the body, or count 0            */
    const toile_body* made_on; /* body and pose that the mesh was made on, or null            */
    toile_fabric fabric;
    float ease_m; /* least wanted distance from the skin                          */
    uint32_t reserved;
} toile_garment_package;

/* Filled by bind; the host owns the buffers. */
typedef struct toile_garment_binding {
    uint32_t size, reserved;
    toile_view_mut positions;     /* F32X3 (nv) on this body in its rest pose, clear of it   */
    toile_view_mut joint_indices; /* U16X4 (nv)                                               */
    toile_view_mut joint_weights; /* F32X4 (nv) rows sum to 1                                 */
    toile_view_mut attachment;    /* F32 (nv) 0 free .. 1 follows its target exactly          */
} toile_garment_binding;

#define TOILE_GARMENT "toile.garment/1"
typedef struct toile_garment {
    uint32_t size, reserved;
    toile_status (*bind)(toile_instance*, const toile_body*, const toile_garment_package*,
                         toile_job*, toile_garment_binding* out); /* [worker] */
    /* positions F32X3 (nv): where plain skinning would have the cloth in this pose.  [frame] */
    toile_status (*targets)(toile_instance*, const toile_body_state*, toile_view_mut positions);
} toile_garment;

#ifdef __cplusplus
}
#endif
#endif
