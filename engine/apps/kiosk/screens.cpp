#include "apps/kiosk/screens.h"

#include <algorithm>
#include <array>
#include <utility>

namespace toile::apps::kiosk {
namespace {

constexpr std::array<std::string_view, 9> kScreens = {
    "invalid", "attract", "consent", "measure", "mirror", "frozen", "goodbye", "setup", "safe"};
constexpr std::array<std::string_view, 17> kActions = {
    "invalid",          "agree",     "decline",     "skip",       "try_again",  "next_garment",
    "previous_garment", "next_size", "next_colour", "freeze",     "turn",       "live",
    "compare",          "snapshot",  "finish",      "open_setup", "close_setup"};

constexpr double kAskAgain = 4.0;

template <class Enum, std::size_t N>
Enum from_name(const std::array<std::string_view, N>& names, std::string_view name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? Enum::invalid : static_cast<Enum>(found - names.begin());
}

} // namespace

std::string_view screen_name(ScreenName screen) {
    return kScreens.at(static_cast<std::size_t>(screen));
}

ScreenName screen_from_name(std::string_view name) {
    return from_name<ScreenName>(kScreens, name);
}

std::string_view action_name(Action action) {
    return kActions.at(static_cast<std::size_t>(action));
}

Action action_from_name(std::string_view name) {
    return from_name<Action>(kActions, name);
}

Screens::Screens(const ScreenTimes& times, bool measures, bool safe)
    : times_(times), measures_(measures), now_(safe ? ScreenName::safe : ScreenName::attract) {}

void Screens::go(ScreenName screen) {
    now_ = screen;
    seconds_ = 0.0;
}

void Screens::end_visit(bool declined) {
    effects_.push_back(Effect::erase);
    comparing_ = false;
    declined_ = declined;
    measuring_ = Measuring::not_begun;
    go(ScreenName::goodbye);
}

void Screens::tick(const Moment& moment) {
    seconds_ += moment.dt_s;
    measuring_ = moment.measuring;
    const bool there = moment.people > 0;
    there_s_ = there ? there_s_ + moment.dt_s : 0.0;
    away_s_ = there ? 0.0 : away_s_ + moment.dt_s;
    const bool gone = away_s_ >= times_.away_s;
    switch (now_) {
    case ScreenName::attract:
        if (there_s_ >= times_.notice_s) go(ScreenName::consent);
        break;
    case ScreenName::consent:
        if (gone)
            go(ScreenName::attract);
        else if (seconds_ >= times_.patience_s)
            end_visit(true);
        break;
    case ScreenName::measure:
        if (gone) {
            end_visit(false);
        } else if (measuring_ == Measuring::failed && seconds_ >= times_.patience_s) {
            end_visit(false);
        } else if (measuring_ == Measuring::done) {
            effects_.push_back(Effect::wear);
            go(ScreenName::mirror);
        }
        break;
    case ScreenName::mirror:
    case ScreenName::frozen:
        if (gone) end_visit(false);
        break;
    case ScreenName::goodbye:
        // Who said no and still stands there is not asked again; who is done, after a while.
        if (seconds_ >= times_.goodbye_s &&
            (gone || (!declined_ && seconds_ >= kAskAgain * times_.goodbye_s)))
            go(ScreenName::attract);
        break;
    case ScreenName::invalid:
    case ScreenName::setup:
    case ScreenName::safe:
        break;
    }
}

std::vector<Action> Screens::offers() const {
    switch (now_) {
    case ScreenName::consent:
        return {Action::agree, Action::decline};
    case ScreenName::measure:
        if (measuring_ == Measuring::failed)
            return {Action::try_again, Action::skip, Action::finish};
        return {Action::skip, Action::finish};
    case ScreenName::mirror:
        return {Action::previous_garment, Action::next_garment, Action::next_size,
                Action::next_colour,      Action::freeze,       Action::compare,
                Action::snapshot,         Action::finish};
    case ScreenName::frozen:
        return {Action::turn, Action::live, Action::snapshot, Action::finish};
    case ScreenName::setup:
        return {Action::close_setup};
    default:
        return {};
    }
}

void Screens::act(Action action) {
    if (action == Action::open_setup && now_ != ScreenName::setup && now_ != ScreenName::safe) {
        effects_.push_back(Effect::erase);
        comparing_ = false;
        go(ScreenName::setup);
        return;
    }
    const std::vector<Action> offered = offers();
    if (std::find(offered.begin(), offered.end(), action) == offered.end()) return;
    switch (action) {
    case Action::agree:
        if (measures_) effects_.push_back(Effect::begin_measuring);
        if (!measures_) effects_.push_back(Effect::wear);
        go(measures_ ? ScreenName::measure : ScreenName::mirror);
        break;
    case Action::decline:
        end_visit(true);
        break;
    case Action::try_again:
        effects_.push_back(Effect::begin_measuring);
        measuring_ = Measuring::not_begun;
        go(ScreenName::measure);
        break;
    case Action::skip:
        effects_.push_back(Effect::wear);
        go(ScreenName::mirror);
        break;
    case Action::finish:
        end_visit(false);
        break;
    case Action::close_setup:
        there_s_ = 0.0;
        go(ScreenName::attract);
        break;
    default:
        act_in_mirror(action);
    }
}

void Screens::act_in_mirror(Action action) {
    constexpr std::array<std::pair<Action, Effect>, 6> kSame = {{
        {Action::next_garment, Effect::next_garment},
        {Action::previous_garment, Effect::previous_garment},
        {Action::next_size, Effect::next_size},
        {Action::next_colour, Effect::next_colour},
        {Action::snapshot, Effect::snapshot},
        {Action::turn, Effect::turn},
    }};
    for (const auto& [asked, effect] : kSame)
        if (action == asked) effects_.push_back(effect);
    if (action == Action::compare) {
        comparing_ = !comparing_;
        effects_.push_back(Effect::compare);
    } else if (action == Action::freeze) {
        effects_.push_back(Effect::freeze);
        go(ScreenName::frozen);
    } else if (action == Action::live) {
        effects_.push_back(Effect::unfreeze);
        go(ScreenName::mirror);
    }
}

std::vector<Effect> Screens::take_effects() {
    return std::exchange(effects_, {});
}

} // namespace toile::apps::kiosk
