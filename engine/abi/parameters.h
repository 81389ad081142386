/* toile/abi/parameters.h - extensions that any instance may offer beside its kind.
 * "toile.parameters/1": typed, ranged numbers with units; "toile.state/1": what to keep between
 * runs; "toile.debug_draw/1": lines for people to look at.  State and debug drawing: DRAFT. */
#ifndef TOILE_ABI_PARAMETERS_H
#define TOILE_ABI_PARAMETERS_H
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {
    TOILE_PARAMETER_INVALID = 0,
    TOILE_PARAMETER_REAL = 1,
    TOILE_PARAMETER_INTEGER = 2,
    TOILE_PARAMETER_SWITCH = 3 /* 0 or 1                                                      */
};

typedef struct toile_parameter {
    uint32_t size, type;
    const char* id;   /* "substeps"                                                           */
    const char* unit; /* "m", "s", "1", ...                                                   */
    const char* text; /* one line                                                             */
    double minimum, maximum, default_value;
} toile_parameter;

#define TOILE_PARAMETERS "toile.parameters/1"
typedef struct toile_parameters {
    uint32_t size, reserved;
    uint32_t (*count)(toile_instance*);                                              /* [main] */
    toile_status (*describe)(toile_instance*, uint32_t index, toile_parameter* out); /* [main] */
    toile_status (*get)(toile_instance*, const char* id, double* value);             /* [main] */
    toile_status (*set)(toile_instance*, const char* id, double value); /* [main & !active] */
} toile_parameters;

#define TOILE_STATE "toile.state/1"
typedef struct toile_state {
    uint32_t size, reserved;
    /* *bytes: capacity in, size out; E_CAPACITY when it is too small.               [main] */
    toile_status (*save)(toile_instance*, void* data, uint64_t* bytes);
    toile_status (*load)(toile_instance*, const void* data, uint64_t bytes); /* [main & !active] */
} toile_state;

typedef struct toile_debug_line {
    float from[3], to[3];
    uint32_t rgba; /* 0xRRGGBBAA                                                               */
} toile_debug_line;

#define TOILE_DEBUG_DRAW "toile.debug_draw/1"
typedef struct toile_debug_draw {
    uint32_t size, reserved;
    /* *count: capacity in, lines out.                                               [frame] */
    toile_status (*lines)(toile_instance*, toile_debug_line* lines, uint32_t* count);
} toile_debug_draw;

#ifdef __cplusplus
}
#endif
#endif
