// One figure being measured: what its tapes have in common is found once.
#pragma once

#include "body/figure.h"

#include <optional>
#include <string_view>

namespace toile::body {

/// What one measurement gave.
struct Reading {
    double value_m = 0.0;
    double confidence = 0.0;            ///< [0, 1]
    std::vector<geometry::Loop> tapes;  ///< where it was taken, world frame
    std::optional<geometry::Plane> cut; ///< girths: the plane of the tape
};

/// Keeps count of how far what has been used can be trusted. The figure must outlive it.
class Survey {
  public:
    explicit Survey(const Figure& figure);

    [[nodiscard]] const Figure& figure() const { return figure_; }

    /// Starts a new measurement: nothing used yet.
    void begin() { trust_ = 1.0; }
    /// [0, 1]: the least trust of all that was used since `begin`.
    [[nodiscard]] double trust() const { return trust_; }
    /// What follows rests on something trusted this far.
    void rest_on(double trust);

    /// Landmarks, on the right side for limbs; both count as used.
    [[nodiscard]] Vec3f at(Landmark landmark);
    [[nodiscard]] Vec3f middle_of(Landmark a, Landmark b);
    [[nodiscard]] const geometry::SurfacePart& region(Region region);
    /// Metres above the floor: above the lowest point of the surface.
    [[nodiscard]] double height(const Vec3f& point);

    /// Cuts of the trunk across the spine at the hips, the waist and the chest.
    [[nodiscard]] const geometry::GirthCutter& hips();
    [[nodiscard]] const geometry::GirthCutter& waist();
    [[nodiscard]] const geometry::GirthCutter& chest();

    /// The waist, as an offset of `waist()`: the narrowest level between the lowest rib and the
    /// iliac crest, moved towards the middle between them where the trunk is as wide all over (mean
    /// of the levels, those with the least girth weighing most), so that it changes smoothly.
    [[nodiscard]] float waist_level();
    /// The hip, as an offset of `hips()`: where the buttocks stand out most, between the gluteal
    /// fold and the iliac crest; smooth in the same way.
    [[nodiscard]] float hip_level();

    /// Where the trunk's surface meets the level `offset` of `cutter` in direction `towards`, seen
    /// from `inside`, a point between.
    [[nodiscard]] Vec3f level_point(const geometry::GirthCutter& cutter, float offset,
                                    const Vec3f& inside, const Vec3f& towards);
    /// The four of them at the waist and the hip.
    [[nodiscard]] Vec3f waist_point(const Vec3f& towards);
    [[nodiscard]] Vec3f hip_point(const Vec3f& towards);

  private:
    struct Level {
        float offset;
        double trust;
    };
    using Cutter = std::optional<geometry::GirthCutter>;
    const geometry::GirthCutter& cutter(Cutter& kept, const Vec3f& up);

    const Figure& figure_;
    double trust_ = 1.0;
    std::optional<float> floor_;
    Cutter hips_, waist_, chest_;
    std::optional<Level> waist_level_, hip_level_;
};

} // namespace toile::body
