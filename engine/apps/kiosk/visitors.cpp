#include "apps/kiosk/visitors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace toile::apps::kiosk {
namespace {

constexpr float kFarthest_m = 4.2f; // from the camera: whoever passes behind is not asked
constexpr float kForward_m = 0.34f; // a hand so far before its shoulder points
constexpr float kAboveHips_m = 0.05f;
constexpr float kFingers_m = 0.09f; // from the wrist to the middle of the hand
constexpr float kSure = 0.15f;      // confidence of a joint

Vec3f place(const pipeline::BodyFrame& frame, body::Joint joint) {
    const float* p = frame.joints[static_cast<std::size_t>(joint)].position;
    return {p[0], p[1], p[2]};
}

float confidence(const pipeline::BodyFrame& frame, body::Joint joint) {
    return frame.joints[static_cast<std::size_t>(joint)].confidence;
}

// Of what is known of somebody nothing stays in freed memory.
void overwrite(Shopper& shopper) {
    std::fill(shopper.coefficients.begin(), shopper.coefficients.end(), 0.0);
    std::fill(shopper.surface.begin(), shopper.surface.end(), Vec3f::Zero());
    shopper.skeleton = {};
    shopper.frame = {};
    shopper.measurements.clear();
}

} // namespace

const Shopper* Visitors::find(std::uint32_t id) const {
    for (const Shopper& shopper : shoppers_)
        if (shopper.id == id) return &shopper;
    return nullptr;
}

Shopper* Visitors::find(std::uint32_t id) {
    return const_cast<Shopper*>(std::as_const(*this).find(id));
}

void Visitors::see(const pipeline::PeopleFrame& frame, const Feed& feed, const Vec3f& eye,
                   double dt_s) {
    for (Shopper& shopper : shoppers_)
        shopper.here = false;
    far_ = false;
    for (std::size_t i = 0; i < frame.people.size(); ++i) {
        const pipeline::BodyFrame& person = frame.people[i];
        if (person.tracking == TOILE_TRACKING_LOST) continue;
        if ((place(person, body::Joint::hips) - eye).norm() > kFarthest_m) {
            far_ = true;
            continue;
        }
        Shopper* shopper = find(person.person_id);
        if (shopper == nullptr) {
            if (shoppers_.size() >= most_) continue;
            shopper = &shoppers_.emplace_back();
            shopper->id = person.person_id;
        }
        shopper->here = true;
        shopper->unseen_s = 0.0;
        shopper->frame = person;
        tailor_.see(person);
        // Only after consent is anything of the body's shape taken over.
        const pipeline::PersonShape* shape =
            shopper->agreed ? feed.shape(frame.shapes[i]) : nullptr;
        if (shape != nullptr && shape->revision != shopper->shape_revision) {
            shopper->shape_revision = shape->revision;
            shopper->model = shape->model;
            shopper->coefficients = shape->coefficients;
            shopper->surface = shape->rest;
            shopper->skeleton = shape->skeleton;
        }
    }
    for (Shopper& shopper : shoppers_)
        if (!shopper.here) shopper.unseen_s += dt_s;
    std::erase_if(shoppers_, [this](const Shopper& s) { return s.unseen_s > away_s_; });
}

void Visitors::see_nobody(double dt_s) {
    constexpr double kBlink_s = 0.4; // a frame or two that are late: nobody has gone
    for (Shopper& shopper : shoppers_) {
        shopper.unseen_s += dt_s;
        shopper.here = shopper.here && shopper.unseen_s < kBlink_s;
    }
    std::erase_if(shoppers_, [this](const Shopper& s) { return s.unseen_s > away_s_; });
}

void Visitors::erase() {
    for (Shopper& shopper : shoppers_)
        overwrite(shopper);
    shoppers_.clear();
    tailor_.forget();
}

void Visitors::erase(std::uint32_t id) {
    if (Shopper* shopper = find(id)) overwrite(*shopper);
    std::erase_if(shoppers_, [id](const Shopper& s) { return s.id == id; });
    tailor_.forget(id);
}

const Shopper* Visitors::first() const {
    const auto agreed =
        std::find_if(shoppers_.begin(), shoppers_.end(), [](const Shopper& s) { return s.agreed; });
    if (agreed != shoppers_.end()) return &*agreed;
    return shoppers_.empty() ? nullptr : &shoppers_.front();
}

