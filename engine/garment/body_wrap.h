// First guesses of where cloth lies: around the trunk, a leg or an arm of a body in A pose.
#pragma once

#include "garment/block_loft.h"

#include <map>

namespace toile::garment::block {

/// Heights of a body that patterns are laid by, metres: underarm, bust, waist, high_hip, hip,
/// crotch, knee, ankle. \throw Error when the body lacks a landmark
[[nodiscard]] std::map<std::string, double> body_levels(const BodyProbe& body);

/// A tube around the left leg below the crotch.
class LegLoft {
  public:
    /// Never nearer the leg than `ease_m`; girth_m(height) is the cloth's girth.
    LegLoft(const BodyProbe& body, double low_m, double high_m,
            const std::function<double(double)>& girth_m, double ease_m);

    /// Fraction 0 at the inner side, 0.25 in front, 0.5 outside, 0.75 behind; heights are clamped
    /// to the tube's ends, the place keeps `height_m`. Metres, world.
    [[nodiscard]] Vec3d at(double fraction, double height_m) const;

  private:
    TubeRings rings_;
};

/// A tube along the left arm, from the shoulder's tip over the elbow to beyond the wrist.
class ArmTube {
  public:
    ArmTube(const BodyProbe& body, double ease_m);

    /// `along_m` from the tip of the shoulder down the arm (negative: towards the neck); `angle` 0
    /// on top, pi / 2 in front, pi below; a cloth of that girth. Metres, world.
    [[nodiscard]] Vec3d at(double along_m, double angle, double girth_m) const;
    /// From the tip of the shoulder to the wrist, metres.
    [[nodiscard]] double length() const { return length_; }

  private:
    struct Bone {
        Vec3d start, axis, up, front; ///< start: on the middle line at `from`
        double from = 0.0;            ///< along the arm
        double least_radius = 0.0;
    };
    std::array<Bone, 2> bones_;
    double length_ = 0.0;
};

} // namespace toile::garment::block
