// The camera and its tracker, kept going: a lost one is opened again.
#pragma once

#include "apps/kiosk/config.h"
#include "apps/kiosk/tailor.h"

#include <memory>
#include <optional>
#include <string>

namespace toile::apps::kiosk {

/// Not movable. All calls on one thread, the one that asks for frames (cameras want that).
class Feed {
  public:
    /// `live`: a source that ends or stays silent for two seconds is lost, and is opened again
    /// every half second. Otherwise the end is the end, unless `again`.
    Feed(Tailor& tailor, std::string uri, std::uint32_t people, const CameraSettings& camera,
         bool live, bool again);

    /// True with a new frame. False: none now (`up` tells why). Never throws.
    bool next(pipeline::PeopleFrame& frame, double now_s);
    [[nodiscard]] bool up() const { return source_ != nullptr; }
    [[nodiscard]] bool ended() const { return ended_; }
    /// Pictures of the last frame. Only while `up`.
    [[nodiscard]] const pipeline::SensorFrame& pictures() const { return source_->pictures(); }
    [[nodiscard]] const pipeline::SensorStream& stream() const { return source_->stream(); }
    [[nodiscard]] const pipeline::PersonShape* shape(std::uint64_t revision) const;
    [[nodiscard]] const std::string& uri() const { return uri_; }

    /// What happened since the last call: why it was lost, or empty text for being back.
    [[nodiscard]] std::optional<std::string> take_note();
    /// As if the camera had been unplugged; for tests of faults.
    void lose(const std::string& why, double now_s);
    /// The camera stands elsewhere: it is opened again.
    void set_camera(const CameraSettings& camera);

  private:
    void open(double now_s);

    Tailor& tailor_;
    std::string uri_;
    std::uint32_t people_;
    CameraSettings camera_;
    bool live_;
    bool again_;
    host::Job job_;
    std::unique_ptr<pipeline::PeopleSource> source_;
    double try_at_s_ = 0.0;
    double frame_at_s_ = 0.0;
    bool was_lost_ = false;
    bool ended_ = false;
    std::optional<std::string> note_;
};

} // namespace toile::apps::kiosk
