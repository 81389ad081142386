// The last look of a frame: body vertices that look through between a garment's samples.
#pragma once

#include "cloth/body_contacts.h"

namespace toile::cloth {

/// Pairs of a garment triangle and a body vertex under it.
class SkinCover {
  public:
    /// Of a triangle: the corners of three body triangles, or of one and those across its sides.
    static constexpr std::size_t kMostSkin = 9;

    /// Capacity for a garment of so many triangles.
    explicit SkinCover(std::size_t triangle_count) { pairs_.reserve(kMostSkin * triangle_count); }

    /// Collects the pairs that are close or worse, from the places found by the contacts.
    /// `close` (m): cloth further out than this stays there.
    void find(const MovingBody& body, const BodyContacts& contacts, std::span<const Vec4> x,
              float close = 0.008f) noexcept;
    /// Lifts the triangles of those pairs over their body vertices, along the skin's normals.
    void lift(const MovingBody& body, std::span<const Triangle> triangles, std::span<Vec4> x,
              std::span<const float> inverse_mass) const noexcept;

  private:
    struct Pair {
        std::uint32_t triangle, skin;
    };
    std::vector<Pair> pairs_;
};

} // namespace toile::cloth
