#include "apps/kiosk/kiosk.h"

#include "apps/kiosk/room.h"
#include "core/error.h"
#include "core/log.h"
#include "host/job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <unistd.h>

namespace toile::apps::kiosk {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kLookEvery_s = 1.0; // at the garments' files
constexpr double kNoteToShopper_s = 6.0;
constexpr std::size_t kMostNotes = 3;
constexpr std::uint64_t kWarmUpFrame = 1; // the first picture is out
constexpr double kClockJump_s = 5.0;
constexpr double kLongest_s = 0.3; // that clothes walk through between two frames
// A late frame must not make the next one later: two steps of the cloth.
constexpr double kLongestLive_s = 0.085;

std::vector<Article> read_articles(const KioskConfig& config) {
    std::vector<Article> out;
    std::string refused;
    for (const std::filesystem::path& source :
         garment_sources(config.garments, config.garments_folder)) {
        try {
            out.push_back(read_article_head(source));
        } catch (const std::exception& e) {
            log::warning(e.what());
            refused = e.what();
        }
    }
    if (out.empty()) throw Error("the mirror has no garment to show: " + refused);
    return out;
}

ScreenTimes times_of(const KioskConfig& config) {
    ScreenTimes out;
    out.away_s = config.away_s;
    out.patience_s = config.patience_s;
    return out;
}

} // namespace

Kiosk::Kiosk(KioskRun run, const GlobalOptions& global)
    : run_(std::move(run)), texts_(Texts::load(run_.config.language)),
      articles_(read_articles(run_.config)),
      tailor_(global, run_.realtime || !run_.headless, !(run_.realtime || !run_.headless),
              run_.safe || run_.stock),
      scribe_(!(run_.realtime || !run_.headless)),
      feed_(tailor_, run_.config.source, run_.config.people, run_.config.camera,
            run_.realtime || !run_.headless, run_.frames > 0),
      visitors_(tailor_, run_.config.people, run_.config.away_s),
      screens_(times_of(run_.config), run_.config.measure, run_.safe),
      pointers_{Pointer({run_.config.dwell_s}), Pointer({run_.config.dwell_s})}, scale_(1.0f),
      live_(run_.realtime || !run_.headless) {
    display_ = std::make_unique<Display>(run_.config, run_.headless);
    display_->picture().spoil(run_.spoil);
    load_thumbnails();
    if (live_) watch_ = std::make_unique<CatalogueWatch>(articles_, kLookEvery_s);
    metrics_.restarts = run_.restarts;
    if (run_.restarts > 0)
        note_fault(Fault::crash, texts_.with(run_.stock ? Text::stock_plugins : Text::restarted,
                                             {{"count", std::to_string(run_.restarts)}}));
}

Kiosk::~Kiosk() {
    visitors_.erase();
}

void Kiosk::note_fault(Fault fault, std::string words) {
    metrics_.count(fault);
    log::warning(words);
    notes_.push_back({std::move(words), now_s_ + run_.config.operator_line_s});
    while (notes_.size() > kMostNotes)
        notes_.pop_front();
}

void Kiosk::beat(LifeSign sign) const {
    const char byte = static_cast<char>(sign);
    if (run_.heartbeat >= 0) (void)!write(run_.heartbeat, &byte, 1);
}

void Kiosk::run() {
    while (frame()) {
    }
    write_metrics(true);
    write_report();
}

bool Kiosk::frame() {
    const double began_s = pipeline::wall_seconds();
    const double before_s = now_s_;
    now_s_ = live_ ? began_s : static_cast<double>(number_) * kFrame_s;
    const double dt_s = number_ == 0 ? kFrame_s : std::clamp(now_s_ - before_s, 0.0, 1.0);
    if (!display_->poll() || quit_ || host::interrupt_flag()) return false;
    if (run_.frames > 0 && number_ >= run_.frames) return false;
    fresh_ = screens_.now() != ScreenName::safe && feed_.next(people_, now_s_);
    picture_s_ = 0.0;
    if (feed_.ended()) return false;
    if (live_ && !fresh_ && feed_.up() && screens_.now() != ScreenName::safe) {
        // The camera has no new picture yet.
        if (last_frame_s_ > 0.0 && now_s_ - last_frame_s_ < 2.0 * kFrame_s) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            now_s_ = before_s; // this was no frame of the mirror
            beat();
            take_input(dt_s);
            return true;
        }
    }
    if (const auto note = feed_.take_note()) {
        if (note->empty())
            notes_.push_back({texts_[Text::camera_back], now_s_ + run_.config.operator_line_s});
        else
            note_fault(Fault::camera, texts_.with(Text::camera_lost, {{"why", *note}}));
    }
    take_script();
    fresh_ = fresh_ && feed_.up();
    take_input(dt_s);
    fresh_ = fresh_ && feed_.up(); // the operator may have had it opened again
    if (fresh_)
        take_frame(dt_s);
    else
        visitors_.see_nobody(dt_s);
    take_changes();
    const std::uint32_t people = visitors_.count();
    screens_.tick({dt_s, people, measuring_});
    for (const Effect effect : screens_.take_effects())
        perform(effect, visitors_.first());
    take_results();
    if (fresh_ && screens_.now() == ScreenName::mirror)
        visitors_.step(clock_, live_ ? kLongestLive_s : kLongest_s);
    const double drawing_s = pipeline::wall_seconds();
    try {
        if (run_.draw) draw();
    } catch (const Error& e) {
        rebuild_display(e.what());
    }
    if (fresh_) note_times(began_s, drawing_s, pipeline::wall_seconds());
    clock_.end_frame();
    if (run_.draw && number_ == kWarmUpFrame) {
        beat(LifeSign::patience);
        display_->picture().warm_up();
    }
    beat();
    ++number_;
    ++metrics_.frames;
    write_metrics(false);
    pace(began_s);
    return true;
}

