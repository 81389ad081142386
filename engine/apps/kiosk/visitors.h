// The people before the mirror: who is there, who agreed, what they wear.
#pragma once

#include "apps/kiosk/feed.h"
#include "apps/kiosk/layout.h"
#include "apps/kiosk/pointer.h"
#include "apps/kiosk/tailor.h"
#include "apps/kiosk/worn_meshes.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace toile::apps::kiosk {

/// One outfit that is worn; meshes go before the person that they show.
struct WornLook {
    Choice choice;
    SizeAdvice advice;
    std::int64_t timestamp_ns = 0;
    std::vector<std::uint32_t> bare; ///< vertices of arms that it does not cover
    std::size_t faults_said = 0;     ///< of the person's plugins, to the operator
    std::unique_ptr<pipeline::DressedPerson> person;
    std::unique_ptr<WornMeshes> meshes;
};

struct Shopper {
    std::uint32_t id = 0; ///< the tracker's
    bool agreed = false;
    bool here = false; ///< seen in this frame, and near enough
    double unseen_s = 0.0;
    pipeline::BodyFrame frame;
    std::string model; ///< of the tracker's shape
    std::vector<double> coefficients;
    std::uint64_t shape_revision = 0;
    std::vector<Vec3f> surface; ///< at rest, with what they wear
    body::Skeleton skeleton;    ///< of it
    ShopperBody body; ///< what clothes are worn on: the tracker's shape, which its joints fit
    std::map<std::string, double> measurements; ///< of the turn, for the size; or empty
    std::array<Choice, 2> wanted;               ///< of each look
    std::array<bool, 2> waiting{};              ///< to be ordered once the shape is known
    std::array<std::optional<WornLook>, 2> looks;
    std::optional<Reach> reach; ///< where their buttons are
    double reach_off_s = 0.0;   ///< so long they have stood elsewhere
};

/// Maps a place of the world to pixels of the screen; nothing when it is behind the camera.
using ToScreen = std::function<std::optional<Vec2f>(const Vec3f&)>;

/// Not movable.
class Visitors {
  public:
    Visitors(Tailor& tailor, std::uint32_t most, double away_s)
        : tailor_(tailor), most_(most), away_s_(away_s) {}

    /// Who is in the frame; those away for too long are forgotten. `eye`: the camera's place.
    void see(const pipeline::PeopleFrame& frame, const Feed& feed, const Vec3f& eye, double dt_s);
    /// No frame: the camera is lost, or nothing new.
    void see_nobody(double dt_s);
    /// Everything of everybody.
    void erase();
    /// Everything of one; who stays there is somebody who was not asked yet.
    void erase(std::uint32_t id);

    [[nodiscard]] std::vector<Shopper>& all() { return shoppers_; }
    [[nodiscard]] const std::vector<Shopper>& all() const { return shoppers_; }
    /// The nearest of those who agreed, or of all while nobody has.
    [[nodiscard]] Shopper* first();
    [[nodiscard]] const Shopper* first() const;
    [[nodiscard]] Shopper* find(std::uint32_t id);
    [[nodiscard]] const Shopper* find(std::uint32_t id) const;
    [[nodiscard]] std::size_t agreed() const;
    /// Near enough; once somebody agreed, only those who did count.
    [[nodiscard]] std::uint32_t count() const;
    /// Somebody is seen, though nobody near enough.
    [[nodiscard]] bool somebody_far() const { return far_; }

    /// Asks the tailor for what a shopper wants to wear, now or once their shape is known.
    void order(Shopper& shopper, std::size_t look, const std::vector<Article>& articles);
    void order_waiting(const std::vector<Article>& articles);
    /// Moves everybody's clothes on to the frame; a gap longer than `longest_s` counts as that.
    void step(pipeline::StageClock& clock, double longest_s);

    /// Raised hands, pixels of the screen.
    [[nodiscard]] std::vector<Hand> hands(const ToScreen& to_screen) const;
    [[nodiscard]] static std::optional<Reach> reach(const Shopper& shopper,
                                                    const ToScreen& to_screen);

  private:
    Tailor& tailor_;
    std::uint32_t most_;
    double away_s_;
    std::vector<Shopper> shoppers_;
    bool far_ = false;
};

} // namespace toile::apps::kiosk
