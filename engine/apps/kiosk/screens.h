// Which screen is shown: the visit of a shopper as a state machine, without pictures or clocks.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace toile::apps::kiosk {

enum class ScreenName {
    invalid,
    attract, ///< nobody there
    consent, ///< asks before anything is measured
    measure, ///< the pose guide
    mirror,
    frozen, ///< the shopper's avatar, turned
    goodbye,
    setup, ///< the operator's
    safe,  ///< after too many crashes
};
[[nodiscard]] std::string_view screen_name(ScreenName screen);
/// ScreenName::invalid for a name that there is not.
[[nodiscard]] ScreenName screen_from_name(std::string_view name);

/// What somebody asks for, by hand, touch or key.
enum class Action {
    invalid,
    agree,
    decline,
    skip,
    try_again,
    next_garment,
    previous_garment,
    next_size,
    next_colour,
    freeze,
    turn,
    live,
    compare,
    snapshot,
    finish,
    open_setup,
    close_setup,
};
[[nodiscard]] std::string_view action_name(Action action);
[[nodiscard]] Action action_from_name(std::string_view name);

/// How far the measuring is.
enum class Measuring { invalid, not_begun, looking, working, done, failed };

/// What is known at a frame.
struct Moment {
    double dt_s = 0.0;
    std::uint32_t people = 0; ///< seen and near enough
    Measuring measuring = Measuring::not_begun;
};

/// What the mirror has to do besides showing a screen.
enum class Effect {
    invalid,
    begin_measuring, ///< only ever after `agree`
    wear,            ///< dress whoever is there
    erase,           ///< forget everything of everybody
    freeze,
    unfreeze,
    turn, ///< the avatar, by a quarter
    snapshot,
    next_garment,
    previous_garment,
    next_size,
    next_colour,
    compare,
};

struct ScreenTimes {
    double notice_s = 0.6;    ///< somebody there for so long is asked
    double away_s = 3.0;      ///< nobody there for so long is gone
    double patience_s = 60.0; ///< an unanswered question
    double goodbye_s = 4.0;
    double done_s = 1.0; ///< the tick after measuring
};

class Screens {
  public:
    explicit Screens(const ScreenTimes& times, bool measures = true, bool safe = false);

    /// Time goes on.
    void tick(const Moment& moment);
    /// Nothing happens for an action that the screen does not offer.
    void act(Action action);

    [[nodiscard]] ScreenName now() const { return now_; }
    /// Actions that the screen offers.
    [[nodiscard]] std::vector<Action> offers() const;
    /// Since this screen came up.
    [[nodiscard]] double seconds() const { return seconds_; }
    [[nodiscard]] bool comparing() const { return comparing_; }
    /// Goodbye to somebody who said no.
    [[nodiscard]] bool declined() const { return declined_; }
    [[nodiscard]] std::vector<Effect> take_effects();

  private:
    void go(ScreenName screen);
    void end_visit(bool declined);
    void act_in_mirror(Action action);

    ScreenTimes times_;
    bool measures_;
    ScreenName now_;
    Measuring measuring_ = Measuring::not_begun;
    double seconds_ = 0.0;
    double there_s_ = 0.0;
    double away_s_ = 0.0;
    bool comparing_ = false;
    bool declined_ = false;
    std::vector<Effect> effects_;
};

} // namespace toile::apps::kiosk
