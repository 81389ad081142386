// Where a fit begins: the nearest body of a small library, wherever it stands (P1 3.2).
#pragma once

#include "core/row_loop.h"
#include "geometry/point_tree.h"
#include "scape_fit/fit_model.h"

#include <span>
#include <vector>

namespace toile::scape_fit {

struct Start {
    ShapeVector shape;
    body::Pose pose;
    double score_m = 0.0; ///< mean distance of the points, far ones counted as 15 cm
};

/// Bodies of both sexes, slight and heavy, in the ways that people hold their arms.
class StartLibrary {
  public:
    explicit StartLibrary(const FitModel& model);

    /// The best places of the best bodies, best first, at most `count`, no two of them alike.
    /// `points`: a few hundred, metres; `ups`: directions that may be up (unit).
    [[nodiscard]] std::vector<Start> find(std::span<const Vec3f> points, std::span<const Vec3f> ups,
                                          std::size_t count, const RowLoop& rows) const;

  private:
    struct Entry {
        ShapeVector shape;
        body::Pose pose; ///< hips at the origin
        geometry::PointTree tree;
        Vec3f low, high; ///< its box
        Vec3f middle;    ///< mean of its points
    };
    std::vector<Entry> entries_;
};

} // namespace toile::scape_fit
