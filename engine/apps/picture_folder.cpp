#include "apps/picture_folder.h"

#include "core/error.h"
#include "core/log.h"

#include <array>
#include <cctype>
#include <cstdio>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

std::string numbered(std::uint64_t index) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%06llu.png", static_cast<unsigned long long>(index));
    return name.data();
}

bool is_numbered(const fs::path& file) {
    const std::string stem = file.stem();
    return file.extension() == ".png" && stem.size() == 6 &&
           stem.find_first_not_of("0123456789") == std::string::npos;
}

// Runs a program found on PATH; its exit status, or -1 when it cannot be started.
int run(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
        return -1;
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace

PictureFolder::PictureFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code code;
    fs::create_directories(folder_, code);
    if (code || !fs::is_directory(folder_))
        throw FileError(folder_.string(), "the folder for the pictures cannot be made");
    for (const auto& entry : fs::directory_iterator(folder_))
        if (is_numbered(entry.path())) fs::remove(entry.path());
}

void PictureFolder::add(const imaging::Image& picture) {
    imaging::save_image(picture, folder_ / numbered(count_));
    ++count_;
}

void PictureFolder::add(const imaging::IndexedImage& picture) {
    imaging::save_indexed(picture, folder_ / numbered(count_));
    ++count_;
}

bool PictureFolder::make_film(const std::string& name, double frames_per_second) const {
    if (count_ == 0) return false;
    const fs::path film = folder_ / (name + ".mp4");
    // Even sizes are what the usual players want.
    const int status = run({"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-framerate",
                            std::to_string(frames_per_second), "-i",
                            (folder_ / "%06d.png").string(), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                            "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", film.string()});
    if (status == 0) return true;
    if (status == -1 || status == 127)
        log::info("no film: ffmpeg is not installed; the pictures are in " + folder_.string());
    else
        log::warning("no film: ffmpeg failed with status " + std::to_string(status));
    return false;
}

} // namespace toile::apps
