// Plugins and the slow work of a mirror: bodies are fitted and garments bound on a worker, and
// swapped in at a frame's boundary.
#pragma once

#include "apps/global_options.h"
#include "apps/kiosk/catalogue.h"
#include "host/job.h"
#include "host/registry.h"
#include "pipeline/body_fit.h"
#include "pipeline/dressed_person.h"
#include "pipeline/people_source.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace toile::apps::kiosk {

/// A person's body in memory; nothing of it is ever written.
struct ShopperBody {
    std::shared_ptr<const pipeline::BoundaryBody> body;
    bool measured = false; ///< by a turn; else by what the tracker saw in passing
};

/// Why a size was chosen.
struct SizeAdvice {
    std::string size;
    std::string other;   ///< the neighbour, when between two sizes
    bool chosen = false; ///< by the shopper, not advised
    bool measured = false;
};

struct DressOrder {
    std::uint32_t person = 0; ///< the tracker's number
    std::size_t look = 0;     ///< 0, or 1 of two side by side
    Choice choice;
    Article article;
    std::map<std::string, double> measurements; ///< of a turn; empty: those of the body worn on
    ShopperBody body;                           ///< or, when it has none:
    std::string model;                          ///< the tracker's shape
    std::vector<double> coefficients;
    std::vector<Vec3f> surface; ///< at rest: clothes are put on over what is worn
    body::Skeleton skeleton;    ///< of it
};

/// Somebody dressed, or why not.
struct DressResult {
    DressOrder order; ///< with the body that was used
    std::unique_ptr<pipeline::DressedPerson> worn;
    std::int64_t timestamp_ns = 0; ///< of the frame it stands in
    SizeAdvice advice;
    std::vector<std::uint32_t> bare; ///< vertices of arms that the garment does not cover
    std::string error;
};

struct MeasureResult {
    ShopperBody body;
    std::string error;
};

/// Joints of another body's bones turned alike, hips at the same place.
[[nodiscard]] pipeline::BodyFrame on_body(const pipeline::BodyFrame& frame,
                                          const body::BodyModel& model);

/// Not movable.
class Tailor {
  public:
    /// `at_once`: orders are done when they are given (lock-step: the same bytes each time), else
    /// on a thread of its own. `safe`: no plugins but those beside the program. \throw Error
    Tailor(const GlobalOptions& global, bool live_clock, bool at_once, bool safe);
    ~Tailor();
    Tailor(const Tailor&) = delete;
    Tailor& operator=(const Tailor&) = delete;

    /// Replaces an order for the same person and look that has not begun.
    void dress(DressOrder order);
    /// Frames of one camera, a person seen from several sides.
    void measure(std::vector<pipeline::SensorFrame> frames, const pipeline::SensorStream& stream);
    /// Where a person stands now, so that the garment is bound in that pose.
    void see(const pipeline::BodyFrame& frame);
    /// Orders and results of people who are gone are dropped, what is known of them overwritten.
    void forget();
    /// The same of one person.
    void forget(std::uint32_t person);

    [[nodiscard]] std::vector<DressResult> take_dressed();
    [[nodiscard]] std::optional<MeasureResult> take_measured();
    [[nodiscard]] double progress() const { return progress_; }
    [[nodiscard]] bool busy() const { return open_ > 0; }

    /// Held while plugins are looked up.
    [[nodiscard]] std::mutex& registry_mutex() { return registry_mutex_; }
    [[nodiscard]] host::Registry& registry() { return registry_; }
    [[nodiscard]] host::Services& services() { return services_; }
    [[nodiscard]] const toile_limits& limits() const { return limits_; }

  private:
    void give(std::function<void()> work, bool front);
    void run();
    [[nodiscard]] DressResult dressed(DressOrder order);
    [[nodiscard]] ShopperBody body_of(const DressOrder& order);
    [[nodiscard]] std::shared_ptr<const pipeline::BoundaryBody> boundary(body::BodyModel model);
    [[nodiscard]] std::shared_ptr<const pipeline::BoundaryGarment>
    garment_of(const DressOrder& order, const body::BodyModel& body, SizeAdvice& advice);
    [[nodiscard]] std::optional<pipeline::BodyFrame> seen(std::uint32_t person);
    void settle(DressResult& result, pipeline::BodyFrame frame);

    host::Services services_;
    host::Registry registry_;
    toile_limits limits_{};
    bool at_once_;
    std::mutex registry_mutex_;

    struct Kept {
        std::uint64_t stamp = 0;
        std::shared_ptr<const garment::GarmentPackage> package;
    };
    std::map<std::string, Kept> packages_; ///< worker only
    std::map<std::string, std::shared_ptr<const pipeline::BoundaryBody>> made_on_;
    std::atomic<std::uint64_t> revision_{1};

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::function<void()>> work_;
    std::vector<DressResult> dressed_;
    std::optional<MeasureResult> measured_;
    std::map<std::uint32_t, pipeline::BodyFrame> seen_;
    std::uint64_t visit_ = 0;                          ///< results of earlier ones are dropped
    std::map<std::uint32_t, std::uint64_t> forgotten_; ///< how often each was: their orders too
    std::atomic<double> progress_{0.0};
    std::atomic<int> open_{0};
    std::atomic<bool> stop_{false};
    std::atomic<bool> cancel_{false};
    std::thread thread_;
};

} // namespace toile::apps::kiosk
