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
    std::vector<Entry> bound = std::move(garments_);
    garments_.clear();
    try {
        for (Entry& entry : bound) {
            entry.cloth.bind(body);
            entry.fresh = true;
        }
    } catch (...) {
        if (rest_body_) {
            for (Entry& entry : bound) {
                entry.cloth.bind(*rest_body_);
            }
        }
        garments_ = std::move(bound);
        throw;
    }
    garments_ = std::move(bound);
    rest_body_ = body;
    body_ = std::move(body);
}

std::uint32_t ClothWorld::add_garment(const GarmentInput& input) {
    if (!rest_body_) {
        throw Error("add_garment: no body; call set_body first");
    }
    garments_.push_back({next_handle_, true, GarmentCloth(input, *rest_body_, settings_)});
    note_garments();
    return next_handle_++;
}

void ClothWorld::remove_garment(std::uint32_t garment) {
    const auto it = std::find_if(garments_.begin(), garments_.end(),
                                 [&](const Entry& entry) { return entry.handle == garment; });
    if (it == garments_.end()) {
        throw Error("remove_garment: there is no garment " + std::to_string(garment));
    }
    garments_.erase(it);
    note_garments();
}

const GarmentCloth& ClothWorld::garment(std::uint32_t handle) const {
    for (const Entry& entry : garments_) {
        if (entry.handle == handle) {
            return entry.cloth;
        }
    }
    throw Error("there is no garment " + std::to_string(handle));
}

void ClothWorld::note_garments() {
    known_.clear();
    for (const Entry& entry : garments_) {
        known_.push_back({entry.handle, entry.cloth.vertex_count()});
    }
}

ClothWorld::Entry* ClothWorld::find(std::uint32_t handle) noexcept {
    for (Entry& entry : garments_) {
        if (entry.handle == handle) {
            return &entry;
        }
    }
    return nullptr;
}

StepResult ClothWorld::step(const StepInput& input) noexcept {
    StepResult result = cloth::check_step(input, body_ ? body_->vertex_count() : 0, known_);
    if (result != StepResult::ok) {
        return result;
    }
    const std::uint32_t count = rounds(input.dt_s, settings_.substep_rate);
    const auto substep = static_cast<float>(input.dt_s / count);
    body_->set_motion(input.body_before, input.body_after, static_cast<float>(input.dt_s));
    for (const GarmentFrame& frame : input.garments) {
        Entry& entry = *find(frame.garment);
        entry.cloth.begin_step(frame.targets, substep);
        if (input.reset || entry.fresh) {
            entry.cloth.reset();
            entry.fresh = false;
        }
    }
    const float since_last = substep > 0.0f ? simulate(input.dt_s) : 0.0f;
    body_->place(1.0f);
    for (const GarmentFrame& frame : input.garments) {
        Entry& entry = *find(frame.garment);
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
