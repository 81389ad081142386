// What taps, keys, hands and scripts do.
#include "apps/kiosk/kiosk.h"

#include "core/log.h"

#include <algorithm>
#include <cstdlib>
#include <thread>
#include <utility>

namespace toile::apps::kiosk {

void Kiosk::act(Action action, std::uint32_t person) {
    if (action != Action::invalid) hand_at_s_ = now_s_;
    Shopper* shopper = person == 0 ? visitors_.first() : visitors_.find(person);
    if (action == Action::agree && shopper != nullptr) {
        shopper->agreed = true;
        if (screens_.now() == ScreenName::mirror) return join(*shopper);
    }
    if (action == Action::finish && shopper != nullptr && arrangement() == Arrangement::two_people)
        return leave(*shopper);
    if (action == Action::snapshot && run_.config.snapshots.empty()) return;
    const ScreenName before = screens_.now();
    screens_.act(action);
    if (action == Action::agree && screens_.now() != before) ++metrics_.visits;
    if (action == Action::decline && screens_.now() != before) ++metrics_.declined;
    for (const Effect effect : screens_.take_effects())
        perform(effect, shopper);
}

// A second one, who wants clothes too.
void Kiosk::join(Shopper& shopper) {
    if (screens_.comparing()) {
        screens_.act(Action::compare);
        for (const Effect effect : screens_.take_effects())
            perform(effect, visitors_.first());
    }
    visitors_.order(shopper, 0, articles_);
    ++metrics_.visits;
}

// One of two is done; the other one's visit goes on.
void Kiosk::leave(const Shopper& shopper) {
    const std::uint32_t person = shopper.id;
    for (Pointer& pointer : pointers_)
        pointer.forget();
    visitors_.erase(person);
}

void Kiosk::wear() {
    for (Shopper& shopper : visitors_.all())
        if (shopper.agreed) visitors_.order(shopper, 0, articles_);
}

void Kiosk::change(Shopper& shopper, const Choice& choice) {
    // Side by side it is the second look that changes.
    const std::size_t look = screens_.comparing() ? 1 : 0;
    shopper.wanted[look] = choice;
    visitors_.order(shopper, look, articles_);
}

void Kiosk::perform(Effect effect, Shopper* shopper) {
    const std::size_t look = screens_.comparing() ? 1 : 0;
    const auto wanted = [&] { return shopper->wanted[look]; };
    switch (effect) {
    case Effect::begin_measuring:
        turn_.begin();
        measuring_ = Measuring::looking;
        measured_ = 0;
        break;
    case Effect::wear:
        turn_.erase();
        wear();
        break;
    case Effect::erase:
        turn_.erase();
        visitors_.erase();
        display_->picture().erase();
        feed_.forget();
        people_.people.clear();
        people_.shapes.clear();
        measuring_ = Measuring::not_begun;
        shopper_note_ = {};
        frozen_from_.reset();
        floor_.reset();
        break;
    case Effect::freeze:
        beat(LifeSign::patience); // the studio is drawn for the first time
        azimuth_deg_ = 0.0f;
        azimuth_goal_deg_ = 180.0f;
        frozen_s_ = 0.0;
        frozen_from_.reset();
        break;
    case Effect::turn:
        azimuth_goal_deg_ += 90.0f;
        break;
    case Effect::unfreeze:
        frozen_from_.reset();
        break;
    case Effect::snapshot:
        snapshot_ = true;
        break;
    case Effect::next_garment:
        if (shopper != nullptr) change(*shopper, step(wanted(), 1, articles_.size()));
        break;
    case Effect::previous_garment:
        if (shopper != nullptr) change(*shopper, step(wanted(), -1, articles_.size()));
        break;
    case Effect::next_size:
        if (shopper != nullptr) change(*shopper, next_size(wanted(), articles_[wanted().article]));
        break;
    case Effect::next_colour:
        if (shopper != nullptr)
            change(*shopper, next_colour(wanted(), articles_[wanted().article]));
        break;
    case Effect::compare:
        if (shopper == nullptr) break;
        if (screens_.comparing())
            change(*shopper, step(shopper->wanted[0], 1, articles_.size()));
        else
            shopper->looks[1].reset();
        break;
    case Effect::invalid:
        break;
    }
}

void Kiosk::inject(const std::string& fault) {
    if (fault == "camera") feed_.lose("unplugged by the script", now_s_);
    if (fault == "picture") display_->lose();
    if (fault == "clock") feed_.jump_clock(std::exchange(clock_jump_s_, -1.6 * clock_jump_s_));
    if (fault == "disk") scribe_.fail_next();
    if (fault == "crash" && run_.restarts == 0) std::abort();
    if (fault == "stall" && run_.restarts == 0)
        for (;;)
            std::this_thread::sleep_for(std::chrono::seconds(1));
}

void Kiosk::take_script() {
    const std::vector<ScriptStep>& steps = run_.script.steps;
    script_began_s_.resize(steps.size(), -1.0);
    std::vector<ScriptStep> due = run_.script.between(script_began_s_, script_at_s_, now_s_);
    script_at_s_ = now_s_;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i].frame == number_) {
            script_began_s_[i] = now_s_;
            due.push_back(steps[i]);
        }
    for (const ScriptStep& step : due) {
        if (step.kind == ScriptStep::Kind::act) {
            const auto& all = visitors_.all();
            if (step.person == 2 && all.size() < 2) continue;
            act(step.action, step.person == 2 ? all[1].id : 0);
        }
        if (step.kind == ScriptStep::Kind::fault) inject(step.name);
        if (step.kind == ScriptStep::Kind::quit) quit_ = true;
    }
}

