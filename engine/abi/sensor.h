/* toile/abi/sensor.h - kind "toile.sensor/1": a camera or a recording of one.  DRAFT: no stock
 * plugin serves it yet; its shape may change until one does. */
#ifndef TOILE_ABI_SENSOR_H
#define TOILE_ABI_SENSOR_H
#include "frame.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

#define TOILE_SENSOR "toile.sensor/1"
typedef struct toile_sensor {
    uint32_t size, reserved;
    /* Opens what stands behind the scheme of a source URI ("" = the first device). [worker] */
    toile_status (*open)(toile_instance*, const char* uri, toile_job*);
    uint32_t (*stream_count)(toile_instance*);                                     /* [main]  */
    toile_status (*describe)(toile_instance*, uint32_t stream, toile_stream* out); /* [main] */
    /* Never blocks. TOILE_OK fills out with views that live until release.        [frame] */
    toile_status (*poll)(toile_instance*, uint32_t stream, toile_frame* out);
    void (*release)(toile_instance*, const toile_frame*); /* [frame] */
} toile_sensor;

#ifdef __cplusplus
}
#endif
#endif
