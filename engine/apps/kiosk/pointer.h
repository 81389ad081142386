// Hands, touch and keys that press the same buttons.
#pragma once

#include "apps/kiosk/layout.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace toile::apps::kiosk {

/// A hand as seen in this frame, pixels of the screen. One that hangs points at nothing.
struct Hand {
    std::uint32_t person = 0;
    Vec2f place = Vec2f::Zero();
    bool raised = false;
};

struct PointerOptions {
    double dwell_s = 1.2;
    double forget_s = 0.25; ///< a hand that slips off for so long keeps what it has gathered
    float slack = 0.25f;    ///< of a button's height: how far a resting hand may tremble out of it
};

/// A button that is pointed to: one action may stand there for each of two people.
struct Target {
    Action action = Action::invalid;
    std::uint32_t person = 0; ///< Button::person
    bool operator==(const Target&) const = default;
};

/// Hover and dwell, nothing is grabbed or dragged. A button that was pressed by a hand must be
/// left before it counts again. Hands press only buttons of their own person and of anybody.
class Pointer {
  public:
    explicit Pointer(const PointerOptions& options) : options_(options) {}

    /// The action whose dwell ended in this frame, or Action::invalid.
    Action hover(std::span<const Hand> hands, std::span<const Button> buttons, double dt_s);
    /// The button at a tapped place, or Action::invalid.
    [[nodiscard]] static Target tap(const Vec2f& place, std::span<const Button> buttons);
    /// Keys: the next button gets the focus; pressing gives it.
    void move_focus(int by, std::span<const Button> buttons);
    [[nodiscard]] Target press_focus(std::span<const Button> buttons) const;

    /// Whose hand that is, or was when it pressed.
    [[nodiscard]] std::uint32_t person() const { return person_; }
    /// The button that a hand rests on, and how much of the dwell is over, [0, 1].
    [[nodiscard]] const Target& rested_on() const { return target_; }
    [[nodiscard]] float progress() const;
    [[nodiscard]] const std::optional<Target>& focus() const { return focus_; }
    /// Another screen: nothing is rested on, and hands must leave first where they are.
    void forget();

  private:
    [[nodiscard]] Target under(std::span<const Hand> hands, std::span<const Button> buttons);

    PointerOptions options_;
    Target target_;
    std::uint32_t person_ = 0;
    double rested_s_ = 0.0;
    double off_s_ = 0.0;
    bool spent_ = false; ///< pressed, and not left since
    std::optional<Target> focus_;
};

} // namespace toile::apps::kiosk
