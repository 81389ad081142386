// What the forest says of one person's cells, and how well a drawn pose agrees with it: depth alone
// cannot tell front from back or one hand from the other as well.
#pragma once

#include "body_tracker/forest.h"
#include "body_tracker/parts_labels.h"
#include "body_tracker/registration.h"

namespace toile::body_tracker {

/// Keeps its work space; allocates only when made. Without a forest everything agrees alike.
class PartsView {
  public:
    /// `forest` (of kPartCount classes, or null) must outlive it.
    PartsView(const Forest* forest, const TrackedBody& body, const GridCamera& camera);

    [[nodiscard]] bool useful() const noexcept { return forest_ != nullptr; }
    /// Asks the forest for every other cell of the person.
    void look(const SeenPerson& seen) noexcept;
    /// Mean probability, over the cells last looked at, of the part that is drawn there; in [0, 1].
    [[nodiscard]] float support(const Drawing& drawing) const noexcept;

  private:
    struct Cell {
        std::uint32_t index;
        std::array<std::uint8_t, kPartCount> share; ///< 255: certain
    };
    const Forest* forest_;
    std::vector<std::uint8_t> parts_; ///< (triangles) PartLabel - 1
    std::vector<std::uint16_t> mm_;   ///< (cells of the grid)
    std::vector<Cell> cells_;
};

} // namespace toile::body_tracker
