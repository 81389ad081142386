#include "apps/kiosk/feed.h"

#include "apps/kiosk/room.h"

#include <utility>

namespace toile::apps::kiosk {
namespace {

constexpr double kRetry_s = 0.5;
constexpr double kSilent_s = 2.0;

} // namespace

Feed::Feed(Tailor& tailor, std::string uri, std::uint32_t people, const CameraSettings& camera,
           bool live, bool again)
    : tailor_(tailor), uri_(std::move(uri)), people_(people), camera_(camera), live_(live),
      again_(again), job_({}, &host::interrupt_flag()) {}

void Feed::open(double now_s) {
    try {
        const std::lock_guard lock(tailor_.registry_mutex());
        source_ = std::make_unique<pipeline::PeopleSource>(
            uri_, tailor_.registry(), tailor_.services(), tailor_.limits(),
            pipeline::TrackingWish{people_, nullptr, true, camera_place(camera_)}, job_);
        frame_at_s_ = now_s;
        if (std::exchange(was_lost_, false)) note_ = "";
    } catch (const std::exception& e) {
        lose(e.what(), now_s);
    }
}

void Feed::lose(const std::string& why, double now_s) {
    source_.reset();
    if (!std::exchange(was_lost_, true)) note_ = why;
    try_at_s_ = now_s + kRetry_s;
}

bool Feed::next(pipeline::PeopleFrame& frame, double now_s) {
    if (ended_) return false;
    if (!source_ && now_s >= try_at_s_) open(now_s);
    if (!source_) return false;
    try {
        if (source_->next(frame)) {
            frame_at_s_ = now_s;
            return true;
        }
        if (source_->ended()) {
            if (!live_ && !again_)
                ended_ = true;
            else if (!live_)
                source_.reset();
            else
                lose("the recording ended", now_s);
        } else if (live_ && now_s - frame_at_s_ > kSilent_s) {
            lose("no picture for two seconds", now_s);
        }
    } catch (const std::exception& e) {
        lose(e.what(), now_s);
    }
    return false;
}

const pipeline::PersonShape* Feed::shape(std::uint64_t revision) const {
    if (!source_ || revision == 0) return nullptr;
    try {
        return &source_->shape(revision);
    } catch (const std::out_of_range&) {
        return nullptr;
    }
}

std::optional<std::string> Feed::take_note() {
    return std::exchange(note_, std::nullopt);
}

void Feed::set_camera(const CameraSettings& camera) {
    camera_ = camera;
    source_.reset();
    try_at_s_ = 0.0;
}

} // namespace toile::apps::kiosk
