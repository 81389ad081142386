#include "scape_fit/camera_placement.h"

#include "body/rotations.h"
#include "scape_fit/body_alignment.h"
#include "scape_fit/person_finder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::scape_fit {
namespace {

using body::Joint;

constexpr std::size_t kInstants = 4;     // looked at, spread over all
constexpr int kMostWidth = 360;          // pixels of a picture that is looked at
constexpr std::size_t kSeenPoints = 400; // of a camera at an instant, to be aligned
constexpr std::size_t kBodyLevel = 1;    // of the model: 3,000 vertices
constexpr std::size_t kSeeds = 2;        // cameras whose body may be the one to begin with
constexpr std::size_t kChoices = 2;      // places of the first camera around it
constexpr int kRounds = 4;               // of placing and fitting
constexpr double kAsGood = 1.5;          // times the best: placed in the same round
constexpr double kAloneWeight = 0.1;     // of the shape's prior where one side is seen
// Distance of a camera's points from the body of all: metres, and this much more than the best
// has that is fitted alone.
constexpr double kMostDistance = 0.018, kMostShare = 1.3, kMostMore = 0.0055;
constexpr CameraTrust kFirst{0.10, 0.10, 0.0};
constexpr CameraTrust kFixed{1e-5, 1e-5, 0.0};

/// Cameras that stand firmly to each other, in an upright frame of their own.
struct Unit {
    std::vector<std::size_t> cameras;
    bool has_floor = false;                     ///< at y = 0
    std::vector<Eigen::Isometry3d> from_camera; ///< unit_from_camera of each
    std::vector<Observation> observations;
    std::vector<SeenPoints> seen;
    std::vector<StandingBody> alone; ///< fitted to it alone, of each instant
    double alone_m = 0.0;
};

/// Where the units stand, in the frame of the one that was begun with.
struct Arrangement {
    std::vector<Alignment> units;
    double worst = 1e9; ///< the units' largest distance
};

/// Every n-th pixel, so that no picture is wider than need be.
std::shared_ptr<DepthView> thinned(const imaging::Intrinsics& camera,
                                   const imaging::DepthImage& depth) {
    auto out = std::make_shared<DepthView>();
    const int n = (camera.width + kMostWidth - 1) / kMostWidth;
    out->camera = camera;
    out->camera.width = out->depth.width = (camera.width + n - 1) / n;
    out->camera.height = out->depth.height = (camera.height + n - 1) / n;
    for (double* number : {&out->camera.fx, &out->camera.fy, &out->camera.cx, &out->camera.cy})
        *number /= n;
    for (int y = 0; y < camera.height; y += n)
        for (int x = 0; x < camera.width; x += n)
            out->depth.metres.push_back(
                depth.metres[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                             static_cast<std::size_t>(x)]);
    return out;
}

/// The same in another frame.
Observation moved(const Observation& from, const Eigen::Isometry3d& to_from) {
    Observation out = from;
    const Eigen::Isometry3f place = to_from.cast<float>();
    for (Vec3f& p : out.points)
        p = place * p;
    for (Vec3f& direction : out.outline)
        direction = place.linear() * direction;
    if (out.eye) out.eye = place * *out.eye;
    if (from.view) {
        auto view = std::make_shared<DepthView>(*from.view);
        view->world_from_camera = to_from * view->world_from_camera;
        out.view = std::move(view);
    }
    return out;
}

/// Turned and lifted so that the floor is y = 0.
Eigen::Isometry3d stood_on(const geometry::Plane& floor) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond::FromTwoVectors(floor.normal.cast<double>(), Vec3d::UnitY())
                       .toRotationMatrix();
    out.translation().y() = -static_cast<double>(floor.offset);
    return out;
}

std::vector<std::size_t> spread_order(std::size_t count) {
    std::vector<std::size_t> out;
    for (std::size_t parts = 1; parts <= count; parts *= 2)
        for (std::size_t i = 0; i < parts; ++i) {
            const std::size_t at = i * count / parts;
            if (std::find(out.begin(), out.end(), at) == out.end()) out.push_back(at);
        }
    for (std::size_t i = 0; i < count; ++i)
        if (std::find(out.begin(), out.end(), i) == out.end()) out.push_back(i);
    return out;
}

