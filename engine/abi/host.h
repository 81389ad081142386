/* toile/abi/host.h - what the host offers to a plugin instance. */
#ifndef TOILE_ABI_HOST_H
#define TOILE_ABI_HOST_H
#include "base.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {
    TOILE_LOG_INVALID = 0,
    TOILE_LOG_DEBUG = 1,
    TOILE_LOG_INFO = 2,
    TOILE_LOG_WARNING = 3,
    TOILE_LOG_ERROR = 4,
    TOILE_LOG_HOST_BUG = 5,
    TOILE_LOG_PLUGIN_BUG = 6
};

/* Outlives every instance made with it. */
typedef struct toile_host {
    uint32_t size, abi_minor;
    void* host_data;
    const char* host_version; /* semver of the engine                                     */
    /* Null when the host lacks it. Ids carry a revision: "toile.thread_pool/1".    [any] */
    const void* (*get_extension)(const struct toile_host*, const char* id);
    /* Copies text before it returns; the only channel for error text.              [any] */
    void (*report)(const struct toile_host*, int32_t level, toile_status code, const char* text);
} toile_host;

/* The host's pool: plugins start no threads of their own for computing. */
#define TOILE_THREAD_POOL "toile.thread_pool/1"
typedef struct toile_thread_pool {
    uint32_t size, reserved;
    uint32_t (*thread_count)(const toile_host*); /* [any] at least 1                       */
    /* Calls body(user, begin, end) over disjoint ranges that cover [0, count) and returns when
     * all are done. Ranges depend on count and grain only, never on the thread count, so that
     * results can be deterministic. body must not throw.                          [any] */
    void (*parallel_for)(const toile_host*, uint32_t count, uint32_t grain, void* user,
                         void (*body)(void* user, uint32_t begin, uint32_t end));
} toile_thread_pool;

#ifdef __cplusplus
}
#endif
#endif
