/* toile/abi/body_fit.h - extension "toile.body_fit/1" of a body source whose feed only collects
 * frames or a scan: the long work of finding one body in all of them, as a job.
 *
 * begin (streams of the cameras, or none for a scan), feed once for each instant or once with a
 * scan, fit, then body_source.result with the person of the instant fed last, and end.
 */
#ifndef TOILE_ABI_BODY_FIT_H
#define TOILE_ABI_BODY_FIT_H
#include "body_source.h"
#ifdef __cplusplus
extern "C" {
#endif

enum { TOILE_SEX_UNKNOWN = 0, TOILE_SEX_FEMALE = 1, TOILE_SEX_MALE = 2 };

typedef struct toile_body_fit_options {
    uint32_t size;
    uint32_t sex;     /* TOILE_SEX_*: whose population is the prior; unknown: the likelier    */
    uint32_t dressed; /* 1: cloth may lie between skin and what was seen                      */
    uint32_t reserved;
} toile_body_fit_options;

#define TOILE_BODY_FIT "toile.body_fit/1"
typedef struct toile_body_fit {
    uint32_t size, reserved;
    /* Fits all that was fed since begin. What is no person is an error that says why. [worker] */
    toile_status (*fit)(toile_instance*, const toile_body_fit_options*, toile_job*);
    /* The fitted surface in the pose of one instant (from 0), metres, in the world of the
     * cameras or of the scan.                                                        [worker] */
    toile_status (*surface)(toile_instance*, uint32_t instant, toile_mesh_sink*);
    /* How it went, JSON, UTF-8, no terminating zero. *bytes: capacity in, size out;
     * E_CAPACITY when it is too small.                                                 [main] */
    toile_status (*report)(toile_instance*, char* text, uint64_t* bytes);
} toile_body_fit;

#ifdef __cplusplus
}
#endif
#endif
