// A capture folder being played: which frame is next, in lock-step or by the clock.
#pragma once

#include "imaging/capture_folder.h"

#include <optional>
#include <vector>

namespace toile::capture_sensor {

/// One frame of one camera.
struct PlayedFrame {
    std::uint32_t sequence = 0;
    std::int64_t timestamp_ns = 0; ///< from the earliest first frame of all cameras
    imaging::DepthImage depth;
    imaging::Image color; ///< empty: none
};

class CapturePlayer {
  public:
    /// \throw Error naming the file and what is wrong with it; also when no camera has a frame
    explicit CapturePlayer(const std::filesystem::path& folder);

    [[nodiscard]] const imaging::Capture& capture() const noexcept { return capture_; }
    /// Median time between frames of a camera, seconds.
    [[nodiscard]] double period(std::size_t camera) const;
    [[nodiscard]] bool has_color(std::size_t camera) const;

    enum class Step : std::uint8_t { invalid, frame, nothing_new, over };

    /// Loads the next frame of a camera into `frame`. `elapsed_s`: time since the playing began;
    /// then the newest frame that is due is taken. Without it every frame comes in turn.
    /// \throw Error when a picture cannot be read; the frame counts as played
    Step advance(std::size_t camera, std::optional<double> elapsed_s = std::nullopt);
    /// Of the last step that gave one.
    [[nodiscard]] const PlayedFrame& frame(std::size_t camera) const { return frames_.at(camera); }
    /// Back to the beginning.
    void rewind() noexcept;

  private:
    imaging::Capture capture_;
    double begin_s_ = 0.0;
    std::vector<std::size_t> next_;
    std::vector<PlayedFrame> frames_;
};

} // namespace toile::capture_sensor
