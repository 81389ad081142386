/* Libraries that are wrong before any of their code could run; ENTRY_VARIANT picks one. */
#include "abi/plugin.h"

#if ENTRY_VARIANT == 1 /* no entry at all */
TOILE_EXPORT const int something_else = 1;
#elif ENTRY_VARIANT == 2 /* the entry is a function */
TOILE_EXPORT int toile_plugin_entry(void) {
    return 1;
}
#elif ENTRY_VARIANT == 3 /* the symbol is shorter than it claims */
TOILE_EXPORT const uint32_t toile_plugin_entry[2] = {sizeof(toile_entry), TOILE_ABI_MAJOR};
#elif ENTRY_VARIANT == 4 /* needs a symbol that nobody has */
extern toile_status zoo_symbol_that_nobody_defines(const char* folder);
TOILE_EXPORT const toile_entry toile_plugin_entry = {sizeof(toile_entry),
                                                     TOILE_ABI_MAJOR,
                                                     TOILE_ABI_MINOR,
                                                     0,
                                                     zoo_symbol_that_nobody_defines,
                                                     0,
                                                     0,
                                                     0,
                                                     0};
#endif
