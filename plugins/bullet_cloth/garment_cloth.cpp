#include "bullet_cloth/garment_cloth.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace toile::bullet_cloth {
namespace {

/// How many substeps share one pass of the fabric's damping.
constexpr std::uint32_t kDampEvery = 4;

Vec4 to_vec4(const Vec3f& p) {
    return {p.x(), p.y(), p.z(), 0.0f};
}

} // namespace

GarmentCloth::GarmentCloth(const GarmentInput& input, const MovingBody& rest_body,
                           const Settings& settings)
    : settings_(settings), fabric_(input.fabric),
      contact_(cloth::contact_settings(input, static_cast<float>(settings.margin),
                                       static_cast<float>(settings.friction_scale))),
      start_(input.mesh.positions.begin(), input.mesh.positions.end()),
      model_(make_cloth_model(input.mesh, input.fabric, static_cast<float>(settings.limit_edges))),
      attachment_(cloth::attachments(input)),
      inverse_mass_(cloth::inverse_masses(model_.mass, attachment_)),
      links_(start_, inverse_mass_, model_.stretch, model_.bend),
      contacts_(input.mesh.triangles, start_.size(), input.joints, input.weights),
      cover_(input.mesh.triangles.size()), leash_(static_cast<float>(settings.leash)) {
    contacts_.bind(rest_body, start_);
    for (std::vector<Vec4>* buffer : {&x_, &q_, &target_before_, &target_after_}) {
        buffer->resize(start_.size());
        std::transform(start_.begin(), start_.end(), buffer->begin(), to_vec4);
    }
    v_.assign(start_.size(), Vec4::Zero());
}

void GarmentCloth::begin_step(std::span<const Vec3f> targets, float substep) noexcept {
    target_before_.swap(target_after_);
    std::transform(targets.begin(), targets.end(), target_after_.begin(), to_vec4);
    if (substep > 0.0f) {
        links_.set_substep(substep);
    }
}

void GarmentCloth::reset() noexcept {
    std::copy(target_after_.begin(), target_after_.end(), target_before_.begin());
    std::copy(target_after_.begin(), target_after_.end(), x_.begin());
    std::copy(target_after_.begin(), target_after_.end(), q_.begin());
    std::fill(v_.begin(), v_.end(), Vec4::Zero());
    contacts_.reset();
}

void GarmentCloth::advance(const MovingBody& body, const Interval& interval) noexcept {
    const float length = static_cast<float>(interval.last - interval.first) * interval.substep;
    // The last refresh stood at the end of the last frame or in the middle of the last interval.
    const float since_last = interval.index == 0 ? 0.5f * length : length;
    period_ = length * static_cast<float>(interval.of);
    contacts_.refresh(
        body, x_, v_,
        {0.5f * length, since_last, 0.5f * length, period_, interval.index, interval.of, false},
        contact_);
    for (std::uint32_t s = interval.first; s < interval.last; ++s) {
        const float fraction = static_cast<float>(s + 1) / static_cast<float>(interval.count);
        const float since =
            static_cast<float>(s + 1 - interval.first) * interval.substep - 0.5f * length;
        predict(fraction, interval.substep);
        limit_lengths();
        links_.solve(x_);
        follow_targets(fraction, 1.0f / static_cast<float>(interval.count), interval.substep);
        contacts_.resolve({x_, q_, inverse_mass_}, since, interval.substep, contact_);
        update_velocities(interval.substep, (s + 1) % kDampEvery == 0);
    }
}

void GarmentCloth::predict(float fraction, float substep) noexcept {
    const Vec4 fall(0.0f, static_cast<float>(-settings_.gravity) * substep, 0.0f, 0.0f);
    const float keep = 1.0f / (1.0f + static_cast<float>(settings_.air_drag) * substep);
    for (std::size_t i = 0; i < x_.size(); ++i) {
        q_[i] = x_[i];
        if (inverse_mass_[i] > 0.0f) {
            x_[i] += substep * keep * (v_[i] + fall);
        } else {
            x_[i] = target(i, fraction);
        }
    }
}

