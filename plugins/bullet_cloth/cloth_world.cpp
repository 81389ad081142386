#include "bullet_cloth/cloth_world.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::bullet_cloth {
namespace {

constexpr double kLongestStep = 1.0; // s
constexpr float kFarthest = 1000.0f; // m

bool sound(std::span<const Vec3f> points) {
    // NaN fails every comparison.
    return std::all_of(points.begin(), points.end(), [](const Vec3f& p) {
        return std::abs(p.x()) < kFarthest && std::abs(p.y()) < kFarthest &&
               std::abs(p.z()) < kFarthest;
    });
}

std::uint32_t rounds(double dt_s, double rate) {
    return static_cast<std::uint32_t>(std::max(1.0, std::round(dt_s * rate)));
}

void write_out(const GarmentCloth& cloth, const GarmentFrame& frame) {
    for (std::size_t v = 0; v < cloth.vertex_count(); ++v) {
        frame.positions[v] = cloth.positions()[v].head<3>();
    }
    std::fill(frame.normals.begin(), frame.normals.end(), Vec3f::Zero());
    for (const Triangle& corner : cloth.triangles()) {
        const Vec3f a = frame.positions[corner[0]];
        const Vec3f area = (frame.positions[corner[1]] - a).cross(frame.positions[corner[2]] - a);
        for (const std::uint32_t v : corner) {
            frame.normals[v] += area;
        }
    }
    for (Vec3f& normal : frame.normals) {
        const float length = normal.norm();
        normal = length > 0.0f ? Vec3f(normal / length) : Vec3f::UnitY();
    }
}

} // namespace

const char* step_result_text(StepResult result) noexcept {
    switch (result) {
    case StepResult::ok:
        return "done";
    case StepResult::recovered:
        return "a garment was not finite and began anew from its targets";
    case StepResult::no_body:
        return "step: no body; call set_body first";
    case StepResult::body_count:
        return "step: the posed body has another vertex count than the body that was set";
    case StepResult::body_values:
        return "step: a position of the posed body is not finite or out of range";
    case StepResult::time:
        return "step: dt must be greater than 0 and at most 1 s; pass the reset flag after a gap";
    case StepResult::garment_count:
        return "step: must name every garment of the world exactly once";
    case StepResult::unknown_garment:
        return "step: names a garment that was not added or was removed";
    case StepResult::target_count:
        return "step: a garment's targets have another count than its vertices";
    case StepResult::target_values:
        return "step: a target is not finite or out of range";
    case StepResult::output_count:
        return "step: a garment's output buffers have another count than its vertices";
    }
    return "unknown";
}

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
    return next_handle_++;
}

void ClothWorld::remove_garment(std::uint32_t garment) {
    const auto it = std::find_if(garments_.begin(), garments_.end(),
                                 [&](const Entry& entry) { return entry.handle == garment; });
    if (it == garments_.end()) {
        throw Error("remove_garment: there is no garment " + std::to_string(garment));
    }
    garments_.erase(it);
}

const GarmentCloth& ClothWorld::garment(std::uint32_t handle) const {
    for (const Entry& entry : garments_) {
        if (entry.handle == handle) {
            return entry.cloth;
        }
    }
    throw Error("there is no garment " + std::to_string(handle));
}

ClothWorld::Entry* ClothWorld::find(std::uint32_t handle) noexcept {
    for (Entry& entry : garments_) {
        if (entry.handle == handle) {
            return &entry;
        }
    }
    return nullptr;
}

StepResult ClothWorld::check(const StepInput& input) const noexcept {
    if (!body_) {
        return StepResult::no_body;
    }
    if (input.body_before.size() != body_->vertex_count() ||
        input.body_after.size() != body_->vertex_count()) {
        return StepResult::body_count;
    }
    if (!sound(input.body_before) || !sound(input.body_after)) {
        return StepResult::body_values;
    }
    const bool first = input.reset && input.dt_s == 0.0;
    if (!first && !(input.dt_s > 0.0 && input.dt_s <= kLongestStep)) {
        return StepResult::time;
    }
    if (input.garments.size() != garments_.size()) {
        return StepResult::garment_count;
    }
    for (const GarmentFrame& frame : input.garments) {
        const auto same = [&](const auto& other) { return other.garment == frame.garment; };
        const auto known =
            std::find_if(garments_.begin(), garments_.end(),
                         [&](const Entry& entry) { return entry.handle == frame.garment; });
        if (known == garments_.end()) {
            return StepResult::unknown_garment;
        }
        if (std::count_if(input.garments.begin(), input.garments.end(), same) != 1) {
            return StepResult::garment_count;
        }
        const std::size_t count = known->cloth.vertex_count();
        if (frame.targets.size() != count) {
            return StepResult::target_count;
        }
        if (!sound(frame.targets)) {
            return StepResult::target_values;
        }
        if (frame.positions.size() != count || frame.normals.size() != count) {
            return StepResult::output_count;
        }
    }
    return StepResult::ok;
}

StepResult ClothWorld::step(const StepInput& input) noexcept {
    StepResult result = check(input);
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
        write_out(entry.cloth, frame);
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