Shopper* Visitors::first() {
    return const_cast<Shopper*>(std::as_const(*this).first());
}

std::size_t Visitors::agreed() const {
    return static_cast<std::size_t>(std::count_if(shoppers_.begin(), shoppers_.end(),
                                                  [](const Shopper& s) { return s.agreed; }));
}

std::uint32_t Visitors::count() const {
    const bool agreed =
        std::any_of(shoppers_.begin(), shoppers_.end(), [](const Shopper& s) { return s.agreed; });
    return static_cast<std::uint32_t>(
        std::count_if(shoppers_.begin(), shoppers_.end(),
                      [&](const Shopper& s) { return s.here && (s.agreed || !agreed); }));
}

void Visitors::order(Shopper& shopper, std::size_t look, const std::vector<Article>& articles) {
    shopper.waiting[look] = !shopper.body.body && shopper.model.empty();
    if (shopper.waiting[look]) return;
    DressOrder order;
    order.person = shopper.id;
    order.look = look;
    order.choice = shopper.wanted[look];
    order.article = articles.at(order.choice.article);
    order.measurements = shopper.measurements;
    order.body = shopper.body;
    order.model = shopper.model;
    order.coefficients = shopper.coefficients;
    order.surface = shopper.surface;
    order.skeleton = shopper.skeleton;
    tailor_.dress(std::move(order));
}

void Visitors::order_waiting(const std::vector<Article>& articles) {
    for (Shopper& shopper : shoppers_)
        for (std::size_t look = 0; look < shopper.looks.size(); ++look)
            if (shopper.waiting[look]) order(shopper, look, articles);
}

void Visitors::step(pipeline::StageClock& clock, double longest_s) {
    for (Shopper& shopper : shoppers_) {
        if (!shopper.here) continue;
        for (std::optional<WornLook>& look : shopper.looks) {
            if (!look) continue;
            const double dt_s =
                1e-9 * static_cast<double>(shopper.frame.timestamp_ns - look->timestamp_ns);
            look->timestamp_ns = shopper.frame.timestamp_ns;
            const double usable = dt_s > 0.0 ? std::min(dt_s, longest_s) : 1.0 / 30.0;
            look->person->step(on_body(shopper.frame, look->person->body().model()), usable, clock);
        }
    }
}

std::vector<Hand> Visitors::hands(const ToScreen& to_screen) const {
    using body::Joint;
    std::vector<Hand> out;
    for (const Shopper& shopper : shoppers_) {
        if (!shopper.here) continue;
        for (const auto& [shoulder, elbow, wrist] :
             {std::array{Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_hand},
              std::array{Joint::right_upper_arm, Joint::right_lower_arm, Joint::right_hand}}) {
            if (confidence(shopper.frame, wrist) < kSure) continue;
            const Vec3f from = place(shopper.frame, elbow);
            const Vec3f to = place(shopper.frame, wrist);
            const Vec3f hand = to + kFingers_m * (to - from).normalized();
            const float* r = shopper.frame.joints[0].rotation;
            const Vec3f forward = Quatf(r[3], r[0], r[1], r[2]) * Vec3f::UnitZ();
            const Vec3f hips = place(shopper.frame, Joint::hips);
            const float before = forward.dot(hand - place(shopper.frame, shoulder));
            const auto pixel = to_screen(hand);
            if (!pixel) continue;
            out.push_back({shopper.id, *pixel,
                           to.y() > from.y() + 0.02f ||
                               (before > kForward_m && to.y() > hips.y() + kAboveHips_m)});
        }
    }
    return out;
}

std::optional<Reach> Visitors::reach(const Shopper& shopper, const ToScreen& to_screen) {
    using body::Joint;
    if (!shopper.here) return std::nullopt;
    const Vec3f middle = 0.5f * (place(shopper.frame, Joint::left_upper_arm) +
                                 place(shopper.frame, Joint::right_upper_arm));
    const auto at = to_screen(middle);
    const auto above = to_screen(middle + Vec3f(0.0f, 0.5f, 0.0f));
    if (!at || !above) return std::nullopt;
    return Reach{*at, 2.0f * (*above - *at).norm()};
}

} // namespace toile::apps::kiosk
