#include "xpbd_cloth/cloth_world.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::xpbd_cloth {
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
    const std::uint32_t handle = garments_.add(GarmentCloth(input, *rest_body_, settings_));
    arrange();
    return handle;
}

void ClothWorld::remove_garment(std::uint32_t garment) {
    garments_.remove(garment);
    arrange();
}

void ClothWorld::arrange() {
    std::size_t total = 0;
    for (const Entry& entry : garments_) {
        total += entry.cloth.vertex_count() + 1;
    }
    std::vector<Vec4> x(total, Vec4::Zero());
    std::vector<Vec4> q(total, Vec4::Zero());
    std::vector<Vec4> v(total, Vec4::Zero());
    std::size_t first = 0;
    for (Entry& entry : garments_) {
        const std::size_t rows = entry.cloth.vertex_count() + 1;
        if (!entry.fresh) {
            std::copy_n(x_.begin() + std::ptrdiff_t(entry.first), rows,
                        x.begin() + std::ptrdiff_t(first));
            std::copy_n(q_.begin() + std::ptrdiff_t(entry.first), rows,
                        q.begin() + std::ptrdiff_t(first));
            std::copy_n(v_.begin() + std::ptrdiff_t(entry.first), rows,
                        v.begin() + std::ptrdiff_t(first));
        }
        entry.first = first;
        first += rows;
    }
    x_.swap(x);
    q_.swap(q);
    v_.swap(v);
    std::vector<cloth::ClothPart> parts;
    for (const Entry& entry : garments_) {
        const GarmentCloth& cloth = entry.cloth;
        parts.push_back({entry.first, cloth.start(), cloth.triangles(), cloth.inverse_mass(),
                         cloth.layer(), cloth.mean_edge(), cloth.thickness(), cloth.friction()});
    }
    cloth_contacts_.arrange(parts, total);
    for (Entry& entry : garments_) {
        const std::size_t rows = entry.cloth.vertex_count() + 1;
        entry.cloth.use({std::span(x_).subspan(entry.first, rows),
                         std::span(q_).subspan(entry.first, rows),
                         std::span(v_).subspan(entry.first, rows)});
    }
}

std::uint32_t ClothWorld::substeps_of(double dt_s) const noexcept {
    double rate = 1.0;
    for (const Entry& entry : garments_) {
        rate = std::max(rate, entry.cloth.substep_rate());
    }
    return rounds(dt_s, rate);
}

StepResult ClothWorld::step(const StepInput& input) noexcept {
    StepResult result =
        cloth::check_step(input, body_ ? body_->vertex_count() : 0, garments_.known());
    if (result != StepResult::ok) {
        return result;
    }
    const std::uint32_t count = substeps_of(input.dt_s);
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
    if (input.reset) {
        cloth_contacts_.reset();
    }
    frame_ = input.reset ? 1 : frame_ % 4096 + 1;
    const float since_last = substep > 0.0f ? simulate(input.dt_s, count) : 0.0f;
    body_->place(1.0f);
    for (const GarmentFrame& frame : input.garments) {
        Entry& entry = *garments_.find(frame.garment);
        if (!entry.cloth.finite()) {
            entry.cloth.reset();
            result = StepResult::recovered;
        }
        entry.cloth.clean_up(*body_, since_last);
        cloth::write_frame(entry.cloth.positions(), entry.cloth.triangles(), frame,
                           entry.cloth.vertices());
    }
    return result;
}

float ClothWorld::simulate(double dt_s, std::uint32_t substeps) noexcept {
    const std::uint32_t intervals = std::min(substeps, rounds(dt_s, settings_.contact_rate));
    const auto substep = static_cast<float>(dt_s / substeps);
    const float share = 1.0f / static_cast<float>(substeps);
    std::uint32_t done = 0;
    float last_half = 0.0f;
    for (std::uint32_t i = 0; i < intervals; ++i) {
        const std::uint32_t end = substeps * (i + 1) / intervals;
        const Interval interval{i, intervals, end - done, substep, frame_};
        last_half = 0.5f * interval.length();
        body_->place(0.5f * share * static_cast<float>(done + end));
        for (Entry& entry : garments_) {
            entry.cloth.find_contacts(*body_, interval);
        }
        if (settings_.self_contact > 0.0) {
            cloth_contacts_.find(x_, v_, interval.length());
        }
        for (std::uint32_t s = done; s < end; ++s) {
            const Substep now{s,
                              s + 1 == substeps,
                              s + 1 == end,
                              frame_ == 1,
                              substep,
                              share * static_cast<float>(s + 1),
                              share,
                              static_cast<float>(s + 1 - done) * substep - last_half};
            for (Entry& entry : garments_) {
                entry.cloth.move(now);
            }
            if (settings_.self_contact > 0.0) {
                cloth_contacts_.resolve(x_, q_);
            }
            for (Entry& entry : garments_) {
                entry.cloth.meet_body(now);
                entry.cloth.update_velocities(now);
            }
        }
        done = end;
    }
    return last_half;
}

} // namespace toile::xpbd_cloth
