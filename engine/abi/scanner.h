/* toile/abi/scanner.h - kind "toile.scanner/1": frames of N cameras to a mesh.  DRAFT. */
#ifndef TOILE_ABI_SCANNER_H
#define TOILE_ABI_SCANNER_H
#include "frame.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

/* Optional extras of a scan beside its mesh: host-owned buffers asked for by size. */
typedef struct toile_scan_sink {
    uint32_t size, reserved;
    toile_mesh_sink* mesh; /* positions, normals, colours, triangles, texture coordinates    */
    void* sink_data;
    /* Texture, RGBA sRGB, rows from the top.                                       [worker] */
    toile_status (*texture)(struct toile_scan_sink*, uint32_t width, uint32_t height,
                            toile_view_mut* out);
    /* Skin: U16X4 and F32X4, one row per vertex of the committed mesh.             [worker] */
    toile_status (*skin)(struct toile_scan_sink*, toile_view_mut* joint_indices,
                         toile_view_mut* joint_weights);
} toile_scan_sink;

#define TOILE_SCANNER "toile.scanner/1"
typedef struct toile_scanner {
    uint32_t size, reserved;
    toile_status (*begin)(toile_instance*, const toile_stream* streams, uint32_t count);
    toile_status (*feed)(toile_instance*, const toile_frame* frames, uint32_t count); /* [worker] */
    toile_status (*finish)(toile_instance*, toile_scan_sink*, toile_job*);            /* [worker] */
} toile_scanner;

#ifdef __cplusplus
}
#endif
#endif
