// A garment's vertices and triangles, put in an order in which neighbours are close in memory.
#pragma once

#include "cloth/garment_input.h"

namespace toile::xpbd_cloth {

/// A garment whose rows follow a space-filling curve (Morton's) through its positions as bound.
struct OrderedGarment {
    /// \throw Error naming what is wrong with the garment, in its own numbers
    explicit OrderedGarment(const cloth::GarmentInput& in);
    /// The garment in its new order; views of this object.
    [[nodiscard]] const cloth::GarmentInput& input() const noexcept { return input_; }
    OrderedGarment(const OrderedGarment&) = delete;
    OrderedGarment& operator=(const OrderedGarment&) = delete;

    std::vector<std::uint32_t> vertex; ///< (nv) of the garment as given, for each row

  private:
    std::vector<Vec3f> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Vec2f> corner_coords_;
    std::vector<std::array<std::uint32_t, 2>> seams_;
    std::vector<std::array<std::uint16_t, 4>> joints_;
    std::vector<std::array<float, 4>> weights_;
    std::vector<float> attachment_;
    cloth::GarmentInput input_;
};

} // namespace toile::xpbd_cloth
