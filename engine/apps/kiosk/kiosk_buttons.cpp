// Who has which buttons where, whose hands press them, and what stands beside them in words.
#include "apps/kiosk/kiosk.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

constexpr float kElsewhere = 0.22f; // metres that somebody moved, before their buttons follow
constexpr double kElsewhere_s = 0.8;

} // namespace

Arrangement Kiosk::arrangement() const {
    if (screens_.now() != ScreenName::mirror) return Arrangement::one;
    if (visitors_.agreed() > 1) return Arrangement::two_people;
    return screens_.comparing() ? Arrangement::two_looks : Arrangement::one;
}

Pointer& Kiosk::pointer_of(std::uint32_t person) {
    const Shopper* first = visitors_.first();
    return pointers_[first == nullptr || first->id == person ? 0 : 1];
}

// Buttons stay where they are while somebody stands there, and follow who goes elsewhere.
void Kiosk::follow_reach() {
    for (Shopper& shopper : visitors_.all()) {
        const auto now = Visitors::reach(shopper, [this](const Vec3f& p) { return on_screen(p); });
        if (!now) continue;
        std::optional<Reach>& kept = shopper.reach;
        const bool off =
            kept && (now->shoulders - kept->shoulders).norm() > kElsewhere * now->metre;
        if (!off) shopper.reach_off_s = 0.0;
        if (off && fresh_) shopper.reach_off_s += 1.0 / 30.0;
        if (kept && shopper.reach_off_s <= kElsewhere_s) continue;
        if (kept) pointer_of(shopper.id).forget();
        kept = now;
        shopper.reach_off_s = 0.0;
    }
}

bool Kiosk::on_the_left(const Shopper& shopper) const {
    for (const Shopper& other : visitors_.all())
        if (other.id != shopper.id && other.reach && shopper.reach)
            return shopper.reach->shoulders.x() < other.reach->shoulders.x();
    return true;
}

std::vector<Action> Kiosk::offers_of(const Shopper* shopper) const {
    std::vector<Action> out = screens_.offers();
    const bool first = shopper == nullptr || shopper == visitors_.first();
    if (run_.config.snapshots.empty() || !first) std::erase(out, Action::snapshot);
    const Arrangement now = arrangement();
    if (now != Arrangement::one) std::erase(out, Action::freeze);
    if (now == Arrangement::two_people) std::erase(out, Action::compare);
    const std::size_t look = screens_.comparing() ? 1 : 0;
    if (shopper != nullptr && articles_[shopper->wanted[look].article].colours.size() < 2)
        std::erase(out, Action::next_colour);
    return out;
}

std::vector<Button> Kiosk::buttons() const {
    const int width = display_->screen().width();
    const int height = display_->screen().height();
    const Arrangement now = arrangement();
    const Shopper* first = visitors_.first();
    const bool dressed =
        screens_.now() == ScreenName::mirror || screens_.now() == ScreenName::frozen;
    const auto seat = [&](const Shopper& s) {
        return Seat{dressed ? s.id : 0, on_the_left(s), s.reach};
    };
    const Seat own = first != nullptr ? seat(*first) : Seat{};
    if (now == Arrangement::two_looks) return lay_out_looks(offers_of(first), width, height, own);
    std::vector<Button> out;
    if (now == Arrangement::one) out = lay_out(offers_of(first), width, height, own);
    for (const Shopper& shopper : visitors_.all()) {
        if (now == Arrangement::two_people && shopper.agreed)
            for (const Button& button :
                 lay_out_person(offers_of(&shopper), width, height, seat(shopper)))
                out.push_back(button);
        // Somebody else who has not been asked yet.
        if (screens_.now() == ScreenName::mirror && shopper.here && !shopper.agreed)
            out.push_back(lay_out_beside(Action::agree, width, height, seat(shopper), out));
    }
    return out;
}

// Raised and hanging hands, where they point to.
std::vector<Hand> Kiosk::hands() const {
    const auto to_screen = [this](const Vec3f& p) { return on_screen(p); };
    std::vector<Hand> out = visitors_.hands(to_screen);
    for (Hand& hand : out) {
        const Shopper* shopper = visitors_.find(hand.person);
        if (shopper == nullptr) continue;
        const auto panel = panel_reach(arrangement(), display_->screen().width(),
                                       display_->screen().height(), on_the_left(*shopper));
        const auto own = Visitors::reach(*shopper, to_screen);
        if (panel && own && own->metre > 0.0f)
            hand.place =
                panel->shoulders + panel->metre / own->metre * (hand.place - own->shoulders);
    }
    return out;
}

// What one person wears and how its size suits, in a column of words.
Caption Kiosk::caption_of(const Shopper& shopper, std::size_t look) const {
    Caption out;
    out.name = articles_[shopper.wanted[look].article].name;
    out.advice = advice_line(shopper, look);
    return out;
}

std::vector<Caption> Kiosk::captions() const {
    const int width = display_->screen().width();
    const int height = display_->screen().height();
    const auto w = static_cast<float>(width);
    const auto h = static_cast<float>(height);
    const Measures sizes = measures(width, height);
    const Arrangement now = arrangement();
    const Stage stage = stage_of(now, width, height);
    std::vector<Caption> out;
    const Shopper* first = visitors_.first();
    if (first == nullptr) return out;
    if (screens_.now() == ScreenName::frozen) {
        out.push_back({{0.2f * w, h - sizes.margin - 1.9f * sizes.text, 0.6f * w, 0.0f}});
        out.back().advice = advice_line(*first, 0);
        return out;
    }
    if (now == Arrangement::one) { // in the corners, beside the head
        const float wide = 0.34f * w;
        const Caption all = caption_of(*first, 0);
        out.push_back({{sizes.edge, sizes.margin, wide, 0.0f}, render::Align::start, all.name, ""});
        out.push_back({{w - sizes.edge - wide, sizes.margin, wide, 0.0f},
                       render::Align::end,
                       "",
                       all.advice});
    } else if (now == Arrangement::two_looks) {
        for (std::size_t look = 0; look < 2; ++look) {
            const render::Rect& picture = stage.pictures[look];
            const Caption all = caption_of(*first, look);
            out.push_back({{picture.x, 0.5f * sizes.margin, picture.width, 0.0f}});
            out.back().name = all.name;
            if (look == 1) out.push_back({stage.words, render::Align::middle, "", all.advice});
        }
    } else {
        for (const Shopper& shopper : visitors_.all()) {
            if (!shopper.agreed) continue;
            Caption one = caption_of(shopper, 0);
            const float gap = 0.5f * sizes.margin;
            const bool left = on_the_left(shopper);
            one.place = {left ? gap : 0.5f * w + gap, 0.0f, 0.5f * w - 2.0f * gap, 0.0f};
            one.place.y = stage.panel ? stage.panel->y + gap : sizes.margin;
            if (!stage.panel) {
                one.place.width = 0.3f * w;
                one.place.x = left ? sizes.edge : w - sizes.edge - one.place.width;
                for (const Button& button : buttons()) // beneath the own ones
                    if (button.person == shopper.id)
                        one.place.y =
                            std::max(one.place.y, button.rect.y + button.rect.height + gap);
            }
            out.push_back(std::move(one));
        }
    }
    return out;
}

} // namespace toile::apps::kiosk
