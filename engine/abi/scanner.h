/* toile/abi/scanner.h - kind "toile.scanner/1": frames of N cameras to one surface.
 *
 * begin, then feed for each instant (one frame of each camera that has one), then finish. The
 * surface stands where and as it stood in the first frame: in the world of the first camera's
 * world_from_camera or, where that is not known, upright (+Y up) with its lowest point at y = 0.
 */
#ifndef TOILE_ABI_SCANNER_H
#define TOILE_ABI_SCANNER_H
#include "frame.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Where a scan goes: host-owned buffers asked for by size. Only the mesh must be given. */
typedef struct toile_scan_sink {
    uint32_t size, reserved;
    toile_mesh_sink* mesh; /* positions, normals, colours, triangles, texture coordinates      */
    void* sink_data;
    /* After the mesh was committed, each at most once; buffers live until finish returns.
     * Texture: RGBA sRGB, rows from the top.                                         [worker] */
    toile_status (*texture)(struct toile_scan_sink*, uint32_t width, uint32_t height,
                            toile_view_mut* out);
    /* Skin: U16X4 (TOILE_JOINT_*) and F32X4, one row per vertex of the mesh.         [worker] */
    toile_status (*skin)(struct toile_scan_sink*, toile_view_mut* joint_indices,
                         toile_view_mut* joint_weights);
    /* How it went, a JSON object; copied.                                            [worker] */
    toile_status (*report)(struct toile_scan_sink*, const char* json);
} toile_scan_sink;

#define TOILE_SCANNER "toile.scanner/1"
typedef struct toile_scanner {
    uint32_t size, reserved;
    /* Forgets what was fed before. E_UNSUPPORTED for more cameras than it can use.   [worker] */
    toile_status (*begin)(toile_instance*, const toile_stream* streams, uint32_t count);
    toile_status (*feed)(toile_instance*, const toile_frame* frames, uint32_t count); /* [worker] */
    /* E_NUMERIC with the reason when nothing can be made of what was fed.            [worker] */
    toile_status (*finish)(toile_instance*, toile_scan_sink*, toile_job*);
} toile_scanner;

#ifdef __cplusplus
}
#endif
#endif
