// On a live clock resolution goes down before frames are dropped.
#pragma once

#include <cstdint>

namespace toile::apps::kiosk {

struct PictureScaleOptions {
    double budget_s = 1.0 / 20.0; ///< a frame, wall
    float least = 0.4f;
    std::uint32_t after = 6;  ///< frames over the budget in a row: one step down
    std::uint32_t calm = 150; ///< frames with room to spare in a row: one step up
};

/// Share of the full resolution that is drawn, in steps of a fifth or so.
class PictureScale {
  public:
    explicit PictureScale(float most, const PictureScaleOptions& options = {})
        : options_(options), most_(most), now_(most) {}

    /// A frame took so long. The scale that the next one is drawn in.
    float add(double frame_s);
    [[nodiscard]] float now() const { return now_; }

  private:
    PictureScaleOptions options_;
    float most_;
    float now_;
    std::uint32_t over_ = 0;
    std::uint32_t under_ = 0;
};

} // namespace toile::apps::kiosk