/// One-sided: cloth folds, but is never longer than its material.
void GarmentCloth::limit_lengths() noexcept {
    for (const LengthLimit& limit : model_.limits) {
        const Vec4 apart = x_[limit.b] - x_[limit.a];
        const float squared = apart.squaredNorm();
        const float weight = inverse_mass_[limit.a] + inverse_mass_[limit.b];
        if (squared <= limit.longest * limit.longest || weight <= 0.0f) {
            continue;
        }
        const float length = std::sqrt(squared);
        const Vec4 pull = ((length - limit.longest) / (length * weight)) * apart;
        x_[limit.a] += inverse_mass_[limit.a] * pull;
        x_[limit.b] -= inverse_mass_[limit.b] * pull;
    }
}

/// A damped implicit spring where the cloth is partly attached, and the leash everywhere.
void GarmentCloth::follow_targets(float fraction, float share, float substep) noexcept {
    for (std::size_t i = 0; i < x_.size(); ++i) {
        if (inverse_mass_[i] <= 0.0f) {
            continue;
        }
        const Vec4 goal = target(i, fraction);
        const float attached = attachment_[i];
        if (attached > 0.0f) {
            const float rate =
                static_cast<float>(settings_.pull_rate) * attached / (1.0f - attached) * substep;
            const Vec4 moved = x_[i] - q_[i] - share * (target_after_[i] - target_before_[i]);
            x_[i] += (rate * rate * (goal - x_[i]) - 2.0f * rate * moved) /
                     (1.0f + 2.0f * rate + rate * rate);
        }
        const float leash = leash_ * (1.0f - attached);
        const Vec4 off = x_[i] - goal;
        const float squared = off.squaredNorm();
        if (squared > leash * leash) {
            x_[i] = goal + (leash / std::sqrt(squared)) * off;
        }
    }
}

void GarmentCloth::update_velocities(float substep, bool damp) noexcept {
    constexpr float kFastest = 30.0f; // m/s
    const float per_second = 1.0f / substep;
    for (std::size_t i = 0; i < x_.size(); ++i) {
        v_[i] = per_second * (x_[i] - q_[i]);
        const float squared = v_[i].squaredNorm();
        if (squared > kFastest * kFastest) {
            v_[i] *= kFastest / std::sqrt(squared);
        }
    }
    if (!damp) {
        return;
    }
    // Neighbours lose their relative velocity; momentum is kept.
    const float rate = fabric_.damping * static_cast<float>(settings_.damping_scale);
    const float share = 1.0f - std::exp(-rate * substep * static_cast<float>(kDampEvery));
    for (const Spring& edge : model_.stretch) {
        const float wa = inverse_mass_[edge.a];
        const float wb = inverse_mass_[edge.b];
        const float weight = wa + wb;
        if (weight > 0.0f) {
            const Vec4 change = (share / weight) * (v_[edge.b] - v_[edge.a]);
            v_[edge.a] += wa * change;
            v_[edge.b] -= wb * change;
        }
    }
}

void GarmentCloth::clean_up(const MovingBody& body, float since_last) noexcept {
    cloth::ContactSettings still = contact_;
    still.friction = 0.0f;
    contacts_.refresh(body, x_, v_, {0.0f, since_last, 0.0f, period_, 0, 1, true}, still);
    std::copy(x_.begin(), x_.end(), q_.begin());
    const auto passes = static_cast<int>(settings_.clean_passes);
    cover_.find(body, contacts_, x_);
    for (int pass = 0; pass < passes; ++pass) {
        cover_.lift(body, contacts_.triangles(), x_, inverse_mass_);
        contacts_.resolve({x_, q_, inverse_mass_}, 0.0f, 0.0f, still);
    }
}

bool GarmentCloth::finite() const noexcept {
    Vec4 sum = Vec4::Zero();
    for (std::size_t i = 0; i < x_.size(); ++i) {
        sum += 0.0f * x_[i] + 0.0f * v_[i];
    }
    return sum.isZero();
}

} // namespace toile::bullet_cloth
