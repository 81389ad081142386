// A basic block: a sewing pattern drafted for one body, as half panels in the plane.
#pragma once

#include "core/types.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace toile::garment::block {

using Vec2d = Eigen::Vector2d;

/// One named edge of a panel: a polyline in metres, densely sampled.
struct Curve {
    std::string name;
    std::vector<Vec2d> points; ///< at least 2
};

/// The half of a panel (x >= 0: the side of the body's left arm), or half a sleeve. Patterns are
/// symmetric, if they do not say otherwise: the other half is its mirror image. y runs upwards
/// along the warp.
struct HalfPanel {
    std::string name;
    std::vector<Curve> border;      ///< closed, counter-clockwise; each starts where the last ends
    bool mirrored = false;          ///< flat x runs against the chart's u on the body's left side
    Vec2d chart_offset{0.0, 0.0};   ///< where the left chart lies among all charts, metres
    double right_chart_shift = 0.0; ///< added to u for the body's right side
    int priority = 0;               ///< whose placement a shared vertex takes: the highest
    std::function<Vec3d(const Vec2d&)> place; ///< first guess of the place around the body
    /// Where a chart point (without offset) lies in the weave, when the strip is knitted round a
    /// curve; null: where it lies in the chart.
    std::function<Vec2d(const Vec2d&)> unroll;
};

/// Two edges sewn together on each side of the body, start to start unless reversed.
struct Seam {
    std::string panel_a, curve_a;
    std::string panel_b, curve_b;
    bool reversed = false;
};

/// An edge sewn to its own mirror image: centre front, centre back.
struct CentreSeam {
    std::string panel, curve;
};

struct Pattern {
    std::vector<HalfPanel> panels;
    std::vector<Seam> seams;
    std::vector<CentreSeam> centres;
    std::vector<std::pair<std::string, std::string>> held; ///< panel, edge: held to the body
    bool symmetric = true; ///< false: the panels are whole and have no mirror images

    [[nodiscard]] std::size_t panel_index(const std::string& name) const;
    [[nodiscard]] const Curve& curve(const std::string& panel, const std::string& name) const;
};

[[nodiscard]] double length(std::span<const Vec2d> polyline);
/// `count` + 1 points at equal distances along the line, ends included.
[[nodiscard]] std::vector<Vec2d> resample(std::span<const Vec2d> polyline, std::size_t count);
/// A cubic Bezier curve as a polyline of 64 pieces.
[[nodiscard]] std::vector<Vec2d> bezier(const Vec2d& a, const Vec2d& b, const Vec2d& c,
                                        const Vec2d& d);

/// An arc around (0, apex) from the centre line (below the apex) outwards; radians.
[[nodiscard]] std::vector<Vec2d> arc(double apex, double radius, double angle);
[[nodiscard]] std::vector<Vec2d> reversed(std::vector<Vec2d> line);

} // namespace toile::garment::block
