// A piece of a sewing pattern as it is cut: a flat outline with named points.
#pragma once

#include "garment/block_pattern.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace toile::garment::block {

/// Metres, y upwards along the warp (the grain).
struct PatternPiece {
    std::string name;                    ///< "front"
    std::vector<Vec2d> outline;          ///< (np >= 3) closed, counter-clockwise, no point twice
    std::map<std::string, Vec2d> points; ///< of the designer, on the outline or not
};

/// Pieces as `freesewing/draft.mjs` prints them (millimetres, y downwards); `name` stands for the
/// text in errors. \throw Error naming what is wrong
[[nodiscard]] std::vector<PatternPiece> read_drafted_pieces(std::string_view json,
                                                            const std::string& name);

/// Twice the signed area is positive when counter-clockwise; m2.
[[nodiscard]] double signed_area(std::span<const Vec2d> outline);

/// Makes an outline fit for use: counter-clockwise, without points closer than 0.05 mm.
/// \throw Error naming the piece: fewer than three corners, no area, not finite, or an outline
/// that crosses itself (with the place)
void check_piece(PatternPiece& piece);

/// An outline that places are looked up on, by arc length from its first point.
class OutlineWalk {
  public:
    explicit OutlineWalk(std::span<const Vec2d> outline);

    [[nodiscard]] double length() const { return sums_.back(); }
    /// Nearest place on the outline; `distance_m` gets how far off it is.
    [[nodiscard]] double project(const Vec2d& point, double& distance_m) const;
    /// The polyline from one place to another, onwards (over the first point if need be).
    [[nodiscard]] std::vector<Vec2d> between(double from, double to) const;
    [[nodiscard]] Vec2d at(double place) const;

  private:
    std::vector<Vec2d> points_; ///< closed: the first stands again at the end
    std::vector<double> sums_;  ///< arc length at each of them
};

} // namespace toile::garment::block
