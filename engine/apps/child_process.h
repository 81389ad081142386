// Runs another program to its end.
#pragma once

#include <string>
#include <vector>

namespace toile::apps {

struct ChildResult {
    int status = 0; ///< exit status, or 128 + signal
    std::string out, err;
};

/// Runs `arguments` (the first is the program, looked up in PATH) with `input` on standard input.
/// \throw Error when it cannot be started, or writes more than 64 MiB
[[nodiscard]] ChildResult run_child(const std::vector<std::string>& arguments,
                                    const std::string& input);

} // namespace toile::apps
