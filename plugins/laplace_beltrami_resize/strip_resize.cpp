#include "laplace_beltrami_resize/strip_resize.h"

#include "core/error.h"
#include "laplace_beltrami_resize/trunk.h"

#include <algorithm>
#include <cmath>

namespace toile::laplace_beltrami_resize {
namespace {

constexpr float kSeam = 0.16f;      // metres beyond the region over which it falls to nothing
constexpr float kTrunkEdge = 0.05f; // metres over which arms begin to stay behind

/// How a strip changes: factors of width and depth about a middle.
struct Change {
    float width = 1.0f, depth = 1.0f, x = 0.0f, z = 0.0f;
};

/// Changes at any height, smooth: a Gaussian mean over the strips.
class Profile {
  public:
    Profile(const Trunk& subject, const Trunk& target, std::size_t count)
        : low_(subject.low()), high_(subject.high()) {
        const auto from = subject.strips(count), to = target.strips(count);
        for (std::size_t i = 0; i < count; ++i) {
            Change change{to[i].width() / from[i].width(), to[i].depth() / from[i].depth(),
                          0.5f * (from[i].left + from[i].right),
                          0.5f * (from[i].back + from[i].front)};
            // The rectangle gives the ellipse's shape, a tape its size: a section is no ellipse.
            const double girth = subject.scaled_girth(from[i].height, change.width, change.depth);
            const auto size =
                static_cast<float>(target.girth(to[i].height) / std::max(girth, 0.01));
            change.width *= size;
            change.depth *= size;
            changes_.push_back(change);
        }
        const float step = (high_ - low_) / static_cast<float>(count);
        reach_ = std::max(0.6f * step, kLeastReach);
    }

    [[nodiscard]] Change at(float height) const {
        const float y = std::clamp(height, low_, high_);
        const auto count = static_cast<float>(changes_.size());
        Change sum{0.0f, 0.0f, 0.0f, 0.0f};
        float all = 0.0f;
        for (std::size_t i = 0; i < changes_.size(); ++i) {
            const float middle = low_ + (high_ - low_) * (static_cast<float>(i) + 0.5f) / count;
            const float away = (y - middle) / reach_;
            if (std::abs(away) > 4.0f && changes_.size() > 8) continue;
            const float w = std::exp(-0.5f * away * away);
            sum.width += w * changes_[i].width;
            sum.depth += w * changes_[i].depth;
            sum.x += w * changes_[i].x;
            sum.z += w * changes_[i].z;
            all += w;
        }
        return {sum.width / all, sum.depth / all, sum.x / all, sum.z / all};
    }
    /// 1 within the region, falling to 0 beyond its ends.
    [[nodiscard]] float share(float height) const {
        const float beyond = std::max({low_ - height, height - high_, 0.0f}) / kSeam;
        if (beyond >= 1.0f) return 0.0f;
        return 1.0f - beyond * beyond * beyond * (beyond * (6.0f * beyond - 15.0f) + 10.0f);
    }

  private:
    static constexpr float kLeastReach = 0.008f; // metres
    float low_, high_, reach_ = 0.0f;
    std::vector<Change> changes_;
};

/// 1 on the trunk, 0 on what stays, going over along the surface.
std::vector<float> trunk_shares(const geometry::TriangleMesh& mesh, std::span<const float> region) {
    std::vector<float> out(region.size());
    std::transform(region.begin(), region.end(), out.begin(),
                   [](float w) { return w > 0.0f ? 1.0f : 0.0f; });
    const auto around = geometry::vertex_adjacency(mesh.positions.size(), mesh.triangles);
    double edges = 0.0;
    for (const Triangle& t : mesh.triangles)
        edges += static_cast<double>((mesh.positions[t[0]] - mesh.positions[t[1]]).norm());
    const double edge = edges / static_cast<double>(mesh.triangles.size());
    const int rounds = std::clamp(static_cast<int>(std::pow(kTrunkEdge / edge, 2.0)), 2, 200);
    std::vector<float> next(out.size());
    for (int i = 0; i < rounds; ++i) {
        for (std::size_t v = 0; v < out.size(); ++v) {
            float sum = out[v], count = 1.0f;
            for (std::uint32_t n = around.first[v]; n < around.first[v + 1]; ++n)
                sum += out[around.neighbours[n]], count += 1.0f;
            next[v] = sum / count;
        }
        out.swap(next);
    }
    return out;
}

} // namespace

std::vector<Vec3f> resize_strips(const geometry::TriangleMesh& subject,
                                 std::span<const float> region,
                                 const geometry::TriangleMesh& target,
                                 std::span<const float> target_region, std::uint32_t strips) {
    if (strips == 0 || strips > kMostStrips)
        throw Error("strips: " + std::to_string(strips) + ", 1 to " + std::to_string(kMostStrips) +
                    " are possible");
    const Trunk from(subject, region), to(target, target_region);
    const Profile profile(from, to, strips);
    const std::vector<float> shares = trunk_shares(subject, region);
    std::vector<Vec3f> out = subject.positions;
    for (std::size_t v = 0; v < out.size(); ++v) {
        Vec3f& p = out[v];
        const float share = shares[v] * profile.share(p.y());
        if (share <= 0.0f) continue;
        const Change change = profile.at(p.y());
        p.x() += share * (change.width - 1.0f) * (p.x() - change.x);
        p.z() += share * (change.depth - 1.0f) * (p.z() - change.z);
    }
    return out;
}

} // namespace toile::laplace_beltrami_resize
