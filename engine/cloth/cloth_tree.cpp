#include "cloth/cloth_tree.h"

#include <algorithm>
#include <array>
#include <bit>

namespace toile::cloth {
namespace {

constexpr float kFarAway = 1e9f; // m

} // namespace

void ClothTree::arrange(std::span<const Vertex> vertices) {
    vertices_.assign(vertices.begin(), vertices.end());
    least_.assign(vertices.size(), 0.0f);
    leaves_.clear();
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        if (vertices[v].part == kNobody) {
            continue;
        }
        const bool goes_on = !leaves_.empty() && leaves_.back().count < kLanes &&
                             leaves_.back().first + leaves_.back().count == v &&
                             vertices[leaves_.back().first].part == vertices[v].part;
        if (!goes_on) {
            leaves_.push_back({{}, v, 0});
        }
        ++leaves_.back().count;
    }
    nodes_.clear();
    if (!leaves_.empty()) {
        build(0, static_cast<std::uint32_t>(leaves_.size()));
    }
    boxes_.resize(nodes_.size());
}

/// The node over some leaves, and all beneath it. \return its number
std::uint32_t ClothTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    if (end - begin == 1) {
        const Leaf& leaf = leaves_[begin];
        const Vertex& first = vertices_[leaf.first];
        Node made{{first.start, first.start}, first.part, 0, begin, first.apart};
        for (std::uint32_t v = leaf.first; v < leaf.first + leaf.count; ++v) {
            made.start.add({vertices_[v].start, vertices_[v].start});
        }
        nodes_[node] = made;
        return node;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    const std::uint32_t left = build(begin, middle);
    const std::uint32_t right = build(middle, end);
    Node made = nodes_[left];
    made.start.add(nodes_[right].start);
    made.part = made.part == nodes_[right].part ? made.part : kNobody;
    made.right = right;
    nodes_[node] = made;
    return node;
}

void ClothTree::refit(std::span<const Vec4f> x) noexcept {
    for (std::size_t n = nodes_.size(); n-- > 0;) { // children stand after their parents
        if (nodes_[n].right != 0) {
            boxes_[n] = boxes_[n + 1];
            boxes_[n].add(boxes_[nodes_[n].right]);
            continue;
        }
        Leaf& leaf = leaves_[nodes_[n].leaf];
        boxes_[n] = {x[leaf.first], x[leaf.first]};
        for (std::uint32_t l = 0; l < kLanes; ++l) {
            const bool empty = l >= leaf.count;
            const Vec4f p = empty ? Vec4f(Vec4f::Constant(kFarAway)) : x[leaf.first + l];
            for (int k = 0; k < 3; ++k) {
                leaf.x[k][l] = p[k];
            }
            if (!empty) {
                boxes_[n].add({p, p});
            }
        }
    }
}

bool ClothTree::may_touch(std::uint32_t a, std::uint32_t b, float radius) const noexcept {
    const Vec4f gap = (boxes_[a].low - boxes_[b].high).cwiseMax(boxes_[b].low - boxes_[a].high);
    if (gap.head<3>().maxCoeff() > radius) {
        return false;
    }
    const Node& p = nodes_[a];
    const Node& q = nodes_[b];
    if (p.part != q.part || p.part == kNobody) {
        return true;
    }
    const Vec4f farthest = (p.start.high - q.start.low).cwiseMax(q.start.high - p.start.low);
    return farthest.squaredNorm() >= p.apart * p.apart;
}

void ClothTree::note(std::uint32_t row, std::uint32_t other, float squared,
                     std::span<std::uint32_t> nearest) noexcept {
    if (squared < least_[row] || (squared == least_[row] && other < nearest[row])) {
        least_[row] = squared;
        nearest[row] = other;
    }
}

void ClothTree::meet(const Leaf& a, const Leaf& b, float radius2,
                     std::span<std::uint32_t> nearest) noexcept {
    const Lanes3 theirs{load(b.x[0]), load(b.x[1]), load(b.x[2])};
    for (std::uint32_t l = 0; l < a.count; ++l) {
        const Lanes3 mine{_mm256_set1_ps(a.x[0][l]), _mm256_set1_ps(a.x[1][l]),
                          _mm256_set1_ps(a.x[2][l])};
        const Lanes3 between = theirs - mine;
        alignas(32) float squared[kLanes];
        const __m256 all = dot(between, between);
        _mm256_store_ps(squared, all);
        auto hits = static_cast<unsigned>(
            _mm256_movemask_ps(_mm256_cmp_ps(all, _mm256_set1_ps(radius2), _CMP_LT_OQ)));
        const std::uint32_t row = a.first + l;
        for (; hits != 0; hits &= hits - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(hits));
            const std::uint32_t other = b.first + lane;
            if (!same_piece(row, other)) {
                note(row, other, squared[lane], nearest);
                note(other, row, squared[lane], nearest);
            }
        }
    }
}

void ClothTree::find(std::span<const Vec4f> x, float radius,
                     std::span<std::uint32_t> nearest) noexcept {
    std::fill(nearest.begin(), nearest.end(), kNobody);
    std::fill(least_.begin(), least_.end(), radius * radius);
    if (nodes_.empty()) {
        return;
    }
    refit(x);
    // Pairs to look at; a level adds three at most, and there are at most 32 on either side.
    std::array<std::array<std::uint32_t, 2>, 256> open;
    std::size_t count = 0;
    open[count++] = {0, 0};
    while (count > 0) {
        const auto [a, b] = open[--count];
        if (!may_touch(a, b, radius)) {
            continue;
        }
        const std::uint32_t right_a = nodes_[a].right;
        const std::uint32_t right_b = nodes_[b].right;
        if (right_a == 0 && right_b == 0) {
            meet(leaves_[nodes_[a].leaf], leaves_[nodes_[b].leaf], radius * radius, nearest);
        } else if (a == b) {
            open[count++] = {a + 1, a + 1};
            open[count++] = {right_a, right_a};
            open[count++] = {a + 1, right_a};
        } else if (right_b == 0 || (right_a != 0 && right_a - a >= right_b - b)) {
            open[count++] = {a + 1, b};
            open[count++] = {right_a, b};
        } else {
            open[count++] = {a, b + 1};
            open[count++] = {a, right_b};
        }
    }
}

} // namespace toile::cloth
