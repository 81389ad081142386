/* toile/abi/plugin.h - the one symbol a library exports, and the life of an instance.
 *
 * Beside the library stands plugin.json, read before the library is opened (docs/plugins.md).
 * Life of an instance: create -> init -> activate -> calls of its kind -> deactivate -> destroy;
 * activate and deactivate may alternate. Libraries stay loaded while the application runs.
 */
#ifndef TOILE_ABI_PLUGIN_H
#define TOILE_ABI_PLUGIN_H
#include "host.h"
#ifdef __cplusplus
extern "C" {
#endif

/* What a library provides; must agree with plugin.json. */
typedef struct toile_descriptor {
    uint32_t size, reserved;
    const char* id;      /* "toile.bullet_cloth", reverse domain or toile.*               */
    const char* name;    /* for people                                                    */
    const char* version; /* semver                                                        */
    const char* vendor;
    const char* const* kinds; /* extension ids of the kinds offered, null-terminated      */
} toile_descriptor;

/* Constant while active; every buffer is sized by it. */
typedef struct toile_limits {
    uint32_t size;
    uint32_t max_people;
    uint32_t max_vertices; /* of one surface                                              */
    uint32_t max_triangles;
    uint32_t thread_count;
    uint32_t live_clock;   /* 1: late frames are dropped; 0: lock-step, dt from timestamps */
    double frame_budget_s; /* what one frame call may take on the live clock              */
    uint64_t random_seed;  /* same seed and same input give the same bytes                */
} toile_limits;

typedef struct toile_instance {
    uint32_t size, reserved;
    const toile_descriptor* descriptor;
    void* plugin_data; /* the plugin's own                                                 */
    toile_status (*init)(struct toile_instance*);                          /* [main]             */
    toile_status (*activate)(struct toile_instance*, const toile_limits*); /* [main & !active] */
    void (*deactivate)(struct toile_instance*);                            /* [main & active]    */
    void (*reset)(struct toile_instance*);   /* [frame] forget history */
    void (*destroy)(struct toile_instance*); /* [main & !active]   */
    /* A kind's or extension's constant table of calls, or null.              [any] */
    const void* (*get_extension)(struct toile_instance*, const char* id);
} toile_instance;

typedef struct toile_entry {
    uint32_t size, abi_major, abi_minor, reserved;
    toile_status (*init)(const char* library_folder);    /* [main] cheap, no device access       */
    void (*deinit)(void);                                /* [main]                               */
    uint32_t (*count)(void);                             /* [main] descriptors                   */
    const toile_descriptor* (*describe)(uint32_t index); /* [main] lives as long as the library */
    /* Null on failure. The host is not called before init of the instance.            [main] */
    toile_instance* (*create)(const toile_host*, const char* id);
} toile_entry;

#if defined(_WIN32)
#define TOILE_EXPORT __declspec(dllexport)
#else
#define TOILE_EXPORT __attribute__((visibility("default")))
#endif
#define TOILE_ENTRY_SYMBOL "toile_plugin_entry"
/* Every library defines:  extern "C" TOILE_EXPORT const toile_entry toile_plugin_entry; */

#ifdef __cplusplus
}
#endif
#endif
