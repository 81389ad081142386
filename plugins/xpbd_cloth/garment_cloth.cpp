#include "xpbd_cloth/garment_cloth.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::xpbd_cloth {
namespace {

// What need not be done in every substep: one pass serves so many.
constexpr float kBendPeriod = 0.0021f; // s; a fold is slower than a pull
constexpr std::uint32_t kBendLeast = 2, kBendMost = 2;
constexpr std::uint32_t kDampEvery = 4;
constexpr float kCentreEdge = 0.015f;      // m, shorter edges need no contact at triangle centres
constexpr std::uint32_t kCentresEvery = 4; ///< between its corners cloth hardly sags into the body

constexpr double kMostSubsteps = 2200.0; // 1/s; fine cloth holds its strain with fewer a wave

constexpr float kHard = std::numeric_limits<float>::infinity(); // N/m

Vec4 to_vec4(const Vec3f& p) {
    return {p.x(), p.y(), p.z(), 0.0f};
}

/// Of what moved from q to x.
[[gnu::always_inline]] inline Vec4 velocity(const Vec4& x, const Vec4& q, float per_second) {
    constexpr float kFastest = 30.0f; // m/s
    const Vec4 v = per_second * (x - q);
    const float squared = v.squaredNorm();
    return squared > kFastest * kFastest ? Vec4((kFastest / std::sqrt(squared)) * v) : v;
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
    for (const auto& seam : input.mesh.seams) {
        if (seam[0] != seam[1]) {
            links.push_back({seam[0], seam[1], 0.0f});
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
            links.push_back({limit.a, limit.b, longest * limit.longest});
        }
    }
    for (const Edge& edge : material_edges(mesh)) {
        links.push_back({edge.a, edge.b, longest * edge.rest});
    }
    return links;
}

/// Openings carry a garment's weight along their edge, where a pass gets from one vertex to the
/// next only; there are few of these edges, so they get many passes.
std::vector<Link> border_limits(const ClothMesh& mesh, float strain_limit) {
    std::vector<Link> links;
    for (const Edge& edge : material_edges(mesh)) {
        if (edge.border && strain_limit > 0.0f) {
            links.push_back({edge.a, edge.b, (1.0f + strain_limit) * edge.rest});
        }
    }
    return links;
}

/// What friction on the skin held in the substeps and still is too long is drawn in at the end.
std::vector<Link> edge_limits(const ClothMesh& mesh, const Settings& settings) {
    constexpr float kSlack = 0.05f;
    std::vector<Link> links;
    if (settings.strain_limit <= 0.0) {
        return links;
    }
    for (const Edge& edge : material_edges(mesh)) {
        links.push_back({edge.a, edge.b,
                         (1.0f + kSlack + static_cast<float>(settings.strain_limit)) * edge.rest});
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

GarmentCloth::GarmentCloth(const OrderedGarment& ordered, const MovingBody& rest_body,
                           const Settings& settings)
    : settings_(settings), fabric_(ordered.input().fabric), layer_(ordered.input().layer),
      contact_(cloth::contact_settings(ordered.input(), static_cast<float>(settings.margin),
                                       static_cast<float>(settings.friction_scale))),
      vertex_(ordered.vertex),
      start_(ordered.input().mesh.positions.begin(), ordered.input().mesh.positions.end()),
      attachment_(cloth::attachments(ordered.input())),
      mass_(lumped_masses(ordered.input().mesh, fabric_)),
      inverse_mass_(cloth::inverse_masses(mass_, attachment_)),
      mean_edge_(mean_length(ordered.input().mesh)), membrane_(ordered.input().mesh, fabric_),
      bending_(ordered.input().mesh, fabric_, inverse_mass_),
      seams_(seam_links(ordered.input()), start_.size(),
             0.5f * (fabric_.stretch_warp + fabric_.stretch_weft), false),
      limits_(length_limits(ordered.input().mesh, mean_edge_, settings), start_.size(), kHard,
              true),
      borders_(border_limits(ordered.input().mesh, static_cast<float>(settings.strain_limit)),
               start_.size(), kHard, true),
      last_limits_(edge_limits(ordered.input().mesh, settings), start_.size(), kHard, true),
      damping_(material_edges(ordered.input().mesh), inverse_mass_),
      contacts_(ordered.input().mesh.triangles, start_.size(), ordered.input().joints,
                ordered.input().weights, mean_edge_ > kCentreEdge),
      cover_(ordered.input().mesh.triangles.size()) {
    contacts_.bind(rest_body, start_);
    for (std::uint32_t v = 0; v < start_.size(); ++v) {
        if (inverse_mass_[v] <= 0.0f) {
            held_.push_back(v);
            continue;
        }
        free_.push_back(v);
        if (attachment_[v] > 0.0f) {
            pulled_.push_back(v);
        }
    }
    leashed_.reserve(free_.size());
    for (std::vector<Vec4>* buffer : {&target_before_, &target_after_, &noted_, &mean_velocity_}) {
        buffer->resize(start_.size());
        std::transform(start_.begin(), start_.end(), buffer->begin(), to_vec4);
    }
}

double GarmentCloth::substep_rate() const noexcept {
    return settings_.substep_rate > 0.0
               ? settings_.substep_rate
               : std::clamp(settings_.wave_speed / static_cast<double>(mean_edge_), 480.0,
                            kMostSubsteps);
}

void GarmentCloth::begin_step(std::span<const Vec3f> targets, float substep) noexcept {
    target_before_.swap(target_after_);
    std::transform(vertex_.begin(), vertex_.end(), target_after_.begin(),
                   [&](std::uint32_t v) { return to_vec4(targets[v]); });
    if (substep > 0.0f) {
        membrane_.set_substep(substep);
        bend_every_ = static_cast<std::uint32_t>(
            std::clamp(std::round(kBendPeriod / substep), float(kBendLeast), float(kBendMost)));
        bending_.set_substep(static_cast<float>(bend_every_) * substep);
        seams_.set_substep(substep);
    }
}

void GarmentCloth::reset() noexcept {
    std::copy(target_after_.begin(), target_after_.end(), target_before_.begin());
    std::copy(target_after_.begin(), target_after_.end(), rows_.x.begin());
    std::copy(target_after_.begin(), target_after_.end(), rows_.q.begin());
    std::fill(rows_.v.begin(), rows_.v.end(), Vec4::Zero());
    since_damped_ = 0.0f;
    velocities_known_ = true;
    std::copy(target_after_.begin(), target_after_.end(), noted_.begin());
    since_noted_ = 0.0f;
    contacts_.reset();
}

void GarmentCloth::find_contacts(const MovingBody& body, const Interval& interval) noexcept {
    const float half = 0.5f * interval.length();
    // The last refresh stood at the end of the last frame or in the middle of the last interval.
    const float since_last = interval.index == 0 ? half : 2.0f * half;
    if (interval.index == 0) {
        find_stretched_leashes();
    }
    period_ = interval.length() * static_cast<float>(interval.of);
    const std::size_t count = start_.size();
    note_motion(interval.length());
    contacts_.refresh(
        body, rows_.x.first(count), mean_velocity_,
        {half, since_last, half, period_, interval.index, interval.of, false, interval.frame},
        contact_);
}

/// The velocity of one substep trembles, and over an interval that adds up to centimetres: what
/// lies ahead is told from the way that the cloth went since the last look.
void GarmentCloth::note_motion(float until_next) noexcept {
    const float per_second = since_noted_ > 0.0f ? 1.0f / since_noted_ : 0.0f;
    for (std::size_t i = 0; i < start_.size(); ++i) {
        mean_velocity_[i] = per_second * (rows_.x[i] - noted_[i]);
        noted_[i] = rows_.x[i];
    }
    since_noted_ = until_next;
}

void GarmentCloth::move(const Substep& now) noexcept {
    predict(now);
    if (now.index % bend_every_ == 0) {
        bending_.solve(rows_.x);
    }
    seams_.solve(rows_.x);
    membrane_.solve(rows_.x);
    limits_.solve(rows_.x);
    for (int pass = 0; pass < static_cast<int>(settings_.border_passes); ++pass) {
        borders_.solve(rows_.x);
    }
    unweigh();
    follow_targets(now);
    hold_on_leash(now.last ? free_ : leashed_, now.fraction);
}

/// Velocities are written down only where something reads them before the next substep.
void GarmentCloth::predict(const Substep& now) noexcept {
    const Vec4 fall(0.0f, static_cast<float>(-settings_.gravity) * now.length, 0.0f, 0.0f);
    const float keep = now.length / (1.0f + static_cast<float>(settings_.air_drag) * now.length);
    // A garment that was bound to a body it does not fit would leap as it is let go: it finds its
    // shape first, and gathers no other speed than that of a fall.
    const Vec4 fallen = static_cast<float>(now.index) * fall;
    const float per_second = 1.0f / now.length;
    for (std::size_t i = 0; i < start_.size(); ++i) {
        Vec4 x = rows_.x[i];
        Vec4 v = velocities_known_ ? rows_.v[i] : velocity(x, rows_.q[i], per_second);
        v = now.settles ? fallen : v;
        rows_.q[i] = x;
        x += keep * (v + fall);
        x.w() = inverse_mass_[i];
        rows_.x[i] = x;
    }
    for (const std::uint32_t i : held_) {
        rows_.x[i] = target(i, now.fraction); // of weight 0
    }
}

void GarmentCloth::weigh() noexcept {
    for (std::size_t i = 0; i < start_.size(); ++i) {
        rows_.x[i].w() = inverse_mass_[i];
    }
}

void GarmentCloth::unweigh() noexcept {
    for (std::size_t i = 0; i < start_.size(); ++i) {
        rows_.x[i].w() = 0.0f;
    }
}

/// A damped implicit spring where the cloth is partly attached.
void GarmentCloth::follow_targets(const Substep& now) noexcept {
    for (const std::uint32_t i : pulled_) {
        const float rate = static_cast<float>(settings_.pull_rate) * attachment_[i] /
                           (1.0f - attachment_[i]) * now.length;
        const Vec4 moved =
            rows_.x[i] - rows_.q[i] - now.share * (target_after_[i] - target_before_[i]);
        rows_.x[i] += (rate * rate * (target(i, now.fraction) - rows_.x[i]) - 2.0f * rate * moved) /
                      (1.0f + 2.0f * rate + rate * rate);
    }
}

void GarmentCloth::hold_on_leash(std::span<const std::uint32_t> vertices, float fraction) noexcept {
    for (const std::uint32_t i : vertices) {
        const Vec4 goal = target(i, fraction);
        const float leash = static_cast<float>(settings_.leash) * (1.0f - attachment_[i]);
        const Vec4 off = rows_.x[i] - goal;
        const float squared = off.squaredNorm();
        if (squared > leash * leash) {
            rows_.x[i] = goal + (leash / std::sqrt(squared)) * off;
        }
    }
}

/// Who has less than half of its leash left; the others are looked at when the step ends.
void GarmentCloth::find_stretched_leashes() noexcept {
    leashed_.clear();
    for (const std::uint32_t i : free_) {
        const float half = 0.5f * static_cast<float>(settings_.leash) * (1.0f - attachment_[i]);
        if ((rows_.x[i] - target_after_[i]).squaredNorm() > half * half) {
            leashed_.push_back(i);
        }
    }
}

void GarmentCloth::meet_body(const Substep& now) noexcept {
    const std::size_t count = start_.size();
    contacts_.resolve({rows_.x.first(count), rows_.q.first(count), inverse_mass_}, now.since,
                      now.length, contact_, now.index % kCentresEvery == 0 || now.last);
}

void GarmentCloth::update_velocities(const Substep& now) noexcept {
    const bool damps = now.index % kDampEvery == kDampEvery - 1;
    since_damped_ += now.length;
    velocities_known_ = damps || now.last_of_interval;
    if (!velocities_known_) {
        return;
    }
    const float per_second = 1.0f / now.length;
    for (std::size_t i = 0; i < start_.size(); ++i) {
        rows_.v[i] = velocity(rows_.x[i], rows_.q[i], per_second);
    }
    const float rate = fabric_.damping * static_cast<float>(settings_.damping_scale);
    if (damps && rate > 0.0f) {
        damping_.apply(rows_.v, 1.0f - std::exp(-rate * since_damped_));
    }
    since_damped_ = damps ? 0.0f : since_damped_;
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
    const int passes = static_cast<int>(settings_.clean_passes);
    weigh();
    for (int pass = 0; pass < passes; ++pass) {
        last_limits_.solve(rows_.x);
    }
    unweigh();
    for (int pass = 0; pass < passes; ++pass) {
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
