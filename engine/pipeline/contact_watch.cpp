#include "pipeline/contact_watch.h"

#include <algorithm>

namespace toile::pipeline {
namespace {

std::vector<garment::ClothSurface> bound_surfaces(const DressedPerson& person) {
    std::vector<garment::ClothSurface> out;
    for (const WornGarment& garment : person.garments())
        out.push_back({garment.bound, garment.triangles()});
    return out;
}

double share(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

} // namespace

ContactWatch::ContactWatch(const DressedPerson& person)
    : metrics_(person.body().model().rest.positions, person.body().model().rest.triangles,
               bound_surfaces(person)) {}

void ContactWatch::measure(const DressedPerson& person, std::uint64_t frame) {
    surfaces_.clear();
    for (const WornGarment& garment : person.garments())
        surfaces_.push_back({garment.positions, garment.triangles()});
    const garment::ContactFigures now = metrics_.measure(person.posed().positions, surfaces_);
    if (now.deep_fraction() > worst_.deep_fraction) {
        worst_.deep_fraction = now.deep_fraction();
        worst_.deep_frame = frame;
    }
    if (now.visible_fraction() > worst_.visible_fraction) {
        worst_.visible_fraction = now.visible_fraction();
        worst_.visible_frame = frame;
    }
    worst_.deep_fraction_apart =
        std::max(worst_.deep_fraction_apart, share(now.deep_apart, now.samples));
    worst_.visible_fraction_apart =
        std::max(worst_.visible_fraction_apart, share(now.visible_apart, now.covered));
    worst_.deepest_m = std::max(worst_.deepest_m, static_cast<double>(now.deepest_m));
}

} // namespace toile::pipeline
