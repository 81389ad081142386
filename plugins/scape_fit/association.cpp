#include "scape_fit/association.h"

#include "body/rotations.h"

#include <cmath>

namespace toile::scape_fit {
namespace {

using geometry::kNoTriangle;

constexpr float kFullCosine = 0.6f; // from here on a slanting surface counts in full
constexpr float kFreeSpace = 0.06f; // metres that a reading must lie behind a vertex
constexpr float kFreePixels = 1.5f; // a silhouette is not known better
constexpr float kLostReach = 0.05f; // of points whose ray misses the model, metres
constexpr float kLostWeight = 0.5f;
constexpr std::uint32_t kGrain = 2048;

std::size_t largest(const Vec3f& barycentric) {
    int corner = 0;
    barycentric.maxCoeff(&corner);
    return static_cast<std::size_t>(corner);
}

} // namespace

void ObservedPoints::correct(const CameraCorrection& by) {
    if (!observation.eye) return;
    correction = by;
    const Eigen::Matrix3f turn = rotation_of(by.turn).cast<float>();
    const Mat3f scaled = static_cast<float>(by.scale) * turn;
    const Vec3f place = *observation.eye + by.shift.cast<float>();
    for (std::size_t p = 0; p < points.size(); ++p)
        points[p] = place + scaled * (observation.points[p] - *observation.eye);
    for (std::size_t e = 0; e < outline.size(); ++e)
        outline[e] = turn * observation.outline[e];
    eye = *observation.eye + by.shift.cast<float>();
}

void Associator::set_surface(const PosedLevel& posed) {
    posed_ = &posed;
    if (tree_)
        tree_->refit(posed.positions);
    else
        tree_.emplace(posed.positions, level_.triangles);
}

Vec3f Associator::normal_at(std::uint32_t triangle, const Vec3f& barycentric) const {
    const Triangle& t = level_.triangles[triangle];
    return (barycentric[0] * posed_->normals[t[0]] + barycentric[1] * posed_->normals[t[1]] +
            barycentric[2] * posed_->normals[t[2]])
        .normalized();
}

Associator::Partner Associator::partner(const ObservedPoints& observed, std::size_t point,
                                        const AssociationOptions& options) const {
    const Vec3f& p = observed.points[point];
    const Observation& seen = observed.observation;
    std::uint32_t triangle = kNoTriangle;
    Vec3f barycentric, place;
    float reach = options.reach_m, weight = seen.areas[point];
    if (options.along_rays && observed.eye) {
        const Vec3f ray = p - *observed.eye;
        const float length = ray.norm();
        if (const auto hit = tree_->first_hit(*observed.eye, ray, 1.0f - reach / length,
                                              1.0f + reach / length)) {
            triangle = hit->triangle;
            barycentric = hit->barycentric;
            place = *observed.eye + hit->distance * ray;
        } else {
            reach = std::min(reach, kLostReach);
            weight *= kLostWeight;
        }
    }
    if (triangle == kNoTriangle) {
        const auto near = tree_->nearest(p, reach);
        if (near.triangle == kNoTriangle) return {};
        triangle = near.triangle;
        barycentric = near.barycentric;
        place = near.point;
    }
    const Vec3f normal = normal_at(triangle, barycentric);
    float cosine = 1.0f;
    if (!seen.normals.empty()) cosine = normal.dot(seen.normals[point]);
    if (observed.eye) {
        const float facing = normal.dot((*observed.eye - place).normalized());
        weight /= std::max(facing, 0.2f);
        cosine = std::min(cosine, facing);
    }
    if (cosine < options.least_cosine) return {};
    const Vec3f offset = place - p;
    Partner out;
    out.vertex = level_.triangles[triangle][largest(barycentric)];
    out.distance = normal.dot(offset);
    weight *= body::smooth_step(options.least_cosine - 1e-3f, kFullCosine, cosine);
    weight *= geman_mcclure(offset.norm(), options.scale_m) * level_.trust[out.vertex];
    out.weight = weight;
    return out;
}

void Associator::sum_up(const ObservedPoints& observed, const AssociationOptions& options,
                        Association& out) {
    sums_.assign(level_.vertices.size(), {});
    const auto& covers = observed.observation.covers;
    for (std::size_t i = 0; i < partners_.size(); ++i) {
        const float area = observed.observation.areas[i];
        out.observed_area += area;
        const Partner& partner = partners_[i];
        if (partner.vertex == kNoTriangle) continue;
        out.paired_area += area;
        out.squares += area * partner.distance * partner.distance;
        VertexPair& sum = sums_[partner.vertex];
        sum.weight += partner.weight;
        sum.distance += partner.weight * partner.distance;
        sum.place += partner.weight * observed.points[i];
        if (covers.empty() || covers[i] == Cover::unknown) continue;
        (covers[i] == Cover::skin ? sum.bare : sum.covered) += partner.weight;
    }
    for (std::uint32_t v = 0; v < sums_.size(); ++v) {
        VertexPair& sum = sums_[v];
        if (sum.weight <= 0.0f) continue;
        sum.vertex = v;
        sum.distance /= sum.weight;
        sum.place /= sum.weight;
        sum.normal = posed_->normals[v];
        sum.observed = sum.weight;
        // Of many noisy points together, so that their noise does not pull the body in.
        if (options.cloth != nullptr) sum.weight *= options.cloth->weight(v, sum.distance);
        out.pairs.push_back(sum);
    }
}

void Associator::pull_from_empty(const ObservedPoints& observed, const AssociationOptions& options,
                                 Association& out) const {
    const Observation& seen = observed.observation;
    if (options.empty_weight <= 0.0f || (!seen.complete && !seen.view)) return;
    for (std::uint32_t v = 0; v < level_.vertices.size(); ++v) {
        const Vec3f& x = posed_->positions[v];
        float margin = 0.0f;
        const Vec3f as_seen = seen.eye ? observed.correction.undo(x, *seen.eye) : x;
        if (seen.view) {
            const auto sight = seen.view->sight(as_seen);
            if (!sight) continue;
            const float reading =
                seen.view->depth.metres[static_cast<std::size_t>(sight->y) *
                                            static_cast<std::size_t>(seen.view->depth.width) +
                                        static_cast<std::size_t>(sight->x)];
            if (!(reading > sight->depth + kFreeSpace)) continue; // hidden, or no reading
            margin = kFreePixels * sight->depth / static_cast<float>(seen.view->camera.fx);
        }
        const auto near = observed.tree.nearest(as_seen);
        if (!seen.rim.empty() && seen.rim[near.index] != 0) continue; // a hole, not empty space
        const Vec3f& p = observed.points[near.index];
        const Vec3f offset = x - p;
        VertexPair pair;
        pair.kind = PairKind::empty;
        pair.vertex = v;
        pair.place = p;
        const float length = offset.norm();
        if (length < 1e-4f || length > std::max(2.0f * options.reach_m, 0.05f)) continue;
        pair.normal = offset / length;
        pair.distance = length;
        if (!seen.normals.empty() && seen.normals[near.index].dot(posed_->normals[v]) > 0.3f) {
            pair.normal = seen.normals[near.index];
            pair.distance = pair.normal.dot(offset);
        }
        pair.distance -= margin;
        if (seen.view && pair.distance <= 0.0f) continue;
        pair.weight = options.empty_weight * level_.areas[v] * level_.trust[v] *
                      geman_mcclure(pair.distance, 2.0f * options.scale_m);
        out.pairs.push_back(pair);
    }
}

void Associator::associate(const ObservedPoints& observed, const AssociationOptions& options,
                           const RowLoop& rows, Association& out) {
    out.pairs.clear();
    out.paired_area = out.observed_area = out.squares = 0.0;
    partners_.resize(observed.points.size());
    rows(static_cast<std::uint32_t>(partners_.size()), kGrain,
         [&](std::uint32_t begin, std::uint32_t end) {
             for (std::uint32_t i = begin; i < end; ++i)
                 partners_[i] = partner(observed, i, options);
         });
    sum_up(observed, options, out);
    pull_from_empty(observed, options, out);
    if (options.outline_weight > 0.0f && observed.eye && !observed.outline.empty())
        contour_.pair(*posed_, *observed.eye, observed.outline, options.reach_m, options.scale_m,
                      options.outline_weight, options.cloth, out.pairs);
}

} // namespace toile::scape_fit
