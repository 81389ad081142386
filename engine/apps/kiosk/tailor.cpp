#include "apps/kiosk/tailor.h"

#include "apps/fitted_body.h"
#include "apps/kiosk/bare_parts.h"
#include "apps/plugin_limits.h"
#include "body/body_file.h"
#include "core/error.h"
#include "garment/size_choice.h"

#include <algorithm>

namespace toile::apps::kiosk {
namespace {

// Of how far worn clothes stand off the body: what is put on over them presses them together.
constexpr float kKept = 0.5f;

host::RegistryOptions plugins(const GlobalOptions& global, bool safe) {
    host::RegistryOptions out = registry_options(global);
    if (safe) {
        out.folders.clear();
        out.environment = false;
    }
    return out;
}

// Pictures of a person do not stay in freed memory.
void overwrite(std::vector<pipeline::SensorFrame>& frames) {
    for (pipeline::SensorFrame& frame : frames) {
        std::fill(frame.depth.metres.begin(), frame.depth.metres.end(), 0.0f);
        std::fill(frame.color.pixels.begin(), frame.color.pixels.end(), std::uint8_t{0});
    }
    frames.clear();
}

} // namespace

pipeline::BodyFrame on_body(const pipeline::BodyFrame& frame, const body::BodyModel& model) {
    pipeline::BodyFrame out = frame;
    const body::Pose pose = pipeline::local_pose(pipeline::transforms_of(frame.joints));
    out.joints = pipeline::joints_of(body::forward_kinematics(model.skeleton, pose), 1.0f);
    for (std::size_t j = 0; j < out.joints.size(); ++j)
        out.joints[j].confidence = frame.joints[j].confidence;
    return out;
}

Tailor::Tailor(const GlobalOptions& global, bool live_clock, bool at_once, bool safe)
    : services_(global.threads), registry_(services_, plugins(global, safe)),
      limits_(limits_of(global, services_, kSensedScene, live_clock)), at_once_(at_once) {
    if (!at_once_) thread_ = std::thread([this] { run(); });
}

Tailor::~Tailor() {
    stop_ = cancel_ = true;
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Tailor::give(std::function<void()> work, bool front) {
    ++open_;
    if (at_once_) {
        work();
        --open_;
        return;
    }
    const std::lock_guard lock(mutex_);
    if (front)
        work_.push_front(std::move(work));
    else
        work_.push_back(std::move(work));
    wake_.notify_one();
}

void Tailor::run() {
    while (!stop_) {
        std::function<void()> work;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stop_ || !work_.empty(); });
            if (stop_) return;
            work = std::move(work_.front());
            work_.pop_front();
        }
        work();
        --open_;
    }
}

void Tailor::see(const pipeline::BodyFrame& frame) {
    const std::lock_guard lock(mutex_);
    seen_[frame.person_id] = frame;
}

std::optional<pipeline::BodyFrame> Tailor::seen(std::uint32_t person) {
    const std::lock_guard lock(mutex_);
    const auto found = seen_.find(person);
    if (found == seen_.end()) return std::nullopt;
    return found->second;
}

void Tailor::forget() {
    const std::lock_guard lock(mutex_);
    ++visit_;
    cancel_ = true; // of the visit that is over; the next order clears it
    open_ -= static_cast<int>(work_.size());
    work_.clear();
    dressed_.clear();
    measured_.reset();
    seen_.clear();
    forgotten_.clear();
    progress_ = 0.0;
}

void Tailor::forget(std::uint32_t person) {
    const std::lock_guard lock(mutex_);
    ++forgotten_[person];
    std::erase_if(dressed_, [person](const DressResult& r) { return r.order.person == person; });
    seen_.erase(person);
}

std::vector<DressResult> Tailor::take_dressed() {
    const std::lock_guard lock(mutex_);
    return std::exchange(dressed_, {});
}

std::optional<MeasureResult> Tailor::take_measured() {
    const std::lock_guard lock(mutex_);
    return std::exchange(measured_, std::nullopt);
}

std::shared_ptr<const pipeline::BoundaryBody> Tailor::boundary(body::BodyModel model) {
    return std::make_shared<const pipeline::BoundaryBody>(
        std::make_shared<const body::BodyModel>(std::move(model)), revision_++);
}

ShopperBody Tailor::body_of(const DressOrder& order) {
    if (order.body.body) return order.body;
    if (order.model.empty()) throw Error("nothing is known of the person's shape yet");
    body::BodyFile file;
    file.model = order.model;
    file.made_by = "fit";
    file.coefficients = order.coefficients;
    const std::filesystem::path folder = body::find_avatar(order.model);
    file.model_version = body::load_body_model(folder).version;
    body::BodyModel model = body::model_of(file);
    if (!std::filesystem::exists(folder / "space.json")) return {boundary(std::move(model)), false};
    // The size is that of the person, the surface that of their clothes.
    file.detail = body::detail_of(body::BodySpace::load(folder), order.coefficients, order.surface,
                                  order.skeleton);
    for (float& standing_off : file.detail)
        standing_off *= kKept;
    body::BodyModel dressed = body::model_of(file);
    dressed.measurements = std::move(model.measurements);
    return {boundary(std::move(dressed)), false};
}

