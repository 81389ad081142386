#include "capture_sensor/capture_player.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::capture_sensor {

CapturePlayer::CapturePlayer(const std::filesystem::path& folder)
    : capture_(imaging::open_capture(folder)), next_(capture_.cameras.size(), 0),
      frames_(capture_.cameras.size()) {
    begin_s_ = std::numeric_limits<double>::infinity();
    for (const imaging::CaptureCamera& camera : capture_.cameras)
        if (!camera.frames.empty()) begin_s_ = std::min(begin_s_, camera.frames.front().time_s);
    if (!std::isfinite(begin_s_)) throw FileError(folder.string(), "the capture has no frames");
}

double CapturePlayer::period(std::size_t camera) const {
    constexpr double kUsual = 1.0 / 30.0;
    const auto& frames = capture_.cameras.at(camera).frames;
    std::vector<double> steps;
    for (std::size_t i = 1; i < frames.size(); ++i)
        steps.push_back(frames[i].time_s - frames[i - 1].time_s);
    if (steps.empty()) return kUsual;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

bool CapturePlayer::has_color(std::size_t camera) const {
    const auto& frames = capture_.cameras.at(camera).frames;
    return std::any_of(frames.begin(), frames.end(),
                       [](const imaging::CaptureFrame& frame) { return !frame.color.empty(); });
}

CapturePlayer::Step CapturePlayer::advance(std::size_t camera, std::optional<double> elapsed_s) {
    const imaging::CaptureCamera& from = capture_.cameras.at(camera);
    std::size_t& next = next_[camera];
    if (next >= from.frames.size()) return Step::over;
    std::size_t chosen = next;
    if (elapsed_s) {
        const auto due = [&](std::size_t i) { return from.frames[i].time_s - begin_s_; };
        if (due(chosen) > *elapsed_s) return Step::nothing_new;
        while (chosen + 1 < from.frames.size() && due(chosen + 1) <= *elapsed_s)
            ++chosen;
    }
    next = chosen + 1;
    PlayedFrame& frame = frames_[camera];
    frame.sequence = from.frames[chosen].number;
    frame.timestamp_ns =
        static_cast<std::int64_t>(std::llround(1e9 * (from.frames[chosen].time_s - begin_s_)));
    frame.depth = from.load_depth(chosen);
    frame.color = from.load_color(chosen).value_or(imaging::Image{});
    return Step::frame;
}

void CapturePlayer::rewind() noexcept {
    std::fill(next_.begin(), next_.end(), std::size_t{0});
}

} // namespace toile::capture_sensor
