// Which of P4's 12 body parts each pixel of the frame last followed shows: of somebody tracked the
// part of the body drawn there, else what the forest says. Made when somebody asks for the first
// time.
#pragma once

#include "body_tracker/body_tracking.h"
#include "body_tracker/parts_labels.h"

namespace toile::body_tracker {

class PartPainter {
  public:
    /// `forest` may be null: then only the body tells. Both must outlive it.
    /// \throw Error when the intrinsics make no sense
    PartPainter(const TrackedBody& body, const Forest* forest, const imaging::Intrinsics& camera);

    /// `metres` (width * height): the frame that `tracking` had last. `parts` and `people` (the
    /// same; `people` may be empty) are filled whole: body::Part, and n for the n-th active person,
    /// from 1; both 0 where nobody is. Allocates nothing.
    void paint(const BodyTracking& tracking, std::span<const float> metres,
               std::span<std::uint8_t> parts, std::span<std::uint8_t> people) noexcept;

  private:
    void label_cells(const DepthGrid& grid, const PersonTrack& person,
                     std::uint8_t number) noexcept;
    [[nodiscard]] std::uint8_t drawn_part(const DepthGrid& grid, const Drawing& drawing,
                                          int cell) const noexcept;
    [[nodiscard]] std::uint8_t forest_part(const GridCamera& camera, int cell) noexcept;

    const Forest* forest_;
    std::vector<std::uint8_t> triangle_part_; ///< (triangles) body::Part
    std::vector<std::int32_t> cell_of_;       ///< (pixels) or -1
    std::vector<std::uint8_t> part_, person_; ///< (cells)
    std::vector<std::uint16_t> mm_;           ///< (cells) one person's, as the forest takes them
};

} // namespace toile::body_tracker
