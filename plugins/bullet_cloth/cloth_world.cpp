#include "bullet_cloth/cloth_world.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::bullet_cloth {
namespace {

std::uint32_t rounds(double dt_s, double rate) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(dt_s * rate)));
}

} // namespace

void ClothWorld::set_body(const BodyRest& rest) {
    MovingBody body(rest);
    garments_.bind(body, rest_body_ ? &*rest_body_ : nullptr);
    rest_body_ = body;
    body_ = std::move(body);
}

std::uint32_t ClothWorld::add_garment(const GarmentInput& input) {
    if (!rest_body_) {
        throw Error("add_garment: no body; call set_body first");
    }
    return garments_.add(GarmentCloth(input, *rest_body_, settings_));
}

void ClothWorld::remove_garment(std::uint32_t garment) {
    garments_.remove(garment);
}

StepResult ClothWorld::step(const StepInput& input) noexcept {
    StepResult result =
        cloth::check_step(input, body_ ? body_->vertex_count() : 0, garments_.known());
    if (result != StepResult::ok) {
        return result;
    }
    const std::uint32_t count = rounds(input.dt_s, settings_.substep_rate);
    const auto substep = static_cast<float>(input.dt_s / count);
    body_->set_motion(input.body_before, input.body_after, static_cast<float>(input.dt_s));
    for (const GarmentFrame& frame : input.garments) {
        Entry& entry = *garments_.find(frame.garment);
        entry.cloth.begin_step(frame.targets, substep);
        if (input.reset || entry.fresh) {
            entry.cloth.reset();
            entry.fresh = false;
        }
    }
    const float since_last = substep > 0.0f ? simulate(input.dt_s) : 0.0f;
    body_->place(1.0f);
    for (const GarmentFrame& frame : input.garments) {
        Entry& entry = *garments_.find(frame.garment);
        if (!entry.cloth.finite()) {
            entry.cloth.reset();
            result = StepResult::recovered;
        }
        entry.cloth.clean_up(*body_, since_last);
        cloth::write_frame(entry.cloth.positions(), entry.cloth.triangles(), frame);
    }
    return result;
}

/// Seconds from the last refresh of the contacts to the end of the step.
float ClothWorld::simulate(double dt_s) noexcept {
    const std::uint32_t count = rounds(dt_s, settings_.substep_rate);
    const std::uint32_t intervals = std::min(count, rounds(dt_s, settings_.contact_rate));
    Interval interval{0, 0, count, 0, intervals, static_cast<float>(dt_s / count)};
    for (std::uint32_t i = 0; i < intervals; ++i) {
        interval.index = i;
        interval.first = interval.last;
        interval.last = count * (i + 1) / intervals;
        body_->place(0.5f * static_cast<float>(interval.first + interval.last) /
                     static_cast<float>(count));
        for (Entry& entry : garments_) {
            entry.cloth.advance(*body_, interval);
        }
    }
    return 0.5f * static_cast<float>(interval.last - interval.first) * interval.substep;
}

} // namespace toile::bullet_cloth
