// Where the program and its data stand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace toile {

/// The running program.
/// \throw Error when the system does not tell
std::filesystem::path program_file();

/// Folder of the running program.
std::filesystem::path program_folder();

/// Folders that hold avatars ("avatars") or garments ("garments"): those of TOILE_DATA_PATH
/// (colon-separated roots), then beside the program, then ../share/toile. Only existing ones.
std::vector<std::filesystem::path> data_folders(const std::string& kind);

} // namespace toile
