/* toile/abi/truth.h - extension "toile.truth/1": what a simulated sensor knows and a real one does
 * not.  Of a sensor that is open; frames are named by the sequence number that poll gave them. */
#ifndef TOILE_ABI_TRUTH_H
#define TOILE_ABI_TRUTH_H
#include "body_source.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {
    TOILE_SURFACE_INVALID = 0,
    TOILE_SURFACE_BODY = 1,    /* a person's own closed skin                                  */
    TOILE_SURFACE_GARMENT = 2, /* what is worn over it                                       */
    TOILE_SURFACE_OTHER = 3    /* hair, eyes                                                 */
};

typedef struct toile_true_camera {
    uint32_t size, reserved;
    double world_from_camera[16]; /* where it really stands, not where describe says         */
    double depth_scale;           /* factor by which its depths are too long                 */
    const char* name; /* "" when it has none; lives until the sensor is opened again         */
} toile_true_camera;

typedef struct toile_true_surface {
    uint32_t size;
    uint32_t role;      /* TOILE_SURFACE_*                                                    */
    uint32_t person_id; /* of whom; the number that people gives, or would give              */
    uint32_t reserved;
    const char* name; /* lives until the sensor is opened again                              */
} toile_true_surface;

#define TOILE_TRUTH "toile.truth/1"
typedef struct toile_truth {
    uint32_t size, reserved;
    /* Everybody with joints in one frame; *count: capacity in, people out.       [worker] */
    toile_status (*people)(toile_instance*, uint32_t sequence, toile_person* people,
                           uint32_t* count);
    toile_status (*camera)(toile_instance*, uint32_t stream, toile_true_camera* out); /* [main] */
    uint32_t (*surface_count)(toile_instance*);                                       /* [main] */
    /* One surface in one frame: positions and triangles, the same triangles in every frame;
     * about may be null. [worker] */
    toile_status (*surface)(toile_instance*, uint32_t sequence, uint32_t index,
                            toile_true_surface* about, toile_mesh_sink* sink);
} toile_truth;

#ifdef __cplusplus
}
#endif
#endif
