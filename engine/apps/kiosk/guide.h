// The turn before the camera: which sides were seen, and the figure that shows what to do.
#pragma once

#include "pipeline/body_frame.h"
#include "pipeline/sensor_source.h"
#include "render/canvas.h"

#include <array>
#include <optional>
#include <vector>

namespace toile::apps::kiosk {

/// How a person is turned: facing the camera, a quarter to the own left, away, to the own right.
enum class Side { invalid, front, left, back, right };

/// How a person is turned to a camera at `eye`; nothing when it is between two.
[[nodiscard]] std::optional<Side> side_shown(const pipeline::BodyFrame& frame, const Vec3f& eye);

/// Keeps one frame of each side, in memory only.
class Turn {
  public:
    void begin();
    /// Takes the frame when it shows a side that is missing and was shown for a moment.
    void see(const pipeline::BodyFrame& frame, const Vec3f& eye,
             const pipeline::SensorFrame& pictures, double dt_s);
    [[nodiscard]] bool complete() const;
    /// The side asked for next.
    [[nodiscard]] Side wanted() const;
    [[nodiscard]] bool has(Side side) const;
    /// Frames that were kept; the turn is then empty.
    [[nodiscard]] std::vector<pipeline::SensorFrame> take();
    /// Overwrites what was kept.
    void erase();

  private:
    std::array<std::optional<pipeline::SensorFrame>, 5> kept_;
    Side showing_ = Side::invalid;
    double shown_s_ = 0.0;
};

/// A figure on a turntable that turns to the wanted side and back again, arms a little apart.
void draw_guide(render::Canvas& canvas, const render::Rect& place, Side wanted, double seconds);

} // namespace toile::apps::kiosk
