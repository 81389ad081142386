/* toile/abi/tool.h - kind "toile.tool/1": a subcommand that a plugin adds to `toile`.
 * The host reads the options, refuses wrong ones and shows the help; the plugin does the work.
 * Global options (--seed, --threads) come with toile_limits. */
#ifndef TOILE_ABI_TOOL_H
#define TOILE_ABI_TOOL_H
#include "plugin.h"
#ifdef __cplusplus
extern "C" {
#endif

enum {
    TOILE_OPTION_INVALID = 0,
    TOILE_OPTION_TEXT = 1,
    TOILE_OPTION_REAL = 2,    /* within [minimum, maximum]                                    */
    TOILE_OPTION_INTEGER = 3, /* within [minimum, maximum]                                    */
    TOILE_OPTION_SWITCH = 4,  /* present or not, takes no value                               */
    TOILE_OPTION_PATH = 5,    /* a file or folder that exists                                 */
    TOILE_OPTION_OUTPUT = 6   /* a file or folder to write                                    */
};

enum { TOILE_OPTION_REQUIRED = 1, TOILE_OPTION_REPEATED = 2 };

/* Texts are the plugin's and stay valid while the instance lives. */
typedef struct toile_tool_option {
    uint32_t size, type;
    uint32_t flags; /* TOILE_OPTION_REQUIRED, TOILE_OPTION_REPEATED                */
    uint32_t reserved;
    const char* name;          /* "frames" for --frames                                       */
    const char* value_name;    /* "DIR", shown in the help; null: by type                     */
    const char* text;          /* one line                                                    */
    const char* default_value; /* shown in the help, null: none; the plugin applies it        */
    double minimum, maximum;
} toile_tool_option;

typedef struct toile_tool_info {
    uint32_t size, option_count;
    const char* command; /* "avatar train-parts": words after `toile`, as in plugin.json       */
    const char* summary; /* one line for --help, as in plugin.json                             */
    const char* example; /* one call                                                           */
    const toile_tool_option* options; /* (option_count), elements size apart                   */
} toile_tool_info;

#define TOILE_TOOL "toile.tool/1"
typedef struct toile_tool {
    uint32_t size, reserved;
    toile_status (*describe)(toile_instance*, toile_tool_info* out); /* [main] */
    /* argv (argc): "--name", then its value unless it is a switch, for each option that was
     * given. Results that people shall read are reported at TOILE_LOG_INFO. E_ARGUMENT: wrong
     * usage after all; CANCELLED: stopped by the job, what was finished is kept.
     * [worker & active] */
    toile_status (*run)(toile_instance*, int32_t argc, const char* const* argv, toile_job*);
} toile_tool;

#ifdef __cplusplus
}
#endif
#endif
