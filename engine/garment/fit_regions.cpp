#include "garment/fit_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace toile::garment {
namespace {

using body::Part;

FitRegion region_of_limb(Part part) {
    switch (part) {
    case Part::left_upper_arm:
    case Part::right_upper_arm:
        return FitRegion::upper_arm;
    case Part::left_lower_arm:
    case Part::right_lower_arm:
        return FitRegion::forearm;
    case Part::left_upper_leg:
    case Part::right_upper_leg:
        return FitRegion::thigh;
    case Part::left_lower_leg:
    case Part::right_lower_leg:
        return FitRegion::calf;
    default:
        return FitRegion::invalid;
    }
}

/// Levels of the trunk's regions along its upward axis.
struct TrunkLevels {
    Vec3f up;
    std::vector<std::pair<float, FitRegion>> levels;

    [[nodiscard]] FitRegion nearest(const Vec3f& point) const {
        FitRegion best = FitRegion::invalid;
        float least = std::numeric_limits<float>::infinity();
        for (const auto& [level, region] : levels) {
            const float off = std::abs(up.dot(point) - level);
            if (off >= least) continue;
            least = off;
            best = region;
        }
        return best;
    }
};

TrunkLevels trunk_levels(const body::Figure& figure, std::span<const body::LaidMeasurement> tapes) {
    TrunkLevels out{figure.waist.up, {}};
    for (const RegionRule& rule : region_rules()) {
        if (rule.region != FitRegion::chest && rule.region != FitRegion::waist &&
            rule.region != FitRegion::hip)
            continue;
        for (const body::LaidMeasurement& laid : tapes)
            if (laid.definition->name == rule.girth && !laid.reading.tapes.empty())
                out.levels.emplace_back(out.up.dot(laid.reading.tapes.front().centroid()),
                                        rule.region);
    }
    return out;
}

/// Fills class, source and intended room.
void intend(const WornView& worn, const RegionRule& rule, const GirthFit& girth, RegionFit& fit) {
    const EaseClass said = worn.package.manifest.ease_class.of(rule.region);
    const std::string name(girth.name);
    if (said != EaseClass::invalid) {
        fit.source = EaseSource::garment;
        fit.ease_class = said;
        fit.intended_m = intended_ease_m(said, rule, girth.body_m);
        return;
    }
    double made_for_m = 0.0;
    const auto charted = worn.size.entry.chart.find(name);
    if (worn.made_on != nullptr && worn.made_on->contains(name)) {
        fit.source = EaseSource::design;
        made_for_m = worn.made_on->at(name);
    } else if (charted != worn.size.entry.chart.end()) {
        fit.source = EaseSource::size_chart;
        made_for_m = 0.5 * (charted->second.minimum + charted->second.maximum);
    } else {
        fit.source = EaseSource::wearer;
        fit.ease_class = nearest_class(fit.ease_m, rule, girth.body_m);
        fit.intended_m = intended_ease_m(fit.ease_class, rule, girth.body_m);
        return;
    }
    fit.intended_m = girth.garment_m - made_for_m;
    fit.ease_class = nearest_class(fit.intended_m, rule, made_for_m);
}

std::string centimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f cm", 100.0 * metres);
    return text.data();
}

} // namespace

std::vector<FitRegion> regions_of_vertices(const WearerView& wearer, const body::Figure& figure,
                                           std::span<const body::LaidMeasurement> tapes,
                                           const SkinGap& gap, std::span<const Vec3f> cloth) {
    const TrunkLevels trunk = trunk_levels(figure, tapes);
    std::vector<FitRegion> out(cloth.size(), FitRegion::invalid);
    for (std::size_t v = 0; v < cloth.size(); ++v) {
        const Triangle& beneath = gap.body_triangles()[gap.beneath()[v]];
        const Part part = wearer.model.parts[beneath[0]];
        out[v] = part == Part::torso || part == Part::pelvis ? trunk.nearest(cloth[v])
                                                             : region_of_limb(part);
    }
    return out;
}

std::vector<RegionFit> judge_regions(const WornView& worn, std::span<const GirthFit> girths) {
    const auto& sizes = worn.package.sizes;
    const bool smaller = &worn.size != &sizes.front(), larger = &worn.size != &sizes.back();
    std::vector<RegionFit> out;
    for (const RegionRule& rule : region_rules())
        for (const GirthFit& girth : girths) {
            if (girth.name != rule.girth) continue;
            RegionFit fit;
            fit.region = rule.region;
            fit.girth = rule.girth;
            fit.ease_m = girth.ease_m();
            intend(worn, rule, girth, fit);
            fit.verdict =
                verdict_of(fit.ease_m, fit.intended_m, fit.ease_class, rule, girth.body_m);
            fit.text = verdict_text(fit.verdict, fit.ease_m, rule, smaller, larger);
            out.push_back(std::move(fit));
        }
    return out;
}

std::vector<std::string> other_sizes(const GarmentFit& fit) {
    const auto worn = std::find(fit.sizes.begin(), fit.sizes.end(), fit.size) - fit.sizes.begin();
    std::vector<std::string> out;
    for (const RegionFit& region : fit.regions) {
        const bool narrow =
            region.verdict == Verdict::tight || region.verdict == Verdict::too_tight;
        const std::ptrdiff_t other = narrow ? worn + 1 : worn - 1;
        if (region.verdict == Verdict::as_intended || other < 0 ||
            other >= static_cast<std::ptrdiff_t>(fit.sizes.size()))
            continue;
        const auto girth = std::find_if(fit.girths.begin(), fit.girths.end(),
                                        [&](const GirthFit& g) { return g.name == region.girth; });
        const auto rule =
            std::find_if(region_rules().begin(), region_rules().end(),
                         [&](const RegionRule& r) { return r.region == region.region; });
        const auto size = static_cast<std::size_t>(other);
        const double ease = girth->sizes_m[size] - girth->body_m;
        if (narrow != (ease > region.ease_m)) continue; // sizes in another order, or alike here
        out.push_back("in " + fit.sizes[size] + " " + std::string(rule->in_words) + " has " +
                      centimetres(ease) + " of room, in " + fit.size + " " +
                      centimetres(region.ease_m));
    }
    return out;
}

void add_strain(std::span<const FitRegion> regions, const GarmentFit& fit,
                std::vector<RegionFit>& to) {
    for (RegionFit& region : to) {
        std::size_t count = 0;
        std::vector<double> pressures;
        for (std::size_t v = 0; v < regions.size(); ++v) {
            if (regions[v] != region.region) continue;
            const auto stretch = static_cast<double>(std::max({fit.warp[v], fit.weft[v], 0.0f}));
            ++count;
            region.stretch_mean += stretch;
            region.stretch_max = std::max(region.stretch_max, stretch);
            if (fit.pressure_pa[v] > 0.0f)
                pressures.push_back(static_cast<double>(fit.pressure_pa[v]));
        }
        if (count > 0) region.stretch_mean /= static_cast<double>(count);
        if (pressures.empty()) continue;
        std::sort(pressures.begin(), pressures.end());
        for (const double p : pressures)
            region.pressure_mean_pa += p / static_cast<double>(pressures.size());
        region.pressure_p95_pa = pressures[(pressures.size() - 1) * 95 / 100];
    }
}

} // namespace toile::garment
