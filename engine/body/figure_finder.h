// Finds landmarks and parts on any closed, upright body surface by its shape alone. A fitted model
// (body/measurer.h) knows them better; this serves where none is fitted.
// Unfinished: chest, neck and arms are not found exactly, and the confidence does not say so yet.
#pragma once

#include "body/figure.h"

#include <memory>
#include <string>
#include <vector>

namespace toile::body {

/// Owns the surface that its figure borrows: movable, not copyable.
class FoundFigure {
  public:
    /// (nv), (nf) A closed surface of a person who stands upright (+Y up, metres), legs apart, arms
    /// away from the trunk, facing any way: of several pieces the largest counts.
    /// \throw Error naming what keeps it from being measured
    FoundFigure(std::span<const Vec3f> positions, std::span<const Triangle> triangles);
    FoundFigure(FoundFigure&&) noexcept = default;
    FoundFigure& operator=(FoundFigure&&) noexcept = default;

    /// Turned to face +Z, on the floor, in the middle.
    [[nodiscard]] const Figure& figure() const { return figure_; }
    [[nodiscard]] const RigidTransform& world_from_figure() const { return world_from_figure_; }
    /// What a user should know: "the left arm was not found".
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  private:
    std::vector<Vec3f> positions_;
    std::vector<Triangle> triangles_;
    std::unique_ptr<Regions> regions_;
    Figure figure_;
    RigidTransform world_from_figure_;
    std::vector<std::string> notes_;
};

} // namespace toile::body
