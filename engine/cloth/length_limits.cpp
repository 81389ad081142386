#include "cloth/length_limits.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace toile::cloth {
namespace {

struct Neighbour {
    std::uint32_t vertex;
    float length;
};

/// Neighbours over springs in compressed rows.
struct Graph {
    std::vector<std::uint32_t> first;
    std::vector<Neighbour> neighbours;

    Graph(std::size_t vertex_count, std::span<const MaterialPath> paths)
        : first(vertex_count + 1, 0), neighbours(2 * paths.size()) {
        for (const MaterialPath& path : paths) {
            ++first[path.a + 1];
            ++first[path.b + 1];
        }
        for (std::size_t v = 0; v < vertex_count; ++v) {
            first[v + 1] += first[v];
        }
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (const MaterialPath& path : paths) {
            neighbours[next[path.a]++] = {path.b, path.length};
            neighbours[next[path.b]++] = {path.a, path.length};
        }
    }
};

/// Bounded shortest paths from one vertex; buffers are kept between calls.
class Paths {
  public:
    explicit Paths(const Graph& graph)
        : graph_(graph), distance_(graph.first.size() - 1, std::numeric_limits<float>::infinity()) {
    }

    [[nodiscard]] float distance(std::uint32_t vertex) const { return distance_[vertex]; }
    [[nodiscard]] std::span<const std::uint32_t> reached() const { return reached_; }

    void run(std::uint32_t start, float reach) {
        for (const std::uint32_t vertex : reached_) {
            distance_[vertex] = std::numeric_limits<float>::infinity();
        }
        reached_.clear();
        using Entry = std::pair<float, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        distance_[start] = 0.0f;
        reached_.push_back(start);
        open.push({0.0f, start});
        while (!open.empty()) {
            const auto [length, vertex] = open.top();
            open.pop();
            if (length > distance_[vertex]) {
                continue;
            }
            for (std::uint32_t k = graph_.first[vertex]; k < graph_.first[vertex + 1]; ++k) {
                const Neighbour& next = graph_.neighbours[k];
                const float further = length + next.length;
                if (further > reach || further >= distance_[next.vertex]) {
                    continue;
                }
                if (distance_[next.vertex] == std::numeric_limits<float>::infinity()) {
                    reached_.push_back(next.vertex);
                }
                distance_[next.vertex] = further;
                open.push({further, next.vertex});
            }
        }
        std::sort(reached_.begin(), reached_.end());
    }

  private:
    const Graph& graph_;
    std::vector<float> distance_;
    std::vector<std::uint32_t> reached_;
};

} // namespace

std::vector<LengthLimit> make_length_limits(std::size_t vertex_count,
                                            std::span<const MaterialPath> paths, float reach) {
    constexpr std::size_t kDirections = 4;
    constexpr float kNearest = 0.75f; // of the reach
    const Graph graph(vertex_count, paths);
    Paths from_start(graph);
    Paths from_chosen(graph);
    std::vector<LengthLimit> limits;
    std::vector<float> apart(vertex_count, 0.0f);
    for (std::uint32_t start = 0; start < vertex_count; ++start) {
        from_start.run(start, reach);
        for (const std::uint32_t v : from_start.reached()) {
            apart[v] = from_start.distance(v);
        }
        // Farthest first, then whatever is farthest from all chosen so far.
        for (std::size_t k = 0; k < kDirections; ++k) {
            std::uint32_t best = start;
            for (const std::uint32_t v : from_start.reached()) {
                if (from_start.distance(v) >= kNearest * reach && apart[v] > apart[best]) {
                    best = v;
                }
            }
            if (best == start || (k > 0 && apart[best] < 0.5f * reach)) {
                break;
            }
            limits.push_back(
                {std::min(start, best), std::max(start, best), from_start.distance(best)});
            from_chosen.run(best, reach);
            apart[best] = 0.0f;
            for (const std::uint32_t v : from_start.reached()) {
                apart[v] = std::min(apart[v], from_chosen.distance(v));
            }
        }
        for (const std::uint32_t v : from_start.reached()) {
            apart[v] = 0.0f;
        }
    }
    std::sort(limits.begin(), limits.end(), [](const LengthLimit& l, const LengthLimit& r) {
        return l.a != r.a ? l.a < r.a : l.b < r.b;
    });
    const auto same = [](const LengthLimit& l, const LengthLimit& r) {
        return l.a == r.a && l.b == r.b;
    };
    limits.erase(std::unique(limits.begin(), limits.end(), same), limits.end());
    return limits;
}

} // namespace toile::cloth
