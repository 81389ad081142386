// What a pattern cutter takes from a body: slices, silhouettes, girths and the armpit.
#pragma once

#include "body/body_model.h"
#include "garment/block_pattern.h"

namespace toile::garment::block {

/// A closed polygon in a horizontal plane as the cloth spans it: the convex hull of the trunk's
/// (or both legs') outline, counter-clockwise seen from above, as (x, z), metres.
struct Ring {
    double height_m = 0.0;
    std::vector<Vec2d> hull;

    [[nodiscard]] double girth() const;
    [[nodiscard]] double half_width() const; ///< largest |x|
    /// Point at `fraction` 0..1 of the way from the centre front over the left side (fraction
    /// 0.5) to the centre back, `ease_m` outside the hull. Front and back part by the side point,
    /// where the hull is widest. Metres, world.
    [[nodiscard]] Vec3d at(double fraction, double ease_m) const;
};

/// Measures a rest surface in A pose. Keeps a reference to the body.
class BodyProbe {
  public:
    explicit BodyProbe(const body::BodyModel& body);

    [[nodiscard]] const body::BodyModel& body() const { return body_; }
    [[nodiscard]] Vec3d joint(body::Joint joint) const;
    /// Hull of the trunk without arms at a height below the armpit. \throw Error when empty
    [[nodiscard]] Ring ring(double height_m) const;
    /// Where the trunk and the left arm part. \throw Error when there is no such height
    [[nodiscard]] double armpit_height() const { return armpit_; }
    /// Highest point of the shoulder above x, metres.
    [[nodiscard]] Vec3d ridge(double x) const;
    /// Where neck and shoulder meet on the left: the ridge is as steep as 45 degrees.
    [[nodiscard]] double neck_half_width() const { return neck_half_width_; }
    /// Taut length over the front (or back) from the ridge at x down to a height.
    [[nodiscard]] double drop_length(double x, double height_m, bool front) const;
    /// Depth z of the body's front (or back) at (x, y), with its neighbourhood; false when the
    /// body is not there.
    [[nodiscard]] bool depth(double x, double y, bool front, double& z) const;
    /// Girth of the left upper arm at a share of its length, and the section's centre.
    [[nodiscard]] double arm_girth(double share, Vec3d& centre) const;
    /// Outlines of the surface in the plane normal . p = offset.
    [[nodiscard]] std::vector<std::vector<Vec3d>> slice(const Vec3d& normal, double offset) const;

  private:
    [[nodiscard]] double find_armpit() const;
    [[nodiscard]] double find_neck() const;
    void build_depth();

    const body::BodyModel& body_;
    double armpit_ = 0.0;
    double neck_half_width_ = 0.0;
    // Front and back depth over a grid of the frontal plane.
    Vec2d grid_low_ = Vec2d::Zero();
    int grid_width_ = 0, grid_height_ = 0;
    std::array<std::vector<double>, 2> grid_depth_; // NaN where empty
};

/// Convex hull, counter-clockwise.
[[nodiscard]] std::vector<Vec2d> convex_hull(std::vector<Vec2d> points);

} // namespace toile::garment::block
