// Where the points of one cut panel lie on a body, by its wrap.
#pragma once

#include "garment/body_wrap.h"
#include "garment/pattern_piece.h"
#include "garment/recipe.h"

#include <memory>

namespace toile::garment::block {

/// How wide a panel is at each height of its flat shape, between its inner and its outer edges;
/// above and below them it stays as wide as where they end.
class PanelWidths {
  public:
    /// The outline gives the lowest and the highest place, the edges' points the sides.
    PanelWidths(std::span<const Vec2d> outline, std::span<const Curve* const> inner,
                std::span<const Curve* const> outer);

    /// Share of the way from the inner to the outer side at the point's height, 0..1.
    [[nodiscard]] double share(const Vec2d& flat) const;
    [[nodiscard]] double width(double y) const;
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const;

  private:
    static constexpr double kStep = 0.005;                    ///< metres between rows
    [[nodiscard]] std::array<double, 2> ends(double y) const; ///< inner, outer x
    double low_ = 0.0;
    std::vector<std::array<double, 2>> rows_; ///< (rows) inner, outer x
};

/// A panel with what its place is reckoned from.
struct PlacedPanel {
    const PanelRecipe* recipe = nullptr;
    const PatternPiece* piece = nullptr;
    std::shared_ptr<const PanelWidths> widths;
    std::vector<std::pair<double, double>> heights; ///< flat y -> world y, ascending

    [[nodiscard]] Vec2d point(const std::string& name) const; ///< \throw Error when there is none
    [[nodiscard]] double world_height(double flat_y) const;   ///< linear between, slope 1 beyond
};

/// The tubes that all panels of a garment share. Keeps a reference to the body.
class GarmentWrap {
  public:
    /// \throw Error naming panel and what its wrap lacks
    GarmentWrap(const BodyProbe& body, std::span<const PlacedPanel> panels, double clearance_m);

    /// Place of a panel's flat points; valid while the wrap lives. `seam_of`: see PanelWrap.
    [[nodiscard]] std::function<Vec3d(const Vec2d&)> place_of(const PlacedPanel& panel,
                                                              const PlacedPanel& seam_of) const;

  private:
    [[nodiscard]] Vec3d on_torso(const PlacedPanel& panel, const Vec2d& flat) const;
    [[nodiscard]] Vec3d over_shoulder(const PlacedPanel& panel, const PlacedPanel& seam_of,
                                      const Vec2d& flat) const;
    [[nodiscard]] Vec3d on_leg(const PlacedPanel& panel, const Vec2d& flat) const;
    [[nodiscard]] Vec3d on_arm(const PlacedPanel& panel, const Vec2d& flat) const;
    [[nodiscard]] Vec3d on_sector(const PlacedPanel& panel, const Vec2d& flat) const;

    const BodyProbe& body_;
    std::map<std::string, double> levels_;
    std::shared_ptr<const Loft> torso_;
    std::shared_ptr<const LegLoft> leg_;
    std::shared_ptr<const ArmTube> arm_;
};

} // namespace toile::garment::block
