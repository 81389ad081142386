// The space of adult bodies: a mean and components, who is likely in it, and coarser levels of it.
// A body is a vector of coefficients; each counts in standard deviations of the population.
#pragma once

#include "body/body_model.h"
#include "body/body_shape.h"
#include "body/sex.h"

#include <Eigen/Core>
#include <filesystem>
#include <span>

namespace toile::body {

/// Coefficients of one sex's population: normal with this mean and covariance.
struct CoefficientPrior {
    Eigen::VectorXd mean;       ///< (k)
    Eigen::MatrixXd covariance; ///< (k x k)
};

/// A coarser surface whose vertices are vertices of the full one, and where the full one lies on
/// it.
struct BodyLevel {
    std::vector<std::uint32_t> vertices; ///< (n) full vertex of each
    std::vector<Triangle> triangles;     ///< of level vertices
    std::vector<std::uint32_t> triangle; ///< (nv) level triangle nearest to each full vertex
    std::vector<Vec3f> barycentric;      ///< (nv) where on it, sum 1
};

/// Immutable once loaded; all calls are const and may run side by side.
class BodySpace {
  public:
    /// Loads avatars/<id>/ with its space.json and tables. \throw Error naming what is wrong
    [[nodiscard]] static BodySpace load(const std::filesystem::path& folder);

    /// The mean body with its components (`shape`), weights, parts and landmarks.
    [[nodiscard]] const BodyModel& model() const { return model_; }
    [[nodiscard]] int component_count() const { return static_cast<int>(model_.shape.size()); }
    [[nodiscard]] const CoefficientPrior& prior(Sex sex) const;
    /// Levels of about 3,000 and 1,000 vertices, finer first.
    [[nodiscard]] const std::vector<BodyLevel>& levels() const { return levels_; }

    /// The vertex form: mean + components * coefficients, stood on the floor. Missing coefficients
    /// count as zero. \throw Error for more than there are
    [[nodiscard]] BodyShape shape(std::span<const double> coefficients) const;

    /// Coefficients whose shape is nearest to `positions` (nv), least squares over the vertices
    /// weighted by area, up to height above the floor. (k)
    [[nodiscard]] Eigen::VectorXd coefficients(std::span<const Vec3f> positions) const;

    /// A body of its own: the model with that shape as its rest surface, without components and
    /// measurements.
    [[nodiscard]] BodyModel body(std::span<const double> coefficients) const;

  private:
    BodyModel model_;
    std::array<CoefficientPrior, 2> priors_; ///< in the order of kSexes
    std::vector<BodyLevel> levels_;
    Eigen::MatrixXf offsets_; ///< (3 nv + 66 x k) of vertices, then joints
    Eigen::VectorXf area_;    ///< (nv) of each vertex
};

/// The level with those vertices: finds where the full surface lies on it. `triangles` name places
/// in `vertices`.
[[nodiscard]] BodyLevel make_level(const geometry::TriangleMesh& full,
                                   std::vector<std::uint32_t> vertices,
                                   std::vector<Triangle> triangles);

} // namespace toile::body
