#include "xpbd_cloth/garment_cloth.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::xpbd_cloth {
namespace {

Vec4 to_vec4(const Vec3f& p) {
    return {p.x(), p.y(), p.z(), 0.0f};
}

/// (nv) kg, lumped; vertices of no triangle get the mean.
std::vector<float> lumped_masses(const ClothMesh& mesh, const Fabric& fabric) {
    cloth::check(mesh, fabric);
    std::vector<float> mass(mesh.positions.size(), 0.0f);
    float sum = 0.0f;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec2f, 3> corner = cloth::material_corners(mesh, t);
        const Vec2f u = corner[1] - corner[0];
        const Vec2f v = corner[2] - corner[0];
        const float share = fabric.density * std::abs(u.x() * v.y() - u.y() * v.x()) / 6.0f;
        sum += 3.0f * share;
        for (const std::uint32_t vertex : mesh.triangles[t]) {
            mass[vertex] += share;
        }
    }
    const auto used = std::count_if(mass.begin(), mass.end(), [](float m) { return m > 0.0f; });
    if (used == 0) {
        throw Error("garment mesh: no triangle has area in its material coordinates");
    }
    for (float& m : mass) {
        m = m > 0.0f ? m : sum / static_cast<float>(used);
    }
    return mass;
}

std::vector<Link> seam_links(const GarmentInput& input) {
    std::vector<Link> links;
    const float stiffness = 0.5f * (input.fabric.stretch_warp + input.fabric.stretch_weft);
    for (const auto& seam : input.mesh.seams) {
        if (seam[0] != seam[1]) {
            links.push_back({seam[0], seam[1], 0.0f, stiffness});
        }
    }
    return links;
}

/// Edges may get `strain_limit` longer than their material; so may the ways over `limit_edges`
/// mean edges, and these are pulled first, so that the near ones have little left to do.
std::vector<Link> length_limits(const ClothMesh& mesh, float mean_edge, const Settings& settings) {
    std::vector<Link> links;
    const auto longest = 1.0f + static_cast<float>(settings.strain_limit);
    if (settings.strain_limit <= 0.0) {
        return links;
    }
    if (settings.limit_edges > 0.0) {
        for (const cloth::LengthLimit& limit :
             cloth::make_length_limits(mesh.positions.size(), material_paths(mesh),
                                       static_cast<float>(settings.limit_edges) * mean_edge)) {
            links.push_back({limit.a, limit.b, longest * limit.longest, 0.0f});
        }
    }
    for (const Edge& edge : material_edges(mesh)) {
        links.push_back({edge.a, edge.b, longest * edge.rest, 0.0f});
    }
    return links;
}

/// Openings carry a garment's weight along their edge, where a pass gets from one vertex to the
/// next only; there are few of these edges, so they get many passes.
std::vector<Link> border_limits(const ClothMesh& mesh, float strain_limit) {
    std::vector<Link> links;
    for (const Edge& edge : material_edges(mesh)) {
        if (edge.border && strain_limit > 0.0f) {
            links.push_back({edge.a, edge.b, (1.0f + strain_limit) * edge.rest, 0.0f});
        }
    }
    return links;
}

float mean_length(const ClothMesh& mesh) {
    double sum = 0.0;
    const std::vector<Edge> edges = material_edges(mesh);
    for (const Edge& edge : edges) {
        sum += edge.rest;
    }
    return static_cast<float>(sum / static_cast<double>(edges.size()));
}

} // namespace

GarmentCloth::GarmentCloth(const GarmentInput& input, const MovingBody& rest_body,
                           const Settings& settings)
    : settings_(settings), fabric_(input.fabric), layer_(input.layer),
      contact_(cloth::contact_settings(input, static_cast<float>(settings.margin),
                                       static_cast<float>(settings.friction_scale))),
      start_(input.mesh.positions.begin(), input.mesh.positions.end()),
      attachment_(cloth::attachments(input)), mass_(lumped_masses(input.mesh, input.fabric)),
      inverse_mass_(cloth::inverse_masses(mass_, attachment_)), mean_edge_(mean_length(input.mesh)),
      membrane_(input.mesh, input.fabric, inverse_mass_),
      bending_(input.mesh, input.fabric, inverse_mass_),
      seams_(seam_links(input), inverse_mass_, false),
      limits_(length_limits(input.mesh, mean_edge_, settings), inverse_mass_, true),
      borders_(border_limits(input.mesh, static_cast<float>(settings.strain_limit)), inverse_mass_,
               true),
      damping_(material_edges(input.mesh), inverse_mass_),
      contacts_(input.mesh.triangles, start_.size(), input.joints, input.weights),
      cover_(input.mesh.triangles.size()) {
    contacts_.bind(rest_body, start_);
    for (std::vector<Vec4>* buffer : {&target_before_, &target_after_}) {
        buffer->resize(start_.size());
        std::transform(start_.begin(), start_.end(), buffer->begin(), to_vec4);
    }
}

double GarmentCloth::substep_rate() const noexcept {
    return settings_.substep_rate > 0.0
               ? settings_.substep_rate
               : std::clamp(settings_.wave_speed / static_cast<double>(mean_edge_), 480.0, 6000.0);
}

void GarmentCloth::begin_step(std::span<const Vec3f> targets, float substep) noexcept {
    target_before_.swap(target_after_);
    std::transform(targets.begin(), targets.end(), target_after_.begin(), to_vec4);
    if (substep > 0.0f) {
        membrane_.set_substep(substep);
        bending_.set_substep(2.0f * substep); // a pass serves two
        seams_.set_substep(substep);
        limits_.set_substep(substep);
        borders_.set_substep(substep);
    }
}

