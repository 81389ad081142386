#include "garment/contact_metrics.h"

#include "core/error.h"
#include "geometry/mesh.h"

#include <algorithm>

namespace toile::garment {
namespace {

constexpr float kDeep = 0.002f;    // m
constexpr float kCovered = 0.1f;   // m, along the outward normal
constexpr float kInFront = 0.03f;  // m, cloth further behind a vertex is not its own
constexpr float kApart = 0.03f;    // m, from a buried body vertex
constexpr float kFarthest = 0.25f; // m, from the body; further out nothing is deep

} // namespace

ContactMetrics::ContactMetrics(std::span<const Vec3f> body,
                               std::span<const Triangle> body_triangles,
                               std::span<const ClothSurface> garments)
    : body_triangles_(body_triangles.begin(), body_triangles.end()),
      body_(body.begin(), body.end()), body_normals_(body.size()) {
    std::uint32_t base = 0;
    for (const ClothSurface& garment : garments) {
        for (const Triangle& t : garment.triangles) {
            if (*std::max_element(t.begin(), t.end()) >= garment.positions.size()) {
                throw Error("contact metrics: a garment triangle names a vertex out of range");
            }
            cloth_triangles_.push_back({t[0] + base, t[1] + base, t[2] + base});
        }
        cloth_.insert(cloth_.end(), garment.positions.begin(), garment.positions.end());
        base += static_cast<std::uint32_t>(garment.positions.size());
    }
    body_tree_.emplace(body_, body_triangles_);
    if (!cloth_triangles_.empty()) {
        cloth_tree_.emplace(cloth_, cloth_triangles_);
    }
    geometry::vertex_normals(body_, body_triangles_, body_normals_);
    for (std::uint32_t v = 0; v < body_.size(); ++v) {
        if (is_covered(v)) {
            covered_.push_back(v);
        }
    }
}

void ContactMetrics::take(std::span<const Vec3f> body, std::span<const ClothSurface> garments) {
    std::size_t count = 0;
    for (const ClothSurface& garment : garments) {
        count += garment.positions.size();
    }
    if (body.size() != body_.size() || count != cloth_.size()) {
        throw Error("contact metrics: " + std::to_string(body.size()) + " body and " +
                    std::to_string(count) + " garment vertices, " + std::to_string(body_.size()) +
                    " and " + std::to_string(cloth_.size()) + " wanted");
    }
    std::copy(body.begin(), body.end(), body_.begin());
    auto next = cloth_.begin();
    for (const ClothSurface& garment : garments) {
        next = std::copy(garment.positions.begin(), garment.positions.end(), next);
    }
    geometry::vertex_normals(body_, body_triangles_, body_normals_);
    body_tree_->refit(body_);
    if (cloth_tree_) {
        cloth_tree_->refit(cloth_);
    }
}

/// A vertex is buried when a point just outside it is still inside the body: going outwards, the
/// surface is left more often than it is entered.
void ContactMetrics::find_buried() {
    constexpr float kJustOutside = 0.001f; // m
    constexpr int kMostHits = 16;
    buried_.clear();
    for (std::uint32_t v = 0; v < body_.size(); ++v) {
        const Vec3f& out = body_normals_[v];
        float from = kJustOutside;
        int left = 0;
        for (int hit = 0; hit < kMostHits; ++hit) {
            const auto met = body_tree_->first_hit(body_[v], out, from);
            if (!met) {
                break;
            }
            const Triangle& t = body_triangles_[met->triangle];
            const Vec3f normal = (body_[t[1]] - body_[t[0]]).cross(body_[t[2]] - body_[t[0]]);
            left += normal.dot(out) > 0.0f ? 1 : -1;
            from = met->distance + 1e-5f;
        }
        if (left > 0) {
            buried_.push_back(body_[v]);
        }
    }
}

bool ContactMetrics::is_apart(const Vec3f& point) const {
    return std::any_of(buried_.begin(), buried_.end(), [&](const Vec3f& buried) {
        return (buried - point).squaredNorm() < kApart * kApart;
    });
}

Vec3f ContactMetrics::cloth_normal(std::uint32_t triangle) const {
    const Triangle& t = cloth_triangles_[triangle];
    return (cloth_[t[1]] - cloth_[t[0]]).cross(cloth_[t[2]] - cloth_[t[0]]);
}

bool ContactMetrics::is_covered(std::uint32_t vertex) const {
    if (!cloth_tree_) {
        return false;
    }
    const Vec3f& out = body_normals_[vertex];
    const auto met = cloth_tree_->first_hit(body_[vertex], out, 0.0f, kCovered);
    return met && cloth_normal(met->triangle).dot(out) > 0.0f;
}

/// Just behind the vertex is the outside of the cloth, and no cloth is over it.
bool ContactMetrics::is_in_front(std::uint32_t vertex) const {
    const Vec3f in = -body_normals_[vertex];
    const auto met = cloth_tree_->first_hit(body_[vertex], in, 0.0f, kInFront);
    return met && cloth_normal(met->triangle).dot(in) < 0.0f && !is_covered(vertex);
}

void ContactMetrics::count_deep(const Vec3f& sample, ContactFigures& figures) const {
    ++figures.samples;
    const float depth = -body_tree_->nearest(sample, kFarthest).signed_distance;
    if (depth <= 0.0f) {
        return;
    }
    if (depth > kDeep && is_apart(sample)) {
        ++figures.deep_apart;
        return;
    }
    figures.deepest_m = std::max(figures.deepest_m, depth);
    figures.deep += depth > kDeep ? 1 : 0;
}

ContactFigures ContactMetrics::measure(std::span<const Vec3f> body,
                                       std::span<const ClothSurface> garments) {
    take(body, garments);
    find_buried();
    ContactFigures figures;
    for (const Vec3f& p : cloth_) {
        count_deep(p, figures);
    }
    figures.vertices = figures.samples;
    figures.deep_vertices = figures.deep;
    for (const Triangle& t : cloth_triangles_) {
        count_deep((cloth_[t[0]] + cloth_[t[1]] + cloth_[t[2]]) / 3.0f, figures);
    }
    figures.covered = covered_.size();
    visible_.clear();
    for (const std::uint32_t v : covered_) {
        if (!is_in_front(v)) {
            continue;
        }
        if (is_apart(body_[v])) {
            ++figures.visible_apart;
        } else {
            visible_.push_back(v);
        }
    }
    figures.visible = visible_.size();
    return figures;
}

} // namespace toile::garment
