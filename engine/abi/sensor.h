/* toile/abi/sensor.h - kind "toile.sensor/1": cameras, or a recording or a simulation of
 * some.  open once, then poll and release frame by frame; reset begins a recording anew.  In
 * lock-step (toile_limits.live_clock 0) every poll of a stream gives its next frame; on the live
 * clock the newest that is due, or TOILE_NO_NEW_DATA.  Streams do not wait for each other. */
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
    /* Never waits for a device. TOILE_OK fills out with views that live until release; a second
     * frame of the stream is polled after that. Recordings and simulations read files and compute
     * here.                                                                         [frame] */
    toile_status (*poll)(toile_instance*, uint32_t stream, toile_frame* out);
    void (*release)(toile_instance*, const toile_frame*); /* [frame] */
} toile_sensor;

#ifdef __cplusplus
}
#endif
#endif
