#include "geometry/cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

namespace toile::geometry {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr float kLeastShare = 0.01f; // cuts nearer to an end than this would leave slivers

class Cutter {
  public:
    Cutter(const TriangleMesh& mesh, std::span<const float> field)
        : mesh_(mesh), field_(field), place_(mesh.positions.size(), kNone) {}

    CutMesh run() {
        for (const Triangle& t : mesh_.triangles) {
            std::array<std::uint32_t, 4> ring{};
            std::size_t count = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                if (inside(a)) ring[count++] = kept(a);
                if (inside(a) != inside(b)) ring[count++] = between(a, b);
            }
            for (std::size_t k = 2; k < count; ++k)
                if (ring[0] != ring[k - 1] && ring[k - 1] != ring[k] && ring[k] != ring[0])
                    out_.mesh.triangles.push_back({ring[0], ring[k - 1], ring[k]});
        }
        return std::move(out_);
    }

  private:
    [[nodiscard]] bool inside(std::uint32_t v) const { return field_[v] >= 0.0f; }

    std::uint32_t add(const CutVertex& from) {
        out_.from.push_back(from);
        out_.mesh.positions.push_back((1.0f - from.share) * mesh_.positions[from.a] +
                                      from.share * mesh_.positions[from.b]);
        return static_cast<std::uint32_t>(out_.from.size() - 1);
    }
    std::uint32_t kept(std::uint32_t v) {
        if (place_[v] == kNone) place_[v] = add({v, v, 0.0f});
        return place_[v];
    }
    std::uint32_t between(std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        const auto [at, added] = edges_.try_emplace({a, b}, 0);
        if (added) {
            const float share = field_[a] / (field_[a] - field_[b]);
            at->second = add({a, b, std::clamp(share, kLeastShare, 1.0f - kLeastShare)});
        }
        return at->second;
    }

    const TriangleMesh& mesh_;
    std::span<const float> field_;
    std::vector<std::uint32_t> place_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;
    CutMesh out_;
};

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

void keep_largest(CutMesh& cut) {
    std::vector<std::uint32_t> parent(cut.from.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (const Triangle& t : cut.mesh.triangles)
        for (std::size_t k = 1; k < 3; ++k) {
            const auto a = root(parent, t[0]), b = root(parent, t[k]);
            parent[std::max(a, b)] = std::min(a, b);
        }
    std::vector<std::size_t> sizes(parent.size(), 0);
    for (const Triangle& t : cut.mesh.triangles)
        ++sizes[root(parent, t[0])];
    if (sizes.empty()) return;
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    CutMesh out;
    std::vector<std::uint32_t> place(parent.size(), kNone);
    for (std::uint32_t v = 0; v < parent.size(); ++v) {
        if (root(parent, v) != largest) continue;
        place[v] = static_cast<std::uint32_t>(out.from.size());
        out.from.push_back(cut.from[v]);
        out.mesh.positions.push_back(cut.mesh.positions[v]);
    }
    for (const Triangle& t : cut.mesh.triangles)
        if (place[t[0]] != kNone)
            out.mesh.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    cut = std::move(out);
}

double angle_of(const Vec3f& p, const Vec3f& middle) {
    return std::atan2(static_cast<double>(p.x() - middle.x()),
                      static_cast<double>(p.z() - middle.z()));
}

/// Starts at the lowest angle and runs towards higher ones.
std::vector<std::pair<double, std::uint32_t>> around(std::span<const Vec3f> positions,
                                                     const std::vector<std::uint32_t>& ring,
                                                     const Vec3f& middle) {
    std::vector<std::pair<double, std::uint32_t>> out;
    double turned = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const double a = angle_of(positions[ring[i]], middle);
        const double b = angle_of(positions[ring[(i + 1) % ring.size()]], middle);
        turned += std::remainder(b - a, 2.0 * std::numbers::pi);
        out.emplace_back(a, ring[i]);
    }
    if (turned < 0.0) std::reverse(out.begin(), out.end());
    std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
    for (std::size_t i = 1; i < out.size(); ++i) // folds of the rim do not run back
        out[i].first = std::max(out[i].first, out[i - 1].first);
    return out;
}

} // namespace

CutMesh cut_where(const TriangleMesh& mesh, std::span<const float> field, bool largest_only) {
    CutMesh out = Cutter(mesh, field).run();
    if (largest_only) keep_largest(out);
    return out;
}

std::vector<std::vector<std::uint32_t>> rims(const TriangleMesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            sides.emplace(t[k], t[(k + 1) % 3]);
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [a, b] : sides)
        if (!sides.contains({b, a})) next[b] = a;
    std::vector<std::vector<std::uint32_t>> out;
    while (!next.empty()) {
        auto& ring = out.emplace_back();
        for (auto at = next.begin(); at != next.end();) {
            ring.push_back(at->first);
            const std::uint32_t to = at->second;
            next.erase(at);
            at = next.find(to);
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return out;
}

std::vector<Triangle> sew_rims(std::span<const Vec3f> positions, std::vector<std::uint32_t> lower,
                               std::vector<std::uint32_t> upper, const Vec3f& middle) {
    std::vector<Triangle> out;
    if (lower.size() < 3 || upper.size() < 3) return out;
    const auto a = around(positions, lower, middle), b = around(positions, upper, middle);
    const auto at = [](const auto& ring, std::size_t i) {
        const double turn = i >= ring.size() ? 2.0 * std::numbers::pi : 0.0;
        return ring[i % ring.size()].first + turn;
    };
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
        const bool low = j >= b.size() || (i < a.size() && at(a, i + 1) <= at(b, j + 1));
        const std::uint32_t x = a[i % a.size()].second, y = b[j % b.size()].second;
        // Angles rise from +Z towards +X: seen from above against the clock, the axis on the left.
        if (low)
            out.push_back({x, a[++i % a.size()].second, y});
        else
            out.push_back({x, b[++j % b.size()].second, y});
    }
    return out;
}

} // namespace toile::geometry
