#include "garment/size_choice.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <tuple>

namespace toile::garment {
namespace {

// How far a body lies from one size, and the measurement that says so most clearly.
struct Distance {
    double missed_m = 0.0;     // outside the ranges
    double off_centre_m = 0.0; // from the ranges' middles
    std::size_t compared = 0;
    double worst_m = -1.0;
    std::string worst;
};

Distance distance(const SizeEntry& size, const std::map<std::string, double>& measurements) {
    Distance out;
    for (const auto& [name, range] : size.chart) {
        const auto found = measurements.find(name);
        if (found == measurements.end()) continue;
        const double value = found->second;
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

std::string reason(const SizeEntry& size, const Distance& distance,
                   const std::map<std::string, double>& measurements) {
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

} // namespace

SizeChoice choose_size(const GarmentPackage& package,
                       const std::map<std::string, double>& measurements) {
    const Distance* best = nullptr;
    std::vector<Distance> distances;
    for (const GarmentSize& size : package.sizes)
        distances.push_back(distance(size.entry, measurements));
    SizeChoice choice;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const Distance& d = distances[i];
        if (d.compared == 0) continue;
        if (best != nullptr &&
            std::tie(best->missed_m, best->off_centre_m) <= std::tie(d.missed_m, d.off_centre_m))
            continue;
        best = &d;
        choice.index = i;
    }
    if (best == nullptr)
        throw Error("garment " + package.manifest.id +
                    ": no size chart names a measurement that this body has; choose with --size");
    choice.within = best->missed_m == 0.0;
    choice.reason = reason(package.sizes[choice.index].entry, *best, measurements);
    return choice;
}

} // namespace toile::garment