/// How well a joint is known from one side.
double joint_weight(Joint joint) {
    switch (joint) {
    case Joint::hips:
    case Joint::spine:
    case Joint::chest:
    case Joint::upper_chest:
    case Joint::neck:
    case Joint::head:
    case Joint::left_shoulder:
    case Joint::right_shoulder:
    case Joint::left_upper_arm:
    case Joint::right_upper_arm:
    case Joint::left_upper_leg:
    case Joint::right_upper_leg:
        return 1.0;
    default:
        return 0.3;
    }
}

class Placer {
  public:
    Placer(const FitModel& model, Fitter& fitter, std::span<const FitCamera> cameras,
           const PlacementOptions& options, const RowLoop& rows)
        : model_(model), fitter_(fitter), cameras_(cameras), options_(options), rows_(rows) {
        Unit known;
        for (std::size_t c = 0; c < cameras.size(); ++c)
            if (cameras[c].world_from_camera) known.cameras.push_back(c);
        if (!known.cameras.empty()) units_.push_back(std::move(known));
        for (std::size_t c = 0; c < cameras.size(); ++c)
            if (!cameras[c].world_from_camera) units_.emplace_back().cameras = {c};
    }

    Placement place(std::span<const std::vector<imaging::DepthImage>> instants);

  private:
    [[nodiscard]] std::string look(std::span<const std::vector<imaging::DepthImage>> instants);
    [[nodiscard]] std::string look_at(std::span<const std::vector<imaging::DepthImage>> instants,
                                      std::size_t instant, std::vector<ObservedPerson>& out) const;
    void stand(Unit& unit, const std::optional<geometry::Plane>& floor);
    [[nodiscard]] FitOptions fit_options(bool floor);
    [[nodiscard]] std::vector<StandingBody> bodies_of(const FitResult& result) const;
    void fit_alone(Unit& unit);
    [[nodiscard]] Freedom freedom(const Unit& a, const Unit& b) const;
    [[nodiscard]] std::vector<Alignment> places_of(const Unit& seed, const Unit& unit,
                                                   std::span<const StandingBody> bodies) const;
    [[nodiscard]] std::vector<StandingBody>
    fit_together(std::size_t seed, std::span<const std::uint8_t> with, Arrangement& arrangement);
    [[nodiscard]] Arrangement arrange(std::size_t seed, std::size_t choice);
    [[nodiscard]] Placement placement(const Arrangement& arrangement) const;

    const FitModel& model_;
    Fitter& fitter_;
    std::span<const FitCamera> cameras_;
    const PlacementOptions& options_;
    const RowLoop& rows_;
    std::vector<Unit> units_; ///< the first tells the world
    std::size_t instants_ = 0;
    double progress_ = 0.0;
};

/// The person in every unit at one instant, or why there is none.
std::string Placer::look_at(std::span<const std::vector<imaging::DepthImage>> instants,
                            std::size_t instant, std::vector<ObservedPerson>& out) const {
    out.clear();
    for (const Unit& unit : units_) {
        std::vector<std::shared_ptr<DepthView>> views;
        for (const std::size_t c : unit.cameras) {
            views.push_back(thinned(cameras_[c].intrinsics, instants[instant][c]));
            if (cameras_[c].world_from_camera)
                views.back()->world_from_camera = *cameras_[c].world_from_camera;
        }
        ObservedPerson person = observe_person(views, 0);
        if (person.trouble.empty() && person.observations.empty())
            person.trouble = "hardly a reading of the person";
        if (!person.trouble.empty())
            return "camera " + std::to_string(unit.cameras.front() + 1) + ", instant " +
                   std::to_string(instant) + ": no person: " + person.trouble;
        for (Observation& one : person.observations)
            one.camera = unit.cameras[one.camera];
        out.push_back(std::move(person));
    }
    return {};
}

void Placer::stand(Unit& unit, const std::optional<geometry::Plane>& floor) {
    unit.has_floor = floor.has_value();
    const Eigen::Isometry3d upright = floor ? stood_on(*floor) : Eigen::Isometry3d::Identity();
    for (const std::size_t c : unit.cameras)
        unit.from_camera.push_back(
            upright * cameras_[c].world_from_camera.value_or(Eigen::Isometry3d::Identity()));
    for (Observation& one : unit.observations) {
        one = moved(one, upright);
        unit.seen.push_back(some_of(one, kSeenPoints));
    }
}

