/* toile/abi/tool.h - kind "toile.tool/1": a subcommand that a plugin adds to `toile`.  DRAFT. */
#ifndef TOILE_ABI_TOOL_H
#define TOILE_ABI_TOOL_H
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct toile_tool_info {
    uint32_t size, reserved;
    const char* command; /* "avatar train-parts": words after `toile`                         */
    const char* summary; /* one line for --help                                               */
    const char* example; /* one call                                                          */
} toile_tool_info;

#define TOILE_TOOL "toile.tool/1"
typedef struct toile_tool {
    uint32_t size, reserved;
    toile_status (*describe)(toile_instance*, toile_tool_info* out); /* [main] */
    /* argv without the command's own words. *exit_status: 0 done, 1 failed, 2 usage. [worker] */
    toile_status (*run)(toile_instance*, int32_t argc, const char* const* argv, toile_job*,
                        int32_t* exit_status);
} toile_tool;

#ifdef __cplusplus
}
#endif
#endif
