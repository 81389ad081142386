/* toile/abi/base.h - what every header of the plugin boundary stands on.  C11 / C++11 and up.
 *
 * Conventions that hold for every struct and call of the boundary
 *   units      metres, seconds, kilograms, radians; timestamps are int64 nanoseconds
 *   frame      world: right-handed, +Y up, floor at y = 0, the body faces +Z (as glTF);
 *              camera: looks along its -Z, +Y up; pixel (0,0) is the centre of the top-left one
 *   triangles  counter-clockwise seen from outside
 *   rotation   unit quaternion, order x y z w
 *   matrices   16 floats, column-major
 *   strings    UTF-8, NUL-terminated, never null unless the comment says "or null"
 *   layout     natural alignment, no packing, no bool, no bitfields, no C++ types
 *   size       first member of every struct that may grow: sizeof() in the writer's build;
 *              the caller sets it on out-structs, the callee fills at most that much
 *   views      borrowed for the call; whoever receives one never frees it nor keeps it
 *   enums      int32_t / uint32_t fields; the value zero is invalid unless it says otherwise
 *   threads    [main] one thread for life     [worker] may block; never with [frame] of the same
 *              instance   [frame] per-frame thread: no allocation, no lock, no file
 *              [any] callable from any thread at any time
 *   failure    return a toile_status < 0 after telling host->report why; never throw, abort, exit
 */
#ifndef TOILE_ABI_BASE_H
#define TOILE_ABI_BASE_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* Version of the whole boundary; its history stands in docs/abi_history.md. */
#define TOILE_ABI_MAJOR 1u /* layout or meaning changed: anything else is refused      */
#define TOILE_ABI_MINOR 0u /* fields appended: older plugins load, newer are refused   */

typedef int32_t toile_status;
enum {
    TOILE_OK = 0,
    TOILE_NO_NEW_DATA = 1,   /* nothing newer than the last call saw                    */
    TOILE_END_OF_STREAM = 2, /* a recording is over; every later call says so too       */
    TOILE_CANCELLED = 3,     /* the job was cancelled; outputs are undefined            */
    TOILE_E_ARGUMENT = -1,
    TOILE_E_UNSUPPORTED = -2,
    TOILE_E_DEVICE = -3,
    TOILE_E_NUMERIC = -4,
    TOILE_E_CAPACITY = -5,
    TOILE_E_IO = -6,
    TOILE_E_INTERNAL = -7
};

/* ---- data views -------------------------------------------------------------------------- */
enum {
    TOILE_FORMAT_INVALID = 0,
    TOILE_F32 = 1,
    TOILE_F32X2 = 2,
    TOILE_F32X3 = 3,
    TOILE_F32X4 = 4,
    TOILE_U8 = 5,
    TOILE_U8X4 = 6,
    TOILE_U16 = 7,
    TOILE_U16X4 = 8,
    TOILE_U32 = 9,
    TOILE_U32X3 = 10,
    TOILE_STRUCT = 11 /* elements are the struct that the field's comment names        */
};

typedef struct toile_view {
    const void* data; /* first element, or null when count is 0                        */
    uint32_t count;   /* elements                                                      */
    uint32_t stride;  /* bytes from one element to the next                            */
    uint32_t format;  /* TOILE_F32 ...                                                 */
    uint32_t reserved;
} toile_view;

typedef struct toile_view_mut {
    void* data;
    uint32_t count, stride, format, reserved;
} toile_view_mut;

/* One triangle mesh. */
typedef struct toile_mesh {
    uint32_t size, reserved;
    toile_view positions;     /* F32X3 (nv)                                           */
    toile_view normals;       /* F32X3 (nv), or count 0                               */
    toile_view colors;        /* U8X4 sRGB (nv), or count 0                           */
    toile_view triangles;     /* U32X3 (nf), every index < nv                         */
    toile_view corner_coords; /* F32X2 (3 nf): texture or material coordinates, or 0  */
    uint64_t topology_id;     /* equal ids mean equal triangles                       */
} toile_mesh;

/* ---- long calls ---------------------------------------------------------------------------- */
/* Handed to every call that may take longer than a frame. Host-owned, lives until it returns. */
typedef struct toile_job {
    uint32_t size, reserved;
    void* job_data;
    /* fraction in [0,1], text or null. Nonzero: cancelled, return TOILE_CANCELLED soon. [any] */
    int32_t (*progress)(struct toile_job*, double fraction, const char* text);
} toile_job;

/* Output of unknown size: the plugin asks, the host allocates, the plugin fills, the host
 * checks (finite, indices in range) and keeps. begin may be called once per sink. */
typedef struct toile_mesh_buffers {
    uint32_t size, reserved;
    toile_view_mut positions, normals, colors, triangles, corner_coords;
} toile_mesh_buffers;

typedef struct toile_mesh_sink {
    uint32_t size, reserved;
    void* sink_data;
    /* out->size is set by the plugin; buffers live until commit.            [worker or main] */
    toile_status (*begin)(struct toile_mesh_sink*, uint32_t nv, uint32_t nf,
                          toile_mesh_buffers* out);
    toile_status (*commit)(struct toile_mesh_sink*); /* [worker or main] */
} toile_mesh_sink;

#ifdef __cplusplus
}
#endif
#endif