/// Some instants at which all units see the person. Returns why there are none.
std::string Placer::look(std::span<const std::vector<imaging::DepthImage>> instants) {
    std::string trouble;
    std::vector<std::optional<geometry::Plane>> floors(units_.size());
    std::vector<ObservedPerson> people;
    for (const std::size_t instant : spread_order(instants.size())) {
        if (instants_ >= kInstants) break;
        const std::string why = look_at(instants, instant, people);
        if (trouble.empty()) trouble = why;
        if (!why.empty()) continue;
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (!floors[u]) floors[u] = people[u].floor;
            for (Observation& one : people[u].observations) {
                one.instant = instants_;
                units_[u].observations.push_back(std::move(one));
            }
        }
        ++instants_;
    }
    if (instants_ == 0) return trouble;
    for (std::size_t u = 0; u < units_.size(); ++u)
        stand(units_[u], floors[u]);
    return {};
}

FitOptions Placer::fit_options(bool floor) {
    FitOptions out;
    out.sex = options_.sex;
    out.rough = true;
    if (floor) out.floor = geometry::Plane{};
    // One more fit: how many there will be is not known.
    const double from = progress_;
    progress_ += (1.0 - progress_) / static_cast<double>(units_.size() + 3);
    out.progress = [this, from, to = progress_](double share) {
        return options_.progress(from + (to - from) * share);
    };
    return out;
}

std::vector<StandingBody> Placer::bodies_of(const FitResult& result) const {
    std::vector<StandingBody> out;
    PosedLevel posed;
    for (const body::Pose& pose : result.state.poses) {
        pose_level(model_, model_.level(kBodyLevel), result.state.shape, pose, posed);
        out.emplace_back(posed);
    }
    return out;
}

void Placer::fit_alone(Unit& unit) {
    FitOptions options = fit_options(unit.has_floor);
    if (unit.cameras.size() == 1) options.shape_weight = kAloneWeight;
    unit.alone = bodies_of(fitter_.fit(unit.observations, options, rows_));
    unit.alone_m = distance(unit.alone, unit.seen, Eigen::Isometry3d::Identity());
}

Freedom Placer::freedom(const Unit& a, const Unit& b) const {
    return a.has_floor && b.has_floor ? Freedom::level : Freedom::any;
}

/// Begins where the joints of the unit's own body meet those of the bodies, as they are called and
/// with left and right changed (one of the two may have been taken for its mirror image), and from
/// all sides.
std::vector<Alignment> Placer::places_of(const Unit& seed, const Unit& unit,
                                         std::span<const StandingBody> bodies) const {
    std::vector<Eigen::Isometry3d> starts;
    for (const bool mirrored : {false, true}) {
        std::vector<Vec3f> from, to;
        std::vector<double> weights;
        for (std::size_t f = 0; f < bodies.size(); ++f)
            for (std::size_t j = 0; j < body::kJointCount; ++j) {
                const auto joint = static_cast<Joint>(j);
                const Joint own = mirrored ? body::opposite_joint(joint) : joint;
                from.push_back(unit.alone[f].joints[static_cast<std::size_t>(own)]);
                to.push_back(bodies[f].joints[j]);
                weights.push_back(joint_weight(joint));
            }
        starts.push_back(aligned(from, to, weights, freedom(seed, unit)));
    }
    return find_places(bodies, unit.seen, starts, freedom(seed, unit), rows_);
}

/// One body for some of the units, and these moved a little so that it explains them.
std::vector<StandingBody> Placer::fit_together(std::size_t seed, std::span<const std::uint8_t> with,
                                               Arrangement& arrangement) {
    std::vector<Observation> observations;
    FitOptions options = fit_options(units_[seed].has_floor);
    options.camera = kFirst;
    options.cameras.assign(cameras_.size(), kFirst);
    for (std::size_t u = 0; u < units_.size(); ++u) {
        if (with[u] == 0) continue;
        for (const Observation& one : units_[u].observations)
            observations.push_back(moved(one, arrangement.units[u].place));
    }
    for (const std::size_t c : units_[seed].cameras)
        options.cameras[c] = kFixed;
    const FitResult result = fitter_.fit(observations, options, rows_);
    auto bodies = bodies_of(result);
    for (std::size_t u = 0; u < units_.size(); ++u) {
        if (with[u] == 0) continue;
        Alignment& unit = arrangement.units[u];
        if (u != seed) {
            const CameraCorrection& found = result.state.cameras[units_[u].cameras[0]];
            const Vec3d eye = unit.place * units_[u].from_camera[0].translation();
            unit.place = Eigen::Translation3d(eye + found.shift) *
                         Eigen::Quaterniond(rotation_of(found.turn)) * Eigen::Translation3d(-eye) *
                         unit.place;
        }
        unit.distance_m = distance(bodies, units_[u].seen, unit.place);
    }
    return bodies;
}

