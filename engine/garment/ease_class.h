// How much room a garment is meant to give, and how a measured room compares with it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace toile::garment {

/// As cutters name it. The room is meant around the trunk; limbs get 0.7 of it.
enum class EaseClass : std::uint8_t {
    invalid,
    stretch,     ///< narrower than the body by 6 % of its girth: leggings
    fitted,      ///< 4.5 cm wider
    semi_fitted, ///< 7 cm
    loose,       ///< 10 cm
    very_loose,  ///< 15 cm: coats
};

/// A part of the body that a verdict is given for.
enum class FitRegion : std::uint8_t {
    invalid,
    chest,
    waist,
    hip,
    upper_arm,
    forearm,
    thigh,
    knee,
    calf,
};

/// How worn room compares with intended room.
enum class Verdict : std::uint8_t { invalid, too_tight, tight, as_intended, loose, too_loose };

/// Names in files: "semi_fitted", "upper_arm", "as_intended".
[[nodiscard]] std::string_view name_of(EaseClass ease_class);
[[nodiscard]] std::string_view name_of(FitRegion region);
[[nodiscard]] std::string_view name_of(Verdict verdict);
[[nodiscard]] std::optional<EaseClass> ease_class_from_name(std::string_view name);
[[nodiscard]] std::optional<FitRegion> fit_region_from_name(std::string_view name);

/// A region, the girth that decides about it, and how much of a class's room it gets.
struct RegionRule {
    FitRegion region = FitRegion::invalid;
    std::string_view girth; ///< ISO 8559-1 name
    double share = 1.0;
    std::string_view in_words; ///< "the upper arm"
    std::string_view beneath;  ///< what a wearer would put there: "a warm sleeve"
};
[[nodiscard]] std::span<const RegionRule> region_rules();

/// What a maker says of a design: one class for all of it, others for single regions.
struct EaseIntent {
    EaseClass all = EaseClass::invalid; ///< invalid: nothing is said
    std::map<FitRegion, EaseClass> regions = {};

    [[nodiscard]] bool empty() const { return all == EaseClass::invalid && regions.empty(); }
    /// EaseClass::invalid when nothing is said of it.
    [[nodiscard]] EaseClass of(FitRegion region) const;
};

/// Room that a class means in a region of a body of that girth; m, negative for stretch.
[[nodiscard]] double intended_ease_m(EaseClass ease_class, const RegionRule& region, double body_m);

/// The class whose room is nearest.
[[nodiscard]] EaseClass nearest_class(double ease_m, const RegionRule& region, double body_m);

/// as_intended within a half of the intended room, at least 2.5 cm (limbs 0.7 of that; stretch: 5 %
/// of the girth); tight and loose up to twice as far; too_tight and too_loose beyond.
[[nodiscard]] Verdict verdict_of(double ease_m, double intended_m, EaseClass ease_class,
                                 const RegionRule& region, double body_m);

/// What the verdict means, in kind words; `smaller` and `larger`: there is such a size.
[[nodiscard]] std::string verdict_text(Verdict verdict, double ease_m, const RegionRule& region,
                                       bool smaller, bool larger);

} // namespace toile::garment
