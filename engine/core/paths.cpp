#include "core/paths.h"

#include "core/error.h"

#include <cstdlib>
#include <sstream>

namespace toile {

std::filesystem::path program_file() {
    std::error_code code;
    auto program = std::filesystem::read_symlink("/proc/self/exe", code);
    if (code) throw Error("/proc/self/exe: cannot be read: " + code.message());
    return program;
}

std::filesystem::path program_folder() {
    std::error_code code;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", code);
    return code ? std::filesystem::current_path() : program.parent_path();
}

std::vector<std::filesystem::path> data_folders(const std::string& kind) {
    std::vector<std::filesystem::path> roots;
    if (const char* list = std::getenv("TOILE_DATA_PATH")) {
        std::istringstream in(list);
        for (std::string root; std::getline(in, root, ':');)
            if (!root.empty()) roots.emplace_back(root);
    }
    roots.push_back(program_folder());
    roots.push_back(program_folder() / ".." / "share" / "toile");
    std::vector<std::filesystem::path> out;
    for (const auto& root : roots) {
        std::error_code code;
        if (std::filesystem::is_directory(root / kind, code)) out.push_back(root / kind);
    }
    return out;
}

} // namespace toile
