#include "garment/ease_class.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::garment {
namespace {

constexpr double kLimbs = 0.7;
constexpr double kStretchShare = -0.06;     // of the body's girth
constexpr double kStretchTolerance = 0.05;  // of the body's girth
constexpr double kLeastTolerance_m = 0.025; // around the trunk

constexpr std::array<RegionRule, 8> kRegions = {{
    {FitRegion::chest, "bust_girth", 1.0, "the chest", "a jumper"},
    {FitRegion::waist, "waist_girth", 1.0, "the waist", "a tucked-in top"},
    {FitRegion::hip, "hip_girth", 1.0, "the hip", "another layer"},
    {FitRegion::upper_arm, "upper_arm_girth", kLimbs, "the upper arm", "a warm sleeve"},
    {FitRegion::forearm, "forearm_girth", kLimbs, "the forearm", "a warm sleeve"},
    {FitRegion::thigh, "thigh_girth", kLimbs, "the thigh", "warm tights"},
    {FitRegion::knee, "knee_girth", kLimbs, "the knee", "warm tights"},
    {FitRegion::calf, "calf_girth", kLimbs, "the calf", "warm socks"},
}};

constexpr std::array<std::string_view, 6> kClassNames = {"invalid",     "stretch", "fitted",
                                                         "semi_fitted", "loose",   "very_loose"};
constexpr std::array<double, 6> kClassEase_m = {0.0, 0.0, 0.045, 0.07, 0.10, 0.15};
constexpr std::array<std::string_view, 9> kRegionNames = {
    "invalid", "chest", "waist", "hip", "upper_arm", "forearm", "thigh", "knee", "calf"};
constexpr std::array<std::string_view, 6> kVerdictNames = {"invalid",     "too_tight", "tight",
                                                           "as_intended", "loose",     "too_loose"};

template <typename Enum, std::size_t N>
std::optional<Enum> from_name(const std::array<std::string_view, N>& names, std::string_view name) {
    const auto* const found = std::find(names.begin() + 1, names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Enum>(found - names.begin());
}

std::string centimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f cm", 100.0 * std::abs(metres));
    return text.data();
}

std::string capitalised(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
        text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

} // namespace

std::string_view name_of(EaseClass ease_class) {
    return kClassNames.at(static_cast<std::size_t>(ease_class));
}
std::string_view name_of(FitRegion region) {
    return kRegionNames.at(static_cast<std::size_t>(region));
}
std::string_view name_of(Verdict verdict) {
    return kVerdictNames.at(static_cast<std::size_t>(verdict));
}
std::optional<EaseClass> ease_class_from_name(std::string_view name) {
    return from_name<EaseClass>(kClassNames, name);
}
std::optional<FitRegion> fit_region_from_name(std::string_view name) {
    return from_name<FitRegion>(kRegionNames, name);
}

std::span<const RegionRule> region_rules() {
    return kRegions;
}

EaseClass EaseIntent::of(FitRegion region) const {
    const auto found = regions.find(region);
    return found == regions.end() ? all : found->second;
}

double intended_ease_m(EaseClass ease_class, const RegionRule& region, double body_m) {
    if (ease_class == EaseClass::stretch) return kStretchShare * body_m;
    return region.share * kClassEase_m.at(static_cast<std::size_t>(ease_class));
}

EaseClass nearest_class(double ease_m, const RegionRule& region, double body_m) {
    EaseClass best = EaseClass::stretch;
    for (std::size_t i = 2; i < kClassNames.size(); ++i) {
        const auto other = static_cast<EaseClass>(i);
        if (std::abs(ease_m - intended_ease_m(other, region, body_m)) <
            std::abs(ease_m - intended_ease_m(best, region, body_m)))
            best = other;
    }
    return best;
}

Verdict verdict_of(double ease_m, double intended_m, EaseClass ease_class, const RegionRule& region,
                   double body_m) {
    const double tolerance = ease_class == EaseClass::stretch
                                 ? kStretchTolerance * body_m
                                 : std::max(region.share * kLeastTolerance_m, 0.5 * intended_m);
    const double off = (ease_m - intended_m) / tolerance;
    if (off < -2.0) return Verdict::too_tight;
    if (off < -1.0) return Verdict::tight;
    if (off <= 1.0) return Verdict::as_intended;
    return off <= 2.0 ? Verdict::loose : Verdict::too_loose;
}

std::string verdict_text(Verdict verdict, double ease_m, const RegionRule& region, bool smaller,
                         bool larger) {
    const std::string where(region.in_words);
    const std::string room = centimetres(ease_m);
    const std::string than = ease_m < 0.0
                                 ? "the cloth is " + room + " shorter than the way around " + where
                                 : "the cloth leaves " + room + " of room around " + where;
    switch (verdict) {
    case Verdict::too_tight:
        return capitalised(than) + ", less than this garment wants" +
               (larger ? ": the next size up will feel better" : "");
    case Verdict::tight:
        return capitalised(than) + ", closer than designed: fine over thin layers" +
               (larger ? "; the next size up is easier to move in" : "");
    case Verdict::as_intended:
        return "Sits as designed: " + than;
    case Verdict::loose:
        return capitalised(than) + ": a relaxed look, with space for " +
               std::string(region.beneath) + " beneath";
    case Verdict::too_loose:
        return capitalised(than) + ", more than this garment is designed for" +
               (smaller ? ": the next size down will follow the figure better" : "");
    case Verdict::invalid:
        break;
    }
    return {};
}

} // namespace toile::garment