std::shared_ptr<const pipeline::BoundaryGarment>
Tailor::garment_of(const DressOrder& order, const body::BodyModel& body, SizeAdvice& advice) {
    Kept& kept = packages_[order.article.id];
    if (!kept.package || kept.stamp != order.article.stamp) {
        kept.package = garment::load_package(order.article.source);
        kept.stamp = order.article.stamp;
    }
    const garment::GarmentSize* size = &kept.package->sizes.front();
    if (order.choice.size > 0) {
        size = &kept.package->sizes.at(order.choice.size - 1);
        advice.chosen = true;
    } else if (kept.package->sizes.size() > 1) {
        const garment::SizeChoice choice = garment::choose_size(
            *kept.package, order.measurements.empty() ? body.measurements : order.measurements);
        size = &kept.package->sizes[choice.index];
        if (choice.between) advice.other = kept.package->sizes[*choice.between].entry.name;
    }
    advice.size = size->entry.name;
    const std::string& avatar =
        size->entry.made_on.empty() ? kept.package->manifest.made_on : size->entry.made_on;
    std::shared_ptr<const pipeline::BoundaryBody> made_on;
    if (!avatar.empty()) {
        auto& known = made_on_[avatar];
        if (!known) known = boundary(body::load_body_model(body::find_avatar(avatar)));
        made_on = known;
    }
    return std::make_shared<const pipeline::BoundaryGarment>(kept.package, *size, made_on);
}

// From the rest pose to where the person stands, then after it as far as it went on meanwhile.
void Tailor::settle(DressResult& result, pipeline::BodyFrame frame) {
    constexpr int kMostRounds = 12;
    const body::BodyModel& model = result.order.body.body->model();
    pipeline::StageClock unmeasured;
    result.worn->start(on_body(frame, model), unmeasured);
    result.timestamp_ns = frame.timestamp_ns;
    for (int round = 0; round < kMostRounds && !at_once_; ++round) {
        const auto now = seen(result.order.person);
        if (!now || now->timestamp_ns <= result.timestamp_ns) return;
        const double dt_s = 1e-9 * static_cast<double>(now->timestamp_ns - result.timestamp_ns);
        result.worn->step(on_body(*now, model), std::min(dt_s, 0.3), unmeasured);
        result.timestamp_ns = now->timestamp_ns;
        if (dt_s < 0.07) return;
    }
}

DressResult Tailor::dressed(DressOrder order) {
    DressResult out;
    out.order = std::move(order);
    try {
        out.order.body = body_of(out.order);
        const body::BodyModel& model = out.order.body.body->model();
        const auto garment = garment_of(out.order, model, out.advice);
        out.advice.measured = !out.order.measurements.empty();
        pipeline::DressingOptions options;
        options.limits = limits_;
        {
            host::Job job({}, &stop_);
            const std::lock_guard lock(registry_mutex_);
            out.worn = std::make_unique<pipeline::DressedPerson>(
                registry_, services_, out.order.body.body, std::vector{garment}, options, job);
        }
        out.bare = bare_vertices(*out.worn);
        const auto frame = seen(out.order.person);
        if (!frame) throw Error("the person is gone");
        settle(out, *frame);
    } catch (const std::exception& e) {
        out.worn.reset();
        out.error = e.what();
    }
    return out;
}

void Tailor::dress(DressOrder order) {
    std::uint64_t visit = 0;
    std::uint64_t forgotten = 0;
    const std::uint32_t person = order.person;
    {
        const std::lock_guard lock(mutex_);
        visit = visit_;
        forgotten = forgotten_[person];
        cancel_ = false;
    }
    give(
        [this, visit, forgotten, person, order = std::move(order)]() mutable {
            DressResult result = dressed(std::move(order));
            const std::lock_guard lock(mutex_);
            if (visit == visit_ && forgotten == forgotten_[person])
                dressed_.push_back(std::move(result));
        },
        false);
}

void Tailor::measure(std::vector<pipeline::SensorFrame> frames,
                     const pipeline::SensorStream& stream) {
    std::uint64_t visit = 0;
    {
        const std::lock_guard lock(mutex_);
        visit = visit_;
        cancel_ = false;
    }
    progress_ = 0.0;
    give(
        [this, visit, stream, frames = std::move(frames)]() mutable {
            MeasureResult result;
            try {
                host::Job job([this](double share, std::string_view) { progress_ = share; },
                              &cancel_);
                std::unique_lock lock(registry_mutex_);
                pipeline::BodyFit fit(registry_, services_, limits_);
                lock.unlock();
                fit.begin_cameras({&stream, 1}, job);
                for (const pipeline::SensorFrame& frame : frames)
                    fit.feed_frames({&frame, 1});
                const pipeline::FittedBody fitted = fit.fit({std::nullopt, true}, job);
                result.body = {boundary(body::model_of(body_file_of(fitted))), true};
            } catch (const std::exception& e) {
                result.error = e.what();
            }
            overwrite(frames);
            const std::lock_guard lock(mutex_);
            if (visit == visit_) measured_ = std::move(result);
        },
        true);
}

} // namespace toile::apps::kiosk
