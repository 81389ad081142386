/* toile/abi/frame.h - one picture of one camera; several cameras make an array of them. */
#ifndef TOILE_ABI_FRAME_H
#define TOILE_ABI_FRAME_H
#include "base.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Pinhole with Brown-Conrady distortion; pixels, as OpenCV's camera matrix. */
typedef struct toile_intrinsics {
    uint32_t width, height;
    double fx, fy, cx, cy;
    double distortion[8]; /* k1 k2 p1 p2 k3 k4 k5 k6                                       */
} toile_intrinsics;

typedef struct toile_stream {
    uint32_t size;
    uint32_t camera;             /* index of the camera in the device or capture            */
    toile_intrinsics depth;      /* width 0: no depth                                      */
    toile_intrinsics color;      /* width 0: no colour                                     */
    double color_from_depth[16]; /* identity when registered                               */
    double world_from_camera[16];
    uint32_t has_world, registered;
    double frame_period_s;
} toile_stream;

typedef struct toile_frame {
    uint32_t size;
    uint32_t camera;
    uint32_t sequence; /* + 1 per new frame; gaps mean drops                             */
    uint32_t reserved;
    int64_t timestamp_ns; /* capture time                                                   */
    toile_view depth_m;   /* F32 (width * height), rows from the top, NaN where unknown      */
    toile_view color;     /* U8X4 sRGB (width * height), or count 0                          */
} toile_frame;

#ifdef __cplusplus
}
#endif
#endif
