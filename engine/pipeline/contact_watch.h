// The worst contact of a run: how much of the garments was deep in the body, how much skin showed.
#pragma once

#include "garment/contact_metrics.h"
#include "pipeline/dressed_person.h"

#include <cstdint>
#include <vector>

namespace toile::pipeline {

/// Worst frame of each figure; definitions in garment/contact_metrics.h.
struct ContactWorst {
    double deep_fraction = 0.0;
    double deep_fraction_apart = 0.0; ///< where the body runs into itself
    double deepest_m = 0.0;
    double visible_fraction = 0.0;
    double visible_fraction_apart = 0.0;
    std::uint64_t deep_frame = 0;
    std::uint64_t visible_frame = 0;
};

/// Not for the live path: some 40 ms a frame.
class ContactWatch {
  public:
    /// What is covered is decided with the garments as bound, on the body in its rest pose.
    explicit ContactWatch(const DressedPerson& person);

    void measure(const DressedPerson& person, std::uint64_t frame);
    [[nodiscard]] const ContactWorst& worst() const { return worst_; }

  private:
    garment::ContactMetrics metrics_;
    ContactWorst worst_;
    std::vector<garment::ClothSurface> surfaces_;
};

} // namespace toile::pipeline