void GarmentCloth::reset() noexcept {
    std::copy(target_after_.begin(), target_after_.end(), target_before_.begin());
    std::copy(target_after_.begin(), target_after_.end(), rows_.x.begin());
    std::copy(target_after_.begin(), target_after_.end(), rows_.q.begin());
    std::fill(rows_.v.begin(), rows_.v.end(), Vec4::Zero());
    since_damped_ = 0.0f;
    bends_ = true;
    contacts_.reset();
}

void GarmentCloth::find_contacts(const MovingBody& body, const Interval& interval) noexcept {
    const float half = 0.5f * interval.length();
    // The last refresh stood at the end of the last frame or in the middle of the last interval.
    const float since_last = interval.index == 0 ? half : 2.0f * half;
    period_ = interval.length() * static_cast<float>(interval.of);
    const std::size_t count = start_.size();
    contacts_.refresh(
        body, rows_.x.first(count), rows_.v.first(count),
        {half, since_last, half, period_, interval.index, interval.of, false, interval.frame},
        contact_);
}

void GarmentCloth::move(float fraction, float share, float substep) noexcept {
    predict(fraction, substep);
    if (bends_) {
        bending_.solve(rows_.x);
    }
    bends_ = !bends_;
    seams_.solve(rows_.x);
    membrane_.solve(rows_.x);
    limits_.solve(rows_.x);
    for (int pass = 0; pass < static_cast<int>(settings_.border_passes); ++pass) {
        borders_.solve(rows_.x);
    }
    follow_targets(fraction, share, substep);
}

void GarmentCloth::predict(float fraction, float substep) noexcept {
    const Vec4 fall(0.0f, static_cast<float>(-settings_.gravity) * substep, 0.0f, 0.0f);
    const float keep = 1.0f / (1.0f + static_cast<float>(settings_.air_drag) * substep);
    for (std::size_t i = 0; i < start_.size(); ++i) {
        rows_.q[i] = rows_.x[i];
        if (inverse_mass_[i] > 0.0f) {
            rows_.x[i] += substep * keep * (rows_.v[i] + fall);
        } else {
            rows_.x[i] = target(i, fraction);
        }
    }
}

/// A damped implicit spring where the cloth is partly attached, and the leash everywhere.
void GarmentCloth::follow_targets(float fraction, float share, float substep) noexcept {
    for (std::size_t i = 0; i < start_.size(); ++i) {
        if (inverse_mass_[i] <= 0.0f) {
            continue;
        }
        Vec4& x = rows_.x[i];
        const Vec4 goal = target(i, fraction);
        const float attached = attachment_[i];
        if (attached > 0.0f) {
            const float rate =
                static_cast<float>(settings_.pull_rate) * attached / (1.0f - attached) * substep;
            const Vec4 moved = x - rows_.q[i] - share * (target_after_[i] - target_before_[i]);
            x += (rate * rate * (goal - x) - 2.0f * rate * moved) /
                 (1.0f + 2.0f * rate + rate * rate);
        }
        const float leash = static_cast<float>(settings_.leash) * (1.0f - attached);
        const Vec4 off = x - goal;
        const float squared = off.squaredNorm();
        if (squared > leash * leash) {
            x = goal + (leash / std::sqrt(squared)) * off;
        }
    }
}

void GarmentCloth::meet_body(float since, float substep) noexcept {
    const std::size_t count = start_.size();
    contacts_.resolve({rows_.x.first(count), rows_.q.first(count), inverse_mass_}, since, substep,
                      contact_);
}

void GarmentCloth::update_velocities(float substep, bool damp) noexcept {
    constexpr float kFastest = 30.0f; // m/s
    const float per_second = 1.0f / substep;
    for (std::size_t i = 0; i < start_.size(); ++i) {
        Vec4& v = rows_.v[i];
        v = per_second * (rows_.x[i] - rows_.q[i]);
        const float squared = v.squaredNorm();
        if (squared > kFastest * kFastest) {
            v *= kFastest / std::sqrt(squared);
        }
    }
    since_damped_ += substep;
    if (damp) {
        const float rate = fabric_.damping * static_cast<float>(settings_.damping_scale);
        if (rate > 0.0f) {
            damping_.apply(rows_.v, 1.0f - std::exp(-rate * since_damped_));
        }
        since_damped_ = 0.0f;
    }
}

void GarmentCloth::clean_up(const MovingBody& body, float since_last) noexcept {
    cloth::ContactSettings still = contact_;
    still.friction = 0.0f;
    const std::size_t count = start_.size();
    const std::span<Vec4> x = rows_.x.first(count);
    const std::span<Vec4> q = rows_.q.first(count);
    contacts_.refresh(body, x, rows_.v.first(count),
                      {0.0f, since_last, 0.0f, period_, 0, 1, true, 1}, still);
    std::copy(x.begin(), x.end(), q.begin());
    cover_.find(body, contacts_, x, 0.008f);
    for (int pass = 0; pass < static_cast<int>(settings_.clean_passes); ++pass) {
        cover_.lift(body, contacts_.triangles(), x, inverse_mass_);
        contacts_.resolve({x, q, inverse_mass_}, 0.0f, 0.0f, still);
    }
}

bool GarmentCloth::finite() const noexcept {
    Vec4 sum = Vec4::Zero();
    for (std::size_t i = 0; i < start_.size(); ++i) {
        sum += 0.0f * rows_.x[i] + 0.0f * rows_.v[i];
    }
    return sum.isZero();
}

} // namespace toile::xpbd_cloth
