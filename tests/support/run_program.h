// Runs the built `toile` (or another program) as a user does.
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <sys/wait.h>
#include <vector>

namespace toile::test {

struct ProgramResult {
    int status = -1;    ///< exit status, 128 + signal when it was killed
    std::string output; ///< standard output and error together
};

/// `words` are passed as they are, each quoted for the shell.
inline ProgramResult run_program(const std::vector<std::string>& words,
                                 const std::string& environment = "") {
    std::string line = environment;
    for (const std::string& word : words) {
        line += " '";
        for (const char c : word)
            line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += "'";
    }
    ProgramResult result;
    FILE* pipe = popen((line + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return result;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        result.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

inline std::string toile_program() {
    return std::string(TOILE_BINARY_DIR) + "/bin/toile";
}

/// `toile` with these words.
inline ProgramResult run_toile(std::vector<std::string> words,
                               const std::string& environment = "") {
    words.insert(words.begin(), toile_program());
    return run_program(words, environment);
}

} // namespace toile::test
