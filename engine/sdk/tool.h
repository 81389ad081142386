// Kind toile.tool/1 (draft) for a class P with
//     toile_tool_info describe();                                                        // [main]
//     int run(std::span<const char* const> arguments, Job job); // exit status 0, 1, 2    [worker]
#pragma once

#include "abi/tool.h"
#include "sdk/guard.h"
#include "sdk/job.h"
#include "sdk/structs.h"

#include <span>

namespace toile::sdk {

struct Tool {
    static constexpr const char* id = TOILE_TOOL;

    template <class P>
    static toile_status describe(toile_instance* instance, toile_tool_info* out) noexcept {
        return guarded<P>(instance, [&](P& p) { write_struct(out, p.describe(), "out"); });
    }
    template <class P>
    static toile_status run(toile_instance* instance, std::int32_t argc, const char* const* argv,
                            toile_job* job, std::int32_t* exit_status) noexcept {
        return guarded<P>(instance, [&](P& p) {
            if (exit_status == nullptr) throw bad_argument("exit_status: null");
            if (argc < 0 || (argc > 0 && argv == nullptr)) throw bad_argument("argv: null");
            *exit_status = p.run({argv, static_cast<std::size_t>(argc)}, Job(job));
        });
    }
    template <class P>
    static constexpr toile_tool table{sizeof(toile_tool), 0, &describe<P>, &run<P>};
};

} // namespace toile::sdk
