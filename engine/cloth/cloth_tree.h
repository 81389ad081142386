// Which vertices of a world of cloth are close to another piece of cloth.
#pragma once

#include "cloth/lanes.h"

#include <span>
#include <vector>

namespace toile::cloth {

/// A tree of boxes over groups of eight rows that follow each other, so rows that are close in
/// memory should be close along the cloth. Each box stands where its vertices are now and knows
/// where they were as bound: what lies close along the cloth is one piece and no pair. The shape of
/// the tree never changes; nothing is allocated after `arrange`.
class ClothTree {
  public:
    static constexpr std::uint32_t kNobody = 0xffffffffu;
    struct Vertex {
        Vec4f start = Vec4f::Zero(); ///< m, as bound
        float apart = 0.0f;          ///< m, nearer at the start is the same piece of cloth
        std::uint32_t part = kNobody;
    };

    /// (rows) Vertices of part kNobody are left out; each part's rows follow each other.
    void arrange(std::span<const Vertex> vertices);

    /// For each row the nearest one of another piece within `radius` metres, of equally near ones
    /// the lowest, or kNobody. (rows) each.
    void find(std::span<const Vec4f> x, float radius, std::span<std::uint32_t> nearest) noexcept;

    [[nodiscard]] bool same_piece(std::uint32_t a, std::uint32_t b) const noexcept {
        return vertices_[a].part == vertices_[b].part &&
               (vertices_[a].start - vertices_[b].start).squaredNorm() <
                   vertices_[a].apart * vertices_[a].apart;
    }

  private:
    struct Box {
        Vec4f low, high;
        void add(const Box& other) {
            low = low.cwiseMin(other.low);
            high = high.cwiseMax(other.high);
        }
    };
    struct Node {
        Box start;
        std::uint32_t part;  ///< kNobody: of more than one
        std::uint32_t right; ///< its left child follows it; 0: a leaf
        std::uint32_t leaf;
        float apart; ///< m
    };
    struct alignas(32) Leaf {
        float x[3][kLanes]; ///< m; empty places far away
        std::uint32_t first, count;
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    void refit(std::span<const Vec4f> x) noexcept;
    [[nodiscard]] bool may_touch(std::uint32_t a, std::uint32_t b, float radius) const noexcept;
    void meet(const Leaf& a, const Leaf& b, float radius2,
              std::span<std::uint32_t> nearest) noexcept;
    void note(std::uint32_t row, std::uint32_t other, float squared,
              std::span<std::uint32_t> nearest) noexcept;

    std::vector<Vertex> vertices_; ///< (rows)
    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    std::vector<Box> boxes_;   ///< of each node, now
    std::vector<float> least_; ///< (rows) m^2, to the nearest
};

} // namespace toile::cloth
