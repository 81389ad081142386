#include "garment/size_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>
#include <tuple>

namespace toile::garment {
namespace {

using Lengths = std::map<std::string, double>;

// How far a body lies from one size, and the measurement that says so most clearly.
struct Distance {
    double missed_m = 0.0;     // outside the ranges
    double off_centre_m = 0.0; // from the ranges' middles
    std::size_t compared = 0;
    double worst_m = -1.0;
    std::string worst;
};

// `grown_m`: added to each of the body's measurements.
Distance distance(const SizeEntry& size, const Lengths& measurements, double grown_m) {
    Distance out;
    for (const auto& [name, range] : size.chart) {
        const auto found = measurements.find(name);
        if (found == measurements.end()) continue;
        const double value = found->second + grown_m;
        const double missed = std::max({range.minimum - value, value - range.maximum, 0.0});
        const double off_centre = std::abs(value - 0.5 * (range.minimum + range.maximum));
        ++out.compared;
        out.missed_m += missed;
        out.off_centre_m += off_centre;
        if (missed + 1e-3 * off_centre > out.worst_m) {
            out.worst_m = missed + 1e-3 * off_centre;
            out.worst = name;
        }
    }
    return out;
}

struct Best {
    std::optional<std::size_t> index;
    Distance distance;
};

Best best_size(const GarmentPackage& package, const Lengths& measurements, double grown_m) {
    Best best;
    for (std::size_t i = 0; i < package.sizes.size(); ++i) {
        const Distance d = distance(package.sizes[i].entry, measurements, grown_m);
        if (d.compared == 0) continue;
        if (best.index && std::tie(best.distance.missed_m, best.distance.off_centre_m) <=
                              std::tie(d.missed_m, d.off_centre_m))
            continue;
        best = {i, d};
    }
    return best;
}

std::string reason(const SizeEntry& size, const Distance& distance, const Lengths& measurements) {
    const ChartRange& range = size.chart.at(distance.worst);
    const double value = measurements.at(distance.worst);
    std::ostringstream text;
    text << std::fixed << std::setprecision(3) << size.name << ": " << distance.worst << " "
         << value << " m "
         << (value < range.minimum   ? "is below "
             : value > range.maximum ? "is above "
                                     : "lies in ")
         << range.minimum << " to " << range.maximum << " m";
    return text.str();
}

std::string centimetres(double metres) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f", 100.0 * metres);
    return text.data();
}

// "waist_girth" -> "waist".
std::string in_words(std::string name) {
    if (name.ends_with("_girth")) name.resize(name.size() - 6);
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

std::string charted(const SizeEntry& size, const std::string& name, double value) {
    const ChartRange& range = size.chart.at(name);
    const std::string body = "your " + in_words(name) + " of " + centimetres(value) + " cm ";
    if (range.minimum == range.maximum)
        return body + "compares with the " + centimetres(range.minimum) + " cm that " + size.name +
               " is made for";
    return body +
           (value < range.minimum   ? "is a little less than "
            : value > range.maximum ? "is a little more than "
                                    : "lies within ") +
           size.name + "'s " + centimetres(range.minimum) + " to " + centimetres(range.maximum) +
           " cm";
}

// The boundary between two sizes that a measurement lies nearest to.
struct Boundary {
    std::string name;
    double at_m = 0.0;
    double off_m = 1e9;
    bool upward = true; // the other size is the larger one
};

Boundary nearest_boundary(const SizeEntry& own, const SizeEntry& other,
                          const Lengths& measurements) {
    Boundary best;
    for (const auto& [name, mine] : own.chart) {
        const auto value = measurements.find(name);
        const auto theirs = other.chart.find(name);
        if (value == measurements.end() || theirs == other.chart.end()) continue;
        const ChartRange& range = theirs->second;
        const bool upward = range.minimum + range.maximum > mine.minimum + mine.maximum;
        const double at =
            upward ? 0.5 * (mine.maximum + range.minimum) : 0.5 * (mine.minimum + range.maximum);
        const double off = std::abs(value->second - at);
        if (off < best.off_m) best = {name, at, off, upward};
    }
    return best;
}

std::string between_text(const SizeEntry& own, const SizeEntry& other,
                         const Lengths& measurements) {
    const Boundary boundary = nearest_boundary(own, other, measurements);
    const std::string& closer = boundary.upward ? own.name : other.name;
    const std::string& roomier = boundary.upward ? other.name : own.name;
    std::string text = "between " + closer + " and " + roomier + ": ";
    if (!boundary.name.empty())
        text += "your " + in_words(boundary.name) + " of " +
                centimetres(measurements.at(boundary.name)) + " cm is near " +
                centimetres(boundary.at_m) + " cm, where " + roomier + " begins; ";
    return text + closer + " sits closer, " + roomier + " gives more room";
}

void explain(const GarmentPackage& package, const Lengths& measurements, SizeChoice& choice) {
    const SizeEntry& own = package.sizes[choice.index].entry;
    for (const auto& [name, range] : own.chart)
        if (const auto found = measurements.find(name); found != measurements.end())
            choice.reasons.push_back(charted(own, name, found->second));
    if (!choice.between) return;
    choice.reasons.push_back(between_text(own, package.sizes[*choice.between].entry, measurements));
    choice.reason += "; " + choice.reasons.back();
}

} // namespace

SizeChoice choose_size(const GarmentPackage& package, const Lengths& measurements,
                       const SizeChoiceOptions& options) {
    const Best best = best_size(package, measurements, 0.0);
    if (!best.index)
        throw Error("garment " + package.manifest.id +
                    ": no size chart names a measurement that this body has; choose with --size");
    SizeChoice choice;
    choice.index = *best.index;
    choice.within = best.distance.missed_m == 0.0;
    choice.reason = reason(package.sizes[choice.index].entry, best.distance, measurements);
    for (const double grown_m : {options.tolerance_m, -options.tolerance_m}) {
        const Best other = best_size(package, measurements, grown_m);
        if (!choice.between && *other.index != choice.index) choice.between = other.index;
    }
    explain(package, measurements, choice);
    return choice;
}

} // namespace toile::garment
