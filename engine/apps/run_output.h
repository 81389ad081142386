// What a run leaves behind beside its pictures: track, progress on a terminal, report.
#pragma once

#include "apps/fitting_room.h"
#include "pipeline/run_report.h"

#include <cstdint>
#include <fstream>
#include <string>

namespace toile::apps {

/// track.jsonl in a folder, one line a frame (docs/file_formats.md); no folder, no file.
class TrackFile {
  public:
    /// \throw Error when it cannot be written
    explicit TrackFile(const std::string& folder);
    void add(const pipeline::BodyFrame& frame);
    /// Of the frames so far; 30 when there are too few to tell.
    [[nodiscard]] double frames_per_second() const;

  private:
    std::string file_;
    std::ofstream out_;
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
