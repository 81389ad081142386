// Which place of the model each observed point shows, and what the model's places say of the
// points that are missing.
#pragma once

#include "core/row_loop.h"
#include "geometry/nearest_surface.h"
#include "geometry/point_tree.h"
#include "scape_fit/camera_correction.h"
#include "scape_fit/cloth_gaps.h"
#include "scape_fit/contour.h"
#include "scape_fit/fit_model.h"
#include "scape_fit/observation.h"

namespace toile::scape_fit {

struct AssociationOptions {
    float reach_m = 0.10f;       ///< farther pairs are left out
    float scale_m = 0.03f;       ///< of the robust weight (Geman-McClure)
    float least_cosine = 0.35f;  ///< between the normals of a pair, or of normal and line of sight
    bool along_rays = false;     ///< pairs on the line of sight: unbiased by noise along it
    float empty_weight = 0.3f;   ///< of model places where the observation has nothing
    float outline_weight = 0.0f; ///< m^2 that a pixel of the outline counts as; 0: not used
    const ClothGaps* cloth = nullptr; ///< of dressed people: points outside the body may be cloth
};

/// One observation as the fit uses it.
struct ObservedPoints {
    explicit ObservedPoints(const Observation& seen)
        : observation(seen), tree(seen.points), points(seen.points), outline(seen.outline),
          eye(seen.eye) {}

    /// Moves points, outline and eye to where a camera's correction has them.
    void correct(const CameraCorrection& by);

    const Observation& observation;
    CameraCorrection correction;
    geometry::PointTree tree;  ///< of the points as they were observed
    std::vector<Vec3f> points; ///< where the camera's correction has them
    std::vector<Vec3f> outline;
    std::optional<Vec3f> eye; ///< likewise
};

/// Keeps its search tree and work space; one for each instant.
class Associator {
  public:
    explicit Associator(const FitLevel& level) : level_(level), contour_(level) {}

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
    void sum_up(const ObservedPoints& observed, const AssociationOptions& options,
                Association& out);
    void pull_from_empty(const ObservedPoints& observed, const AssociationOptions& options,
                         Association& out) const;

    const FitLevel& level_;
    const PosedLevel* posed_ = nullptr;
    std::optional<geometry::NearestSurface> tree_;
    std::vector<Partner> partners_;
    std::vector<VertexPair> sums_;
    ContourPairing contour_;
};

} // namespace toile::scape_fit
