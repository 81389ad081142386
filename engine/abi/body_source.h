/* toile/abi/body_source.h - kind "toile.body_source/1": frames, a scan or a log to people.
 *
 * Fed by the host (frames of N cameras, or a scan), or its own source (a recorded log): describe
 * says which. begin once, then feed and result in turn; result may give several people.
 */
#ifndef TOILE_ABI_BODY_SOURCE_H
#define TOILE_ABI_BODY_SOURCE_H
#include "body.h"
#include "frame.h"
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {
    TOILE_SOURCE_INVALID = 0,
    TOILE_SOURCE_FRAMES = 1, /* feed wants camera frames                                    */
    TOILE_SOURCE_SCAN = 2,   /* feed wants one mesh                                         */
    TOILE_SOURCE_OWN = 3     /* reads what the URI names; feed takes nothing                */
};

typedef struct toile_body_source_info {
    uint32_t size;
    uint32_t input;             /* TOILE_SOURCE_*                                            */
    const char* const* schemes; /* URI schemes of an own source, null-terminated, or null    */
} toile_body_source_info;

typedef struct toile_body_source_setup {
    uint32_t size;
    uint32_t stream_count;
    const char* uri;             /* what follows the scheme: a file, a device               */
    const toile_stream* streams; /* (stream_count) cameras that will feed it, or null        */
    const toile_body* body;      /* the body to pose; its bone lengths hold. Or null: find it */
    uint32_t max_people, reserved;
} toile_body_source_setup;

typedef struct toile_body_source_input {
    uint32_t size;
    uint32_t frame_count;
    const toile_frame* frames; /* (frame_count), one per camera, or null                     */
    const toile_mesh* scan;    /* or null                                                    */
} toile_body_source_input;

/* One person; the host owns joints' storage, everything else is filled by the plugin. */
typedef struct toile_person {
    uint32_t size;
    uint32_t has_new_body;  /* 1: body below differs from the one given at begin            */
    const toile_body* body; /* the plugin's, lives until the next new body or end; or null  */
    toile_body_state state; /* state.joints is ignored, see joints                          */
    toile_view_mut joints;  /* STRUCT toile_joint (22), host's                              */
} toile_person;

#define TOILE_BODY_SOURCE "toile.body_source/1"
typedef struct toile_body_source {
    uint32_t size, reserved;
    toile_status (*describe)(toile_instance*, toile_body_source_info* out); /* [main] */
    /* A missing or unreadable source is an error here, not later.                   [worker] */
    toile_status (*begin)(toile_instance*, const toile_body_source_setup*, toile_job*);
    /* Own source: advances one recorded frame; OK, NO_NEW_DATA, END_OF_STREAM.       [frame] */
    toile_status (*feed)(toile_instance*, const toile_body_source_input*);
    /* People of the frame last fed; *count: capacity in, people out. Never blocks.   [frame] */
    toile_status (*result)(toile_instance*, toile_person* people, uint32_t* count);
    void (*end)(toile_instance*); /* [main] */
} toile_body_source;

#ifdef __cplusplus
}
#endif
#endif