/// All units around the body of one of them: those first that its body explains best, then
/// the others around the body that these have found together.
Arrangement Placer::arrange(std::size_t seed, std::size_t choice) {
    Arrangement out;
    out.units.resize(units_.size());
    out.units[seed] = {Eigen::Isometry3d::Identity(), units_[seed].alone_m};
    const std::vector<StandingBody>* bodies = &units_[seed].alone;
    std::vector<StandingBody> together;
    std::vector<std::uint8_t> with;
    for (int round = 0; round < kRounds; ++round) {
        const bool complete = !with.empty() && std::count(with.begin(), with.end(), 1) ==
                                                   static_cast<std::ptrdiff_t>(units_.size());
        std::vector<double> worse(units_.size(), 0.0);
        double least = 1e9;
        for (std::size_t u = 0; u < units_.size(); ++u) {
            if (u == seed) continue;
            const auto places = places_of(units_[seed], units_[u], *bodies);
            out.units[u] = places[round == 0 ? std::min(choice, places.size() - 1) : 0];
            worse[u] = out.units[u].distance_m;
            least = std::min(least, worse[u]);
        }
        with.assign(units_.size(), 0);
        for (std::size_t u = 0; u < units_.size(); ++u)
            with[u] = u == seed || complete || worse[u] <= kAsGood * least ? 1 : 0;
        together = fit_together(seed, with, out);
        bodies = &together;
        if (complete) break;
    }
    out.worst = 0.0;
    for (std::size_t u = 0; u < units_.size(); ++u) {
        out.units[u].distance_m = distance(*bodies, units_[u].seen, out.units[u].place);
        out.worst = std::max(out.worst, out.units[u].distance_m);
    }
    return out;
}

Placement Placer::placement(const Arrangement& arrangement) const {
    Placement out;
    out.cameras.resize(cameras_.size());
    const Unit& first = units_.front();
    const auto& known = cameras_[first.cameras[0]].world_from_camera;
    Eigen::Isometry3d world = Eigen::Isometry3d::Identity(); // from the first unit
    if (known)
        world = *known * first.from_camera[0].inverse();
    else if (first.has_floor) {
        world.translation() = -first.from_camera[0].translation();
        world.translation().y() = 0.0;
    }
    world = world * arrangement.units[0].place.inverse();
    for (std::size_t u = 0; u < units_.size(); ++u)
        for (std::size_t i = 0; i < units_[u].cameras.size(); ++i) {
            PlacedCamera& camera = out.cameras[units_[u].cameras[i]];
            camera.world_from_camera =
                world * arrangement.units[u].place * units_[u].from_camera[i];
            camera.alone_m = units_[u].alone_m;
            camera.together_m = arrangement.units[u].distance_m;
        }
    return out;
}

Placement Placer::place(std::span<const std::vector<imaging::DepthImage>> instants) {
    Placement out;
    out.trouble = look(instants);
    if (!out.trouble.empty()) return out;
    for (Unit& unit : units_)
        fit_alone(unit);
    // Cameras that know where they stand keep to each other: their body is begun with.
    std::vector<std::size_t> seeds(units_.size());
    std::iota(seeds.begin(), seeds.end(), std::size_t{0});
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
        return units_[a].alone_m < units_[b].alone_m;
    });
    if (units_.front().cameras.size() > 1) seeds = {0};
    seeds.resize(std::min(seeds.size(), kSeeds));
    const double most = std::min(kMostDistance, kMostShare * units_[seeds[0]].alone_m + kMostMore);
    Arrangement best;
    for (std::size_t choice = 0; choice < kChoices; ++choice)
        for (const std::size_t seed : seeds) {
            if (best.worst < most) break;
            const Arrangement tried = arrange(seed, choice);
            if (tried.worst < best.worst) best = tried;
        }
    out = placement(best);
    if (best.worst >= most)
        out.trouble = "the cameras cannot be placed from the person: no single body explains what "
                      "all of them see";
    return out;
}

} // namespace

Placement place_cameras(const FitModel& model, Fitter& fitter, std::span<const FitCamera> cameras,
                        std::span<const std::vector<imaging::DepthImage>> instants,
                        const PlacementOptions& options, const RowLoop& rows) {
    return Placer(model, fitter, cameras, options, rows).place(instants);
}

} // namespace toile::scape_fit