void Kiosk::take_input(double dt_s) {
    const render::WindowInput input = display_->take_input();
    using Key = render::WindowInput::Key;
    follow_reach();
    const std::vector<Button> shown = buttons();
    const auto press = [this](const Target& target) { act(target.action, target.person); };
    for (const Vec2f& tap : input.taps)
        press(Pointer::tap(tap, shown));
    Pointer& keys = pointers_[0];
    for (const auto& key : input.keys) {
        if (screens_.now() == ScreenName::setup) {
            setup_key(key);
            continue;
        }
        if (key.key == Key::letter && key.letter == 'o') act(Action::open_setup, 0);
        if (key.key == Key::left || key.key == Key::up) keys.move_focus(-1, shown);
        if (key.key == Key::right || key.key == Key::down) keys.move_focus(1, shown);
        if (key.key == Key::enter || key.key == Key::space) press(keys.press_focus(shown));
        if (key.key == Key::escape)
            act(screens_.now() == ScreenName::consent ? Action::decline : Action::finish, 0);
    }
    if (!fresh_ || screens_.now() == ScreenName::setup) return;
    const std::vector<Hand> all = hands();
    for (Pointer& pointer : pointers_) {
        std::vector<Hand> own;
        for (const Hand& hand : all)
            if (&pointer_of(hand.person) == &pointer) own.push_back(hand);
        const Action pressed = pointer.hover(own, shown, dt_s);
        if (pressed == Action::invalid) continue;
        act(pressed, pointer.person());
        break; // the buttons may be others now
    }
}

void Kiosk::setup_key(const render::WindowInput::Press& press) {
    using Key = render::WindowInput::Key;
    MirrorSettings& mirror = run_.config.mirror;
    constexpr double kStep = 0.01;
    const auto clamped = [](double v) { return std::clamp(v, -0.5, 0.5); };
    if (press.key == Key::left) mirror.offset_x = clamped(mirror.offset_x - kStep);
    if (press.key == Key::right) mirror.offset_x = clamped(mirror.offset_x + kStep);
    if (press.key == Key::up) mirror.offset_y = clamped(mirror.offset_y - kStep);
    if (press.key == Key::down) mirror.offset_y = clamped(mirror.offset_y + kStep);
    if (press.letter == '1') mirror.scale = std::max(1.0, mirror.scale - 0.02);
    if (press.letter == '2') mirror.scale = std::min(4.0, mirror.scale + 0.02);
    if (press.letter == 'f' && floor_) {
        run_.config.camera = *floor_;
        feed_.set_camera(*floor_);
    }
    if (press.letter == 's' && !run_.config_file.empty()) {
        try {
            save_setup(run_.config_file, mirror, run_.config.camera);
            notes_.push_back({texts_[Text::setup_saved], now_s_ + run_.config.operator_line_s});
        } catch (const std::exception& e) {
            note_fault(Fault::disk, texts_.with(Text::disk_full, {{"why", e.what()}}));
        }
    }
    if (press.letter == 'q') quit_ = true;
    if (press.key == Key::escape || press.key == Key::enter) act(Action::close_setup, 0);
}

} // namespace toile::apps::kiosk
