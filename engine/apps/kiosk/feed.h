// The camera and its tracker, kept going: a lost one is opened again.
#pragma once

#include "apps/kiosk/config.h"
#include "apps/kiosk/tailor.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace toile::apps::kiosk {

/// Not movable. On the live clock the camera is asked and people are tracked on a thread of its
/// own, one frame ahead of the clothes; else when `next` is called, so that each run is the same.
class Feed {
  public:
    /// `live`: a source that ends or stays silent for two seconds is lost, and is opened again
    /// every half second. Otherwise the end is the end. `again`: recordings go round, as if the
    /// person had stood there all the time.
    Feed(Tailor& tailor, std::string uri, std::uint32_t people, const CameraSettings& camera,
         bool live, bool again);
    ~Feed();
    Feed(const Feed&) = delete;
    Feed& operator=(const Feed&) = delete;

    /// True with a new frame, the newest. False: none now (`up` tells why). Never throws.
    bool next(pipeline::PeopleFrame& frame, double now_s);
    [[nodiscard]] bool up() const { return up_; }
    [[nodiscard]] bool ended() const { return ended_; }
    /// Pictures of the last frame, and the camera that made them.
    [[nodiscard]] const pipeline::SensorFrame& pictures() const { return shown_.pictures; }
    [[nodiscard]] const pipeline::SensorStream& stream() const { return shown_.stream; }
    /// Of somebody in the last frame; null for a revision that it did not tell.
    [[nodiscard]] const pipeline::PersonShape* shape(std::uint64_t revision) const;
    /// The last frame is overwritten.
    void forget();
    [[nodiscard]] const std::string& uri() const { return uri_; }
    /// Wall time that a frame took, camera and tracker.
    [[nodiscard]] pipeline::DurationHistogram time() const;

    /// What happened since the last call: why it was lost, or empty text for being back.
    [[nodiscard]] std::optional<std::string> take_note();
    /// As if the camera had been unplugged; for tests of faults.
    void lose(const std::string& why, double now_s);
    /// As if the camera's clock had been set, by so many seconds; for tests of faults.
    void jump_clock(double seconds);
    /// The camera stands elsewhere: it is opened again.
    void set_camera(const CameraSettings& camera);

  private:
    using Shapes = std::vector<std::shared_ptr<const pipeline::PersonShape>>;
    struct Delivery {
        pipeline::PeopleFrame people;
        Shapes shapes; ///< of people.shapes; null where none is told
        pipeline::SensorFrame pictures;
        pipeline::SensorStream stream;
    };
    void run();
    void take_wishes(double now_s);
    void open(double now_s);
    void drop(const std::string& why, double now_s);
    bool fetch(Delivery& out, double now_s);
    void keep_shapes(Delivery& out);

    Tailor& tailor_;
    std::string uri_;
    std::uint32_t people_;
    bool live_;
    bool again_;
    host::Job job_;

    // Of the thread that fetches.
    CameraSettings camera_;
    std::unique_ptr<pipeline::PeopleSource> source_;
    Delivery fetched_;
    Shapes told_; ///< by the frame before
    double try_at_s_ = 0.0;
    double frame_at_s_ = 0.0;
    std::int64_t shift_ns_ = 0;
    bool was_lost_ = false;

    mutable std::mutex mutex_; // what both use
    Delivery ready_;
    bool is_ready_ = false;
    pipeline::DurationHistogram time_;
    std::optional<std::string> note_;
    std::optional<std::string> lose_;
    std::optional<CameraSettings> moved_;
    std::int64_t jump_ns_ = 0;

    Delivery shown_; ///< of the caller
    std::atomic<bool> up_{false};
    std::atomic<bool> ended_{false};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace toile::apps::kiosk
