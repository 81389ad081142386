// How well a garment keeps off the body: the two figures of the run report.
//
// deep      garment vertices and triangle centres more than 2 mm inside the full body
// visible   covered body vertices that lie in front of the cloth; covered: in the rest pose the
//           outward normal meets the inside of the cloth within 10 cm
// apart     either of them within 3 cm of where the body runs into itself (an arm through the
//           torso): cloth has no room there, so these are counted by themselves
#pragma once

#include "geometry/nearest_surface.h"

#include <optional>
#include <span>
#include <vector>

namespace toile::garment {

/// One garment as it hangs. Views are borrowed for the call.
struct ClothSurface {
    std::span<const Vec3f> positions;    ///< (nv) metres
    std::span<const Triangle> triangles; ///< (nf)
};

/// One frame's contact.
struct ContactFigures {
    std::size_t samples = 0; ///< garment vertices and triangle centres
    std::size_t deep = 0;
    std::size_t deep_apart = 0;
    std::size_t vertices = 0;      ///< of the samples
    std::size_t deep_vertices = 0; ///< of `deep`
    float deepest_m = 0.0f;        ///< of the samples not apart, not negative
    std::size_t covered = 0;       ///< body vertices
    std::size_t visible = 0;
    std::size_t visible_apart = 0;

    [[nodiscard]] double deep_fraction() const { return share(deep, samples); }
    [[nodiscard]] double visible_fraction() const { return share(visible, covered); }

  private:
    [[nodiscard]] static double share(std::size_t part, std::size_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    }
};

/// Measures all garments of one person together. Not for the per-frame path: about 40 ms a frame.
class ContactMetrics {
  public:
    /// `body` (nv) and `garments` in the rest pose decide which vertices are covered.
    /// \throw Error when an index is out of range or a position is not finite
    ContactMetrics(std::span<const Vec3f> body, std::span<const Triangle> body_triangles,
                   std::span<const ClothSurface> garments);

    /// The posed body (nv) and the garments, of the same counts as at construction.
    /// \throw Error when a count differs
    [[nodiscard]] ContactFigures measure(std::span<const Vec3f> body,
                                         std::span<const ClothSurface> garments);

    /// Body vertices that a garment covers in the rest pose, ascending.
    [[nodiscard]] std::span<const std::uint32_t> covered() const { return covered_; }
    /// Those in front of the cloth at the last measure, not those apart; ascending.
    [[nodiscard]] std::span<const std::uint32_t> visible() const { return visible_; }

  private:
    void take(std::span<const Vec3f> body, std::span<const ClothSurface> garments);
    void find_buried();
    [[nodiscard]] bool is_apart(const Vec3f& point) const;
    [[nodiscard]] bool is_covered(std::uint32_t vertex) const;
    [[nodiscard]] bool is_in_front(std::uint32_t vertex) const;
    [[nodiscard]] Vec3f cloth_normal(std::uint32_t triangle) const;
    void count_deep(const Vec3f& sample, ContactFigures& figures) const;

    std::vector<Triangle> body_triangles_, cloth_triangles_;
    std::vector<Vec3f> body_, body_normals_, cloth_;
    std::vector<std::uint32_t> covered_, visible_;
    std::vector<Vec3f> buried_; ///< body vertices inside another part
    std::optional<geometry::NearestSurface> body_tree_, cloth_tree_;
};

} // namespace toile::garment
