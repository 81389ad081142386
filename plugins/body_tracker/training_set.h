// Labelled pixels that a forest is grown on.
#pragma once

#include "body_tracker/forest.h"

namespace toile::body_tracker {

/// Kept small: depths around the person once per frame, a place and a class per pixel.
class TrainingSet {
  public:
    struct Sample {
        std::uint32_t frame = 0;
        std::uint16_t x = 0, y = 0;
        std::uint32_t label = 0; ///< class, from 0
    };

    /// Copies the part of the frame where anything is: what lies outside counts as far away just
    /// as well. Samples are pixels of the person; frame and place are made those of the copy.
    /// \throw Error when sizes or a sample do not fit
    void add(const DepthView& frame, std::span<const Sample> samples);

    [[nodiscard]] std::span<const Sample> samples() const { return samples_; }
    [[nodiscard]] DepthView frame(std::uint32_t index) const;
    [[nodiscard]] std::size_t frame_count() const { return frames_.size(); }

  private:
    struct Frame {
        int width = 0, height = 0;
        float focal_px = 0.0f;
        std::size_t first = 0;
    };
    std::vector<Frame> frames_;
    std::vector<std::uint16_t> depths_;
    std::vector<Sample> samples_;
};

} // namespace toile::body_tracker
