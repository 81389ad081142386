// What a run leaves behind beside its pictures: track, progress on a terminal, report.
#pragma once

#include "apps/fitting_room.h"
#include "pipeline/run_report.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

namespace toile::apps {

/// A track, one line a frame (docs/file_formats.md), written out after each.
class TrackFile {
  public:
    /// track.jsonl in a folder; no folder, no file. \throw Error when it cannot be written
    explicit TrackFile(const std::string& folder);
    /// A file of that name; its folder is made. \throw Error
    [[nodiscard]] static TrackFile named(const std::filesystem::path& file);

    /// \throw Error when it cannot be written
    void add(const pipeline::BodyFrame& frame);
    /// Everybody in a frame; frames that a source left out leave a gap in the numbers.
    void add(std::uint32_t sequence, std::int64_t timestamp_ns,
             std::span<const pipeline::BodyFrame> people);
    /// Of the frames so far; 30 when there are too few to tell.
    [[nodiscard]] double frames_per_second() const;

  private:
    TrackFile() = default;
    void open(const std::filesystem::path& file);
    void write(std::uint64_t number, std::int64_t timestamp_ns,
               std::span<const pipeline::BodyFrame> people);

    std::string file_;
    std::ofstream out_;
    std::uint32_t first_sequence_ = 0;
    std::uint64_t frames_ = 0;
    std::int64_t first_ns_ = 0;
    std::int64_t last_ns_ = 0;
};

/// A line that counts frames, on a terminal only.
class RunProgress {
  public:
    RunProgress();
    ~RunProgress();
    RunProgress(const RunProgress&) = delete;
    RunProgress& operator=(const RunProgress&) = delete;
    void frame();

  private:
    bool terminal_;
    std::uint64_t frames_ = 0;
};

/// Prints the table of stages, and writes the report file when one is asked for. \throw Error
void put_out_report(pipeline::RunReport report, FittingRoom& room, const std::string& file);

} // namespace toile::apps
