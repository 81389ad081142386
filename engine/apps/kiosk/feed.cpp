#include "apps/kiosk/feed.h"

#include "apps/kiosk/room.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace toile::apps::kiosk {
namespace {

constexpr double kRetry_s = 0.5;
constexpr double kSilent_s = 2.0;

} // namespace

Feed::Feed(Tailor& tailor, std::string uri, std::uint32_t people, const CameraSettings& camera,
           bool live, bool again)
    : tailor_(tailor), uri_(std::move(uri)), people_(people), live_(live), again_(again),
      job_({}, &host::interrupt_flag()), camera_(camera) {
    if (live_) thread_ = std::thread([this] { run(); });
}

Feed::~Feed() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void Feed::run() {
    while (!stop_) {
        if (!fetch(fetched_, pipeline::wall_seconds())) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        // One that nobody took meanwhile is late: the newest counts.
        const std::lock_guard lock(mutex_);
        std::swap(fetched_, ready_);
        is_ready_ = true;
    }
    source_.reset();
}

bool Feed::next(pipeline::PeopleFrame& frame, double now_s) {
    if (ended_) return false;
    if (!live_) {
        if (!fetch(shown_, now_s)) return false;
    } else {
        const std::lock_guard lock(mutex_);
        if (!is_ready_ || !up_) return false;
        is_ready_ = false;
        std::swap(ready_, shown_);
    }
    frame = shown_.people;
    return true;
}

void Feed::open(double now_s) {
    try {
        const std::lock_guard lock(tailor_.registry_mutex());
        source_ = std::make_unique<pipeline::PeopleSource>(
            uri_, tailor_.registry(), tailor_.services(), tailor_.limits(),
            pipeline::TrackingWish{people_, nullptr, true, camera_place(camera_)}, job_);
        source_->shift_clock(shift_ns_);
    } catch (const std::exception& e) {
        return drop(e.what(), now_s);
    }
    frame_at_s_ = pipeline::wall_seconds();
    if (!live_) frame_at_s_ = now_s;
    const std::lock_guard lock(mutex_);
    up_ = true;
    if (std::exchange(was_lost_, false)) note_ = "";
}

void Feed::drop(const std::string& why, double now_s) {
    source_.reset();
    told_.clear();
    try_at_s_ = now_s + kRetry_s;
    const std::lock_guard lock(mutex_);
    up_ = is_ready_ = false;
    if (!std::exchange(was_lost_, true)) note_ = why;
}

void Feed::take_wishes(double now_s) {
    std::optional<std::string> lose;
    {
        const std::lock_guard lock(mutex_);
        lose = std::exchange(lose_, std::nullopt);
        const std::int64_t jump = std::exchange(jump_ns_, 0);
        if (source_) source_->shift_clock(jump);
        shift_ns_ += jump;
        if (moved_) {
            camera_ = *std::exchange(moved_, std::nullopt);
            source_.reset();
            told_.clear();
            up_ = false;
            try_at_s_ = 0.0;
        }
    }
    if (lose) drop(*lose, now_s);
}

bool Feed::fetch(Delivery& out, double now_s) {
    take_wishes(now_s);
    if (!source_ && now_s >= try_at_s_) open(now_s);
    if (!source_) return false;
    const double began_s = pipeline::wall_seconds();
    try {
        if (source_->next(out.people)) {
            source_->take_pictures(out.pictures);
            out.stream = source_->stream();
            keep_shapes(out);
            const std::lock_guard lock(mutex_);
            time_.add(pipeline::wall_seconds() - began_s);
            frame_at_s_ = now_s;
            return true;
        }
        if (source_->ended()) {
            if (again_) {
                const std::lock_guard lock(tailor_.registry_mutex());
                source_->rewind();
            } else if (live_) {
                drop("the recording ended", now_s);
            } else {
                ended_ = true;
            }
        } else if (live_ && now_s - frame_at_s_ > kSilent_s) {
            drop("no picture for two seconds", now_s);
        }
    } catch (const std::exception& e) {
        drop(e.what(), now_s);
    }
    return false;
}

// Copied once for each revision, however many frames tell it.
void Feed::keep_shapes(Delivery& out) {
    out.shapes.assign(out.people.shapes.size(), nullptr);
    for (std::size_t i = 0; i < out.shapes.size(); ++i) {
        const std::uint64_t revision = out.people.shapes[i];
        if (revision == 0) continue;
        const auto known = std::find_if(told_.begin(), told_.end(), [&](const auto& shape) {
            return shape != nullptr && shape->revision == revision;
        });
        out.shapes[i] =
            known != told_.end()
                ? *known
                : std::make_shared<const pipeline::PersonShape>(source_->shape(revision));
    }
    told_ = out.shapes;
}

const pipeline::PersonShape* Feed::shape(std::uint64_t revision) const {
    for (const auto& shape : shown_.shapes)
        if (shape != nullptr && revision != 0 && shape->revision == revision) return shape.get();
    return nullptr;
}

void Feed::forget() {
    pipeline::SensorFrame& pictures = shown_.pictures;
    std::fill(pictures.depth.metres.begin(), pictures.depth.metres.end(), 0.0f);
    std::fill(pictures.color.pixels.begin(), pictures.color.pixels.end(), std::uint8_t{0});
    shown_.people.people.clear();
    shown_.shapes.clear();
}

pipeline::DurationHistogram Feed::time() const {
    const std::lock_guard lock(mutex_);
    return time_;
}

std::optional<std::string> Feed::take_note() {
    const std::lock_guard lock(mutex_);
    return std::exchange(note_, std::nullopt);
}

void Feed::lose(const std::string& why, double now_s) {
    if (!live_) return drop(why, now_s);
    const std::lock_guard lock(mutex_);
    lose_ = why;
}

void Feed::jump_clock(double seconds) {
    const std::lock_guard lock(mutex_);
    jump_ns_ += std::llround(1e9 * seconds);
}

void Feed::set_camera(const CameraSettings& camera) {
    const std::lock_guard lock(mutex_);
    moved_ = camera;
}

} // namespace toile::apps::kiosk