// Figures of a frame of the camera; what garments take, while somebody wears some.
void Kiosk::note_times(double began_s, double drawing_s, double ended_s) {
    const auto& all = visitors_.all();
    const bool dressed =
        screens_.now() == ScreenName::mirror &&
        std::any_of(all.begin(), all.end(), [](const Shopper& s) { return s.looks[0] && s.here; });
    const double captured_s =
        clock_offset_s_.value_or(0.0) + 1e-9 * static_cast<double>(people_.timestamp_ns);
    frame_time_.add(ended_s - began_s);
    draw_time_.add(ended_s - drawing_s + picture_s_);
    if (dressed) {
        compute_time_.add(drawing_s - began_s - picture_s_);
        if (state_at_s_ > 0.0) interval_time_.add(drawing_s - state_at_s_);
    }
    if (dressed && live_) state_latency_.add(drawing_s - picture_s_ - captured_s);
    if (live_) picture_latency_.add(ended_s - captured_s);
    if (live_ && run_.draw)
        metrics_.picture_scale = static_cast<double>(scale_.add(ended_s - began_s));
    state_at_s_ = dressed ? drawing_s : 0.0;
}

// Without a camera nothing paces the loop.
void Kiosk::pace(double began_s) const {
    if (!live_ || fresh_) return;
    const double left = 2.0 * kFrame_s - (pipeline::wall_seconds() - began_s);
    if (left > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

void Kiosk::look_at_clock(double wall_s, double captured_s) {
    const double passed_s = 1e-9 * static_cast<double>(people_.timestamp_ns - last_ns_);
    const bool on = camera_frames_ > 0 && people_.sequence > last_sequence_;
    // A mirror that was not let run for a while has no camera with a wrong clock.
    const double meant_s = live_ ? people_.taken_s - last_taken_s_ : 0.0;
    last_taken_s_ = people_.taken_s;
    const bool jumped = on && (passed_s <= 0.0 || passed_s - meant_s > kClockJump_s);
    if (camera_frames_ > 0) longest_gap_s_ = std::max(longest_gap_s_, wall_s - last_frame_s_);
    if (camera_frames_ == 0) first_frame_s_ = wall_s;
    if (on) metrics_.dropped += people_.sequence - last_sequence_ - 1;
    if (jumped) note_fault(Fault::clock, texts_[Text::clock_changed]);
    // The least delay seen stands for none: when capture and wall began together is not told.
    if (!on || jumped || !clock_offset_s_) clock_offset_s_ = people_.taken_s - captured_s;
    clock_offset_s_ = std::min(*clock_offset_s_, people_.taken_s - captured_s);
}

void Kiosk::take_frame(double dt_s) {
    const pipeline::SensorFrame& pictures = feed_.pictures();
    const double wall_s = pipeline::wall_seconds();
    look_at_clock(wall_s, 1e-9 * static_cast<double>(people_.timestamp_ns));
    ++camera_frames_;
    last_ns_ = people_.timestamp_ns;
    last_sequence_ = people_.sequence;
    last_frame_s_ = wall_s;
    const Eigen::Isometry3d eye =
        feed_.stream().world_from_camera.value_or(Eigen::Isometry3d::Identity());
    visitors_.see(people_, feed_, eye.translation().cast<float>(), dt_s);
    visitors_.order_waiting(articles_);
    if (measuring_ == Measuring::looking) turn_to_measure(dt_s);
    const double picture_began_s = pipeline::wall_seconds();
    if (run_.draw) give_picture(pictures, dt_s);
    picture_s_ = pipeline::wall_seconds() - picture_began_s;
}

void Kiosk::give_picture(const pipeline::SensorFrame& pictures, double dt_s) {
    const bool seen = shows_picture(screens_.now());
    if (seen || screens_.now() == ScreenName::consent || screens_.now() == ScreenName::measure)
        display_->picture().set_camera(pictures, feed_.stream());
    if (!seen) return;
    lit_.clear();
    for (const Shopper& shopper : visitors_.all())
        if (shopper.looks[0])
            display_->picture().add_lit_places(*shopper.looks[0]->person, pictures, lit_);
    display_->picture().follow_light(pictures, lit_, dt_s);
    if (screens_.now() == ScreenName::setup)
        floor_ = find_camera(pictures.depth, feed_.stream().depth);
}

void Kiosk::turn_to_measure(double dt_s) {
    const Shopper* shopper = visitors_.first();
    if (shopper == nullptr || !shopper->here) return;
    if (shopper->id != measured_) { // never two people in one turn
        measured_ = shopper->id;
        turn_.begin();
    }
    const Eigen::Isometry3d eye =
        feed_.stream().world_from_camera.value_or(Eigen::Isometry3d::Identity());
    turn_.see(shopper->frame, eye.translation().cast<float>(), feed_.pictures(), dt_s);
    if (!turn_.complete()) return;
    measuring_ = Measuring::working;
    tailor_.measure(turn_.take(), feed_.stream());
}

void Kiosk::take_results() {
    if (auto measured = tailor_.take_measured()) {
        Shopper* shopper = visitors_.find(measured_);
        const bool usable = measured->error.empty() && shopper != nullptr;
        measuring_ = usable ? Measuring::done : Measuring::failed;
        if (usable) shopper->measurements = measured->body.body->model().measurements;
        if (!measured->error.empty()) log::warning(measured->error);
    }
    for (DressResult& result : tailor_.take_dressed()) {
        Shopper* shopper = visitors_.find(result.order.person);
        if (shopper == nullptr) continue;
        if (result.worn)
            wear_on(*shopper, std::move(result));
        else
            note_fault(Fault::garment,
                       texts_.with(Text::garment_refused,
                                   {{"id", result.order.article.id}, {"why", result.error}}));
    }
    take_faults();
}

// Plugins that were switched off under what somebody wears: each is said once.
void Kiosk::take_faults() {
    for (Shopper& shopper : visitors_.all())
        for (std::optional<WornLook>& look : shopper.looks) {
            if (!look) continue;
            const std::vector<std::string> faults = look->person->faults();
            for (; look->faults_said < faults.size(); ++look->faults_said)
                note_fault(Fault::plugin,
                           texts_.with(Text::plugin_off, {{"why", faults[look->faults_said]}}));
        }
}

void Kiosk::wear_on(Shopper& shopper, DressResult result) {
    beat(LifeSign::patience); // what it is drawn with may be new to the driver
    WornLook look;
    look.choice = result.order.choice;
    look.advice = result.advice;
    look.timestamp_ns = result.timestamp_ns;
    look.bare = std::move(result.bare);
    look.person = std::move(result.worn);
    look.meshes = std::make_unique<WornMeshes>(display_->picture().renderer(), *look.person,
                                               look.choice.colour, look.bare);
    if (!shopper.body.body) shopper.body = result.order.body;
    shopper.looks[result.order.look].reset(); // its meshes first, then its person
    shopper.looks[result.order.look] = std::move(look);
    ++metrics_.garments;
}

void Kiosk::take_changes() {
    for (const std::string& error : scribe_.take_errors())
        note_fault(Fault::disk, texts_.with(Text::disk_full, {{"why", error}}));
    if (!watch_) return;
    for (const CatalogueChange& change : watch_->take()) {
        const std::string& id = change.article.id;
        if (!change.refused.empty()) {
            note_fault(Fault::garment,
                       texts_.with(Text::garment_refused, {{"id", id}, {"why", change.refused}}));
            continue;
        }
        log::info(texts_.with(Text::garment_changed, {{"id", id}}));
        notes_.push_back({texts_.with(Text::garment_changed, {{"id", id}}),
                          now_s_ + run_.config.operator_line_s});
        for (std::size_t i = 0; i < articles_.size(); ++i) {
            if (articles_[i].id != id) continue;
            articles_[i] = change.article;
            load_thumbnails();
            for (Shopper& shopper : visitors_.all())
                for (std::size_t look = 0; look < shopper.looks.size(); ++look)
                    if (shopper.looks[look] && shopper.wanted[look].article == i) {
                        shopper.wanted[look] = {i, 0, 0};
                        visitors_.order(shopper, look, articles_);
                    }
        }
    }
}

} // namespace toile::apps::kiosk
