// Which place of the model each observed point shows, and what the model's places say of the
// points that are missing.
#pragma once

#include "core/row_loop.h"
#include "geometry/nearest_surface.h"
#include "geometry/point_tree.h"
#include "scape_fit/fit_model.h"
#include "scape_fit/observation.h"

namespace toile::scape_fit {

struct AssociationOptions {
    float reach_m = 0.10f;        ///< farther pairs are left out
    float scale_m = 0.03f;        ///< of the robust weight (Geman-McClure)
    float least_cosine = 0.35f;   ///< between the normals of a pair, or of normal and line of sight
    bool along_rays = false;      ///< pairs on the line of sight: unbiased by noise along it
    float empty_weight = 0.3f;    ///< of model places where the observation has nothing
    float outside_weight = 1.0f;  ///< of points outside the model: below 1 for dressed people
};

/// Pairs summed up at a vertex of the level: their weight, mean distance and mean place.
struct VertexPair {
    std::uint32_t vertex = 0;
    Vec3f normal = Vec3f::Zero(); ///< along which the distance counts, unit
    Vec3f place = Vec3f::Zero();  ///< observed, world
    float distance = 0.0f;        ///< model minus observed, metres
    float weight = 0.0f;          ///< m^2 of surface
};

struct Association {
    std::vector<VertexPair> pairs;
    double paired_area = 0.0;   ///< m^2 of points that have a partner
    double observed_area = 0.0; ///< m^2 of all points
    double squares = 0.0;       ///< m^4: area times squared distance of the pairs, not weighted
    /// Root mean square distance of the pairs, metres.
    [[nodiscard]] double rms() const {
        return paired_area > 0.0 ? std::sqrt(squares / paired_area) : 0.0;
    }
};

/// One observation as the fit uses it.
struct ObservedPoints {
    explicit ObservedPoints(const Observation& seen)
        : observation(seen), tree(seen.points), points(seen.points), eye(seen.eye) {}

    const Observation& observation;
    geometry::PointTree tree;   ///< of the points as they were observed
    std::vector<Vec3f> points;  ///< where the camera's correction has them
    std::optional<Vec3f> eye;   ///< likewise
};

/// Keeps its search tree and work space; one for each instant.
class Associator {
  public:
    explicit Associator(const FitLevel& level) : level_(level) {}

    /// Moves the tree to where the surface is.
    void set_surface(const PosedLevel& posed);
    /// Adds what an observation of this instant says. `out` is cleared first.
    void associate(const ObservedPoints& observed, const AssociationOptions& options,
                   const RowLoop& rows, Association& out);

  private:
    struct Partner {
        std::uint32_t vertex = geometry::kNoTriangle;
        float distance = 0.0f; ///< along the vertex' normal
        float weight = 0.0f;   ///< m^2
    };
    [[nodiscard]] Partner partner(const ObservedPoints& observed, std::size_t point,
                                  const AssociationOptions& options) const;
    [[nodiscard]] Vec3f normal_at(std::uint32_t triangle, const Vec3f& barycentric) const;
    void sum_up(const ObservedPoints& observed, Association& out);
    void pull_from_empty(const ObservedPoints& observed, const AssociationOptions& options,
                         Association& out) const;

    const FitLevel& level_;
    const PosedLevel* posed_ = nullptr;
    std::optional<geometry::NearestSurface> tree_;
    std::vector<Partner> partners_;
    std::vector<VertexPair> sums_;
};

} // namespace toile::scape_fit
