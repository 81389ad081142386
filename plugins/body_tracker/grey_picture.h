// The colour picture's brightness around the people, smoothed a little, as marks on the skin are
// looked for in it.
#pragma once

#include "imaging/camera.h"

#include <array>
#include <cstdint>
#include <vector>

namespace toile::body_tracker {

/// Of a camera whose colour picture is registered to its depth: same size, same rays.
class GreyPicture {
  public:
    /// \throw Error when the intrinsics make no sense
    explicit GreyPicture(const imaging::Intrinsics& camera);

    /// `rgba` (width * height * 4) sRGB; pixels outside `low` .. `high` (inclusive, cut to the
    /// picture) stay unknown. Null: no picture.
    void take(const std::uint8_t* rgba, std::array<int, 2> low, std::array<int, 2> high) noexcept;

    [[nodiscard]] bool empty() const noexcept { return high_[0] < low_[0]; }
    [[nodiscard]] const imaging::Intrinsics& camera() const noexcept { return camera_; }
    [[nodiscard]] int width() const noexcept { return camera_.width; }
    /// (width * height) brightness times 16, known within `low` .. `high`.
    [[nodiscard]] const std::uint16_t* values() const noexcept { return smooth_.data(); }
    [[nodiscard]] const std::array<int, 2>& low() const noexcept { return low_; }
    [[nodiscard]] const std::array<int, 2>& high() const noexcept { return high_; }

  private:
    imaging::Intrinsics camera_;
    std::vector<std::uint16_t> rows_, smooth_; ///< (width * height) smoothed along rows; both ways
    std::vector<std::uint16_t> grey_;          ///< (width) of one row
    std::array<int, 2> low_{0, 0}, high_{-1, -1};
};

} // namespace toile::body_tracker
