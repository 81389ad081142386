// Cloth against cloth, within a garment and between garments: each vertex and the nearest triangle
// of another sheet, or of a part of its own that is far away along the cloth.
#pragma once

#include "cloth/cloth_tree.h"

namespace toile::cloth {

/// One garment among the rows of a world of cloth. Views are borrowed for the call.
struct ClothPart {
    std::size_t first = 0;               ///< of its rows
    std::span<const Vec3f> start;        ///< (nv) as bound: tells what is far along the cloth
    std::span<const Triangle> triangles; ///< (nf)
    std::span<const float> inverse_mass; ///< (nv) 1/kg, 0 = held
    unsigned layer = 0;
    float mean_edge = 0.0f; ///< m
    float thickness = 0.0f; ///< m
    float friction = 0.0f;  ///< Coulomb
};

/// Vertex against triangle, both ways round; edges that cross without a vertex near are not seen.
/// A vertex stays on the side of a sheet from which it came near; between layers the outer one
/// belongs outside. Where a vertex and most of its neighbours disagree about the side, the cloth is
/// tangled there, and the vertex goes where they are. Nothing is allocated after `arrange`.
class ClothContacts {
  public:
    /// The garments of a world of `rows` rows.
    void arrange(std::span<const ClothPart> parts, std::size_t rows);
    /// Forgets who is near whom.
    void reset() noexcept;

    /// Finds who is near or, at velocity v, will be within `seconds`; (rows) each.
    void find(std::span<const Vec4f> x, std::span<const Vec4f> v, float seconds) noexcept;
    /// Keeps them apart, with friction against the motion since q; (rows) each. What parts them is
    /// no reason to fly off: it is taken from q too. Who is deeper than the reach is let pass.
    void resolve(std::span<Vec4f> x, std::span<Vec4f> q) const noexcept;

    [[nodiscard]] std::size_t contact_count() const noexcept { return contacts_.size(); }

  private:
    static constexpr std::uint32_t kNobody = ClothTree::kNobody;
    struct Vertex {
        Vec3f start = Vec3f::Zero();
        float weight = 0.0f; ///< 1/kg
        float apart = 0.0f;  ///< m, nearer at the start is the same piece of cloth
        std::uint32_t part = kNobody;
    };
    struct Contact {
        std::uint32_t vertex, corner[3];
        float share[3];            ///< barycentric
        float side, gap, friction; ///< +1 over the triangle, -1 beneath; m; Coulomb
    };

    [[nodiscard]] bool same_sheet(std::span<const Vec4f> x, std::uint32_t first,
                                  std::uint32_t second) const noexcept;
    void meet(std::span<const Vec4f> x, std::uint32_t vertex, std::uint32_t other,
              float reach) noexcept;
    void untangle() noexcept;
    [[nodiscard]] bool same_piece(const Vertex& a, const Vertex& b) const noexcept {
        return a.part == b.part && (a.start - b.start).squaredNorm() < a.apart * a.apart;
    }

    std::vector<ClothPart> parts_;                 ///< their views are not used after arrange
    std::vector<Vertex> vertices_;                 ///< (rows)
    std::vector<Triangle> triangles_;              ///< of all parts, by rows
    std::vector<std::uint32_t> star_first_, star_; ///< triangles at each row
    std::vector<std::uint32_t> met_;               ///< (rows) triangle met, or kNobody
    std::vector<float> side_;                      ///< (rows) of that triangle; 0: none
    ClothTree tree_;
    std::vector<std::uint32_t> nearest_; ///< (rows) vertex of another piece, or kNobody
    std::vector<Contact> contacts_;      ///< capacity (rows)
    float reach_ = 0.0f;                 ///< m, between surfaces
    float radius_ = 0.0f;                ///< m, between vertices
};

} // namespace toile::cloth
