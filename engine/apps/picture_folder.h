// Numbered pictures in a folder, and a film of them where ffmpeg is installed.
#pragma once

#include "imaging/image.h"
#include "imaging/indexed_image.h"

#include <cstdint>
#include <filesystem>

namespace toile::apps {

class PictureFolder {
  public:
    /// Makes the folder; numbered pictures of an earlier run in it are removed, so that no two runs
    /// mix. \throw Error when it cannot be made
    explicit PictureFolder(std::filesystem::path folder);

    /// Writes 000000.png, 000001.png ... \throw Error
    void add(const imaging::Image& picture);
    void add(const imaging::IndexedImage& picture);

    [[nodiscard]] std::uint64_t count() const { return count_; }
    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

    /// Writes `name`.mp4 beside the pictures; false, with a note in the log, when ffmpeg is missing
    /// or fails.
    bool make_film(const std::string& name, double frames_per_second) const;

  private:
    std::filesystem::path folder_;
    std::uint64_t count_ = 0;
};

} // namespace toile::apps
