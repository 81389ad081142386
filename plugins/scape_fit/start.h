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

    /// Ways to hold an arm, and a pose with one of its arms held so.
    [[nodiscard]] static std::size_t arm_count() noexcept;
    [[nodiscard]] body::Pose with_arm(const body::Pose& pose, bool left, std::size_t way) const;

  private:
    struct Entry {
        ShapeVector shape;
        body::Pose pose; ///< hips at the origin
        geometry::PointTree tree;
        Vec3f low, high; ///< its box
        Vec3f middle;    ///< mean of its points
    };
    std::vector<Entry> entries_;
    std::vector<body::Pose> arms_; ///< a pose for each way to hold the arms
};

} // namespace toile::scape_fit
