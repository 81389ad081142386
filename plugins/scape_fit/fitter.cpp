#include "scape_fit/fitter.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"
#include "scape_fit/floor_contact.h"
#include "scape_fit/skin_tone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::scape_fit {

/// Some rounds at one level, reach and scale shrinking from first to last.
struct Fitter::Stage {
    std::size_t level = 0;
    int rounds = 0;
    std::array<float, 2> reach_m{};
    std::array<float, 2> scale_m{};
    float empty_weight = 0.3f;
    float outline_weight = 0.0f;
    bool dressed = false;
    int learn_from = 0;        ///< round after which the gaps of cloth are learned, in each
    double shape_weight = 0.0; ///< instead of the options'; 0: theirs
    bool along_rays = false;
    bool fix_shape = false;
    bool free_form = false;
    int detail_rounds = 0; ///< after `rounds`: detail, then a round and detail again
    double damping = 1e-3;
    double from = 0.0, to = 1.0; ///< of the whole fit, for progress
};

namespace {

constexpr float kPoke = 0.002f;    // metres: a body so far out of its cloth is drawn in
constexpr float kMostPoke = 0.06f; // farther it is another sheet of it
constexpr int kPokeRounds = 2;
constexpr float kBeneath = -0.7f; // up of a normal that looks down
constexpr std::size_t kFaceStarts = 2;
constexpr double kLeastBare = 0.12; // share of skin that says where a dressed body stands
constexpr std::size_t kStartPoints = 400;
constexpr std::size_t kStarts = 6;
constexpr double kBetterArm = 0.97; // of the points' distance: else the arm stays
constexpr double kDressedStartWeight = 0.5;
constexpr int kLetGo = 5;               // rounds in which the body lets go of the cloth
constexpr float kOnFace = 0.02f;        // metres from the fitted face
constexpr double kOneSideWeight = 0.03; // of the prior, see FitOptions
constexpr std::size_t kCoarsePoints = 3000;
constexpr std::size_t kMediumPoints = 16000;
constexpr float kOutlinePixel = 3e-4f; // m^2 that a pixel of the outline counts as

/// Every n-th point, areas made up for it.
Observation fewer(const Observation& from, std::size_t count) {
    if (from.points.size() <= count) return from;
    Observation out;
    out.instant = from.instant;
    out.camera = from.camera;
    out.eye = from.eye;
    out.view = from.view;
    out.outline = from.outline;
    out.complete = from.complete;
    const double step = static_cast<double>(from.points.size()) / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(static_cast<double>(i) * step);
        out.points.push_back(from.points[at]);
        if (!from.normals.empty()) out.normals.push_back(from.normals[at]);
        if (!from.rim.empty()) out.rim.push_back(from.rim[at]);
        if (!from.hues.empty()) out.hues.push_back(from.hues[at]);
        if (!from.covers.empty()) out.covers.push_back(from.covers[at]);
        out.areas.push_back(from.areas[at] * static_cast<float>(step));
    }
    return out;
}

std::vector<Observation> fewer(std::span<const Observation> all, std::size_t count) {
    std::vector<Observation> out;
    for (const Observation& one : all)
        out.push_back(fewer(one, count / all.size()));
    return out;
}

float between(const std::array<float, 2>& ends, float at) {
    return ends[0] * std::pow(ends[1] / ends[0], at);
}

/// Root mean square distance with all that has no partner counted as `far`.
double cost(std::span<const Association> associations, double far) {
    double squares = 0.0, area = 0.0;
    for (const Association& a : associations) {
        squares += a.squares + (a.observed_area - a.paired_area) * far * far;
        area += a.observed_area;
    }
    return std::sqrt(squares / std::max(area, 1e-9));
}

} // namespace

FitOptions options_for_pictures(std::size_t cameras, std::size_t instants) {
    FitOptions out;
    out.free_form = {0.008, 0.15, 1e8};
    out.dressed_free_form = {0.004, 0.15, 1.5e8};
    if (cameras > 1) out.camera = kCalibrated;
    if (cameras == 1 && instants == 1) {
        // Little is known of the depth of a body. Detail of the side that is seen would take over
        // what the components say of the other.
        out.shape_weight = kOneSideWeight;
        out.detail_rounds = 1;
    }
    return out;
}

FitOptions options_for_scan() {
    FitOptions out;
    out.free_form = {0.008, 0.06, 2e9};
    out.dressed_free_form = {0.004, 0.15, 1.5e8};
    return out;
}

/// A stage at work.
class Fitter::Refinement {
  public:
    Refinement(Fitter& fitter, std::span<ObservedPoints> observed, const Stage& stage,
               const FitOptions& options, const RowLoop& rows, FitResult& result)
        : fitter_(fitter), observed_(observed), stage_(stage), options_(options), rows_(rows),
          result_(result), level_(fitter.model_.level(stage.level)),
          posed_(result.state.poses.size()), contacts_(posed_.size()),
          associations_(observed.size()) {
        if (stage.dressed) cloth_.emplace(level_, options.cloth);
        for (std::size_t f = 0; f < posed_.size(); ++f)
            associators_.emplace_back(level_);
    }

    void run() {
        look(0);
        if (cloth_) {
            cloth_->find_bare(associations_);
            look(0);
        }
        for (int round = 0; round < all_rounds(); ++round) {
            if (round >= stage_.rounds) {
                find_offsets();
                look(round);
            }
            step(round);
            look(round + 1); // the last one is for offsets and figures
        }
        if (stage_.free_form) find_offsets();
        judge();
    }

  private:
    [[nodiscard]] int all_rounds() const { return stage_.rounds + stage_.detail_rounds; }
    void look(int round);
    void step(int round);
    void find_offsets();
    void judge();

    Fitter& fitter_;
    std::span<ObservedPoints> observed_;
    const Stage& stage_;
    const FitOptions& options_;
    const RowLoop& rows_;
    FitResult& result_;
    const FitLevel& level_;
    std::optional<ClothGaps> cloth_;
    std::vector<PosedLevel> posed_;         ///< of each instant
    std::vector<Associator> associators_;   ///< likewise
    std::vector<Association> contacts_;     ///< likewise, with the floor
    std::vector<Association> associations_; ///< of each observation
    std::vector<AssociatedView> views_;
};

/// Poses the body and pairs it with what was observed.
void Fitter::Refinement::look(int round) {
    const FitState& state = result_.state;
    const float at =
        stage_.rounds > 1
            ? std::min(1.0f, static_cast<float>(round) / static_cast<float>(stage_.rounds - 1))
            : 1.0f;
    AssociationOptions pairing;
    pairing.reach_m = between(stage_.reach_m, at);
    pairing.scale_m = between(stage_.scale_m, at);
    pairing.along_rays = stage_.along_rays;
    pairing.empty_weight = stage_.empty_weight;
    pairing.outline_weight = stage_.outline_weight;
    pairing.cloth = cloth_ ? &*cloth_ : nullptr;
    for (std::size_t f = 0; f < posed_.size(); ++f) {
        pose_level(fitter_.model_, level_, state.shape, state.poses[f], posed_[f]);
        associators_[f].set_surface(posed_[f]);
    }
    views_.clear();
    for (std::size_t i = 0; i < observed_.size(); ++i) {
        ObservedPoints& points = observed_[i];
        const Observation& seen = points.observation;
        if (seen.camera < state.cameras.size()) points.correct(state.cameras[seen.camera]);
        associators_[seen.instant].associate(points, pairing, rows_, associations_[i]);
        views_.push_back({seen.instant, seen.camera, points.eye, &associations_[i]});
    }
    if (cloth_ && round >= stage_.learn_from) cloth_->learn(associations_);
    if (!options_.floor) return;
    for (std::size_t f = 0; f < posed_.size(); ++f) {
        stand_on(level_, posed_[f], *options_.floor, contacts_[f]);
        views_.push_back({f, state.cameras.size(), std::nullopt, &contacts_[f]});
    }
}

/// Moves shape, poses and cameras.
void Fitter::Refinement::step(int round) {
    FitPriors priors;
    priors.sex = result_.sex == body::Sex::invalid ? options_.sex : result_.sex;
    priors.shape_weight = stage_.shape_weight > 0.0 ? stage_.shape_weight : options_.shape_weight;
    priors.fix_shape = stage_.fix_shape;
    priors.camera = options_.camera;
    priors.cameras = options_.cameras;
    fitter_.solver_.step(level_, posed_, views_, priors, stage_.damping, rows_, result_.state);
    ++result_.rounds;
    if (options_.progress(stage_.from + (stage_.to - stage_.from) * (round + 1) / all_rounds()))
        throw Cancelled{};
}

void Fitter::Refinement::find_offsets() {
    std::vector<const PosedLevel*> surfaces;
    std::vector<const Association*> pairs;
    for (std::size_t i = 0; i < observed_.size(); ++i) {
        surfaces.push_back(&posed_[observed_[i].observation.instant]);
        pairs.push_back(&associations_[i]);
    }
    fitter_.free_form_.solve(surfaces, pairs,
                             stage_.dressed ? options_.dressed_free_form : options_.free_form,
                             result_.state.shape.offsets);
}

void Fitter::Refinement::judge() {
    result_.rms_m = cost(associations_, stage_.reach_m[1]);
    double observed_area = 0.0, paired = 0.0;
    for (const Association& a : associations_) {
        observed_area += a.observed_area;
        paired += a.paired_area;
    }
    result_.paired_share = paired / std::max(observed_area, 1e-9);
}

void Fitter::refine(std::span<ObservedPoints> observed, const Stage& stage,
                    const FitOptions& options, const RowLoop& rows, FitResult& result) {
    Refinement(*this, observed, stage, options, rows, result).run();
}

Fitter::Scope Fitter::scope_of(std::span<const Observation> observations) {
    Scope out;
    for (const Observation& one : observations) {
        if (one.points.empty()) throw Error("an observation without points");
        out.instants = std::max(out.instants, one.instant + 1);
        if (one.eye) out.cameras = std::max(out.cameras, one.camera + 1);
        out.depth = out.depth || one.eye.has_value();
    }
    if (out.instants == 0) throw Error("nothing was observed");
    return out;
}

body::Sex Fitter::likelier_sex(const ShapeVector& shape) const {
    return solver_.unlikeliness(shape, body::kSexes[0]) <
                   solver_.unlikeliness(shape, body::kSexes[1])
               ? body::kSexes[0]
               : body::kSexes[1];
}

/// The best of the library's bodies after some steps each. `seen`: of one instant.
FitResult Fitter::start_instant(std::span<const Observation> seen, const FitResult& before,
                                const FitOptions& options, const RowLoop& rows) {
    std::vector<Vec3f> few;
    for (const Observation& one : seen) {
        const std::size_t step =
            std::max<std::size_t>(1, one.points.size() * seen.size() / kStartPoints);
        for (std::size_t i = 0; i < one.points.size(); i += step)
            few.push_back(one.points[i]);
    }
    std::vector<ObservedPoints> observed(seen.begin(), seen.end());
    const std::size_t coarse = model_.level_count() - 1;
    FitOptions loose = options;
    loose.camera = {}, loose.cameras.clear();
    FitResult best;
    best.rms_m = std::numeric_limits<double>::max();
    for (const Start& start : library_.find(few, options.ups, options.starts, rows)) {
        FitResult tried;
        tried.state.shape.coefficients =
            before.state.poses.empty() ? start.shape : before.state.shape.coefficients;
        tried.state.poses = {start.pose};
        tried.state.cameras.resize(before.state.cameras.size());
        Stage first{coarse, 3, {0.3f, 0.2f}, {0.15f, 0.10f}};
        first.fix_shape = true;
        refine(observed, first, loose, rows, tried);
        const Stage second{coarse, 12, {0.2f, 0.08f}, {0.10f, 0.04f}};
        refine(observed, second, loose, rows, tried);
        if (tried.rms_m < best.rms_m) best = std::move(tried);
    }
    if (options.starts >= kStarts) retry_arms(observed, loose, rows, best);
    return best;
}

/// The library's people hold both arms alike: each arm is tried in all of its ways.
void Fitter::retry_arms(std::span<ObservedPoints> observed, const FitOptions& options,
                        const RowLoop& rows, FitResult& best) {
    Stage arm{model_.level_count() - 1, 4, {0.15f, 0.08f}, {0.08f, 0.04f}};
    arm.fix_shape = true;
    for (const bool left : {true, false}) {
        const body::Pose held = best.state.poses[0];
        for (std::size_t way = 0; way < StartLibrary::arm_count(); ++way) {
            FitResult tried = best;
            tried.state.poses[0] = library_.with_arm(held, left, way);
            refine(observed, arm, options, rows, tried);
            if (tried.rms_m < kBetterArm * best.rms_m) best = std::move(tried);
        }
    }
}

/// Each instant on its own; the shape is the first one's.
FitResult Fitter::start(std::span<const Observation> observations, const Scope& scope,
                        const FitOptions& options, const RowLoop& rows) {
    const auto coarse_points = fewer(observations, kCoarsePoints * scope.instants);
    FitResult result;
    result.state.cameras.resize(scope.cameras);
    for (std::size_t f = 0; f < scope.instants; ++f) {
        std::vector<Observation> of_instant;
        for (const Observation& one : coarse_points) {
            if (one.instant != f) continue;
            of_instant.push_back(one);
            of_instant.back().instant = 0;
        }
        FitResult best = start_instant(of_instant, result, options, rows);
        if (f == 0)
            result = std::move(best);
        else
            result.state.poses.push_back(best.state.poses.front());
    }
    return result;
}

/// All instants and cameras, at the middle level. Cameras are believed until the pose is right:
/// else they would take up its errors.
void Fitter::find_together(std::span<const Observation> observations, const Scope& scope,
                           const FitOptions& options, const RowLoop& rows, FitResult& result) {
    const auto points = fewer(observations, kMediumPoints * scope.instants);
    std::vector<ObservedPoints> observed(points.begin(), points.end());
    Stage medium{1, 10, {0.10f, 0.06f}, {0.05f, 0.03f}};
    medium.along_rays = scope.depth;
    medium.outline_weight = kOutlinePixel;
    medium.from = 0.4, medium.to = 0.6;
    FitOptions fixed = options;
    fixed.camera = {}, fixed.cameras.clear();
    refine(observed, medium, fixed, rows, result);
    if (options.camera.turn_rad <= 0.0 && options.cameras.empty()) return;
    medium.reach_m[0] = medium.reach_m[1], medium.scale_m[0] = medium.scale_m[1];
    medium.from = 0.5;
    medium.empty_weight = 0.0f;
    refine(observed, medium, options, rows, result);
}

void Fitter::find_detail(std::span<const Observation> observations, const Scope& scope,
                         const FitOptions& options, const RowLoop& rows, FitResult& result) {
    std::vector<ObservedPoints> observed(observations.begin(), observations.end());
    const bool depth = scope.depth;
    Stage fine{
        0, 8, {0.06f, depth ? 0.06f : 0.03f}, {depth ? 0.05f : 0.03f, depth ? 0.05f : 0.03f}};
    fine.along_rays = depth;
    fine.outline_weight = kOutlinePixel;
    if (depth) fine.empty_weight = 0.0f; // outlines say it without bias
    fine.from = 0.6, fine.to = 1.0;
    fine.free_form = options.use_free_form;
    if (fine.free_form) fine.detail_rounds = options.detail_rounds;
    refine(observed, fine, options, rows, result);
}

/// Tells of every point that has a hue whether it is skin, after the skin of the face; returns
/// skin's share of the points, nothing where the face does not tell.
std::optional<double> Fitter::find_covers(const FitState& state,
                                          std::vector<Observation>& observations) const {
    const FitLevel& level = model_.level(1);
    std::vector<geometry::PointTree> faces;
    std::vector<std::vector<Vec3f>> normals;
    for (const body::Pose& pose : state.poses) {
        PosedLevel posed;
        pose_level(model_, level, state.shape, pose, posed);
        std::vector<Vec3f> places;
        normals.emplace_back();
        for (std::size_t v = 0; v < level.face.size(); ++v) {
            if (level.face[v] == 0) continue;
            places.push_back(posed.positions[v]);
            normals.back().push_back(posed.normals[v]);
        }
        faces.emplace_back(places);
    }
    std::vector<Vec2f> of_faces;
    bool scan = false; // of a mannequin, perhaps: its skin is of any colour
    for (const Observation& one : observations)
        for (std::size_t i = 0; i < one.hues.size(); ++i) {
            const auto near = faces[one.instant].nearest(one.points[i]);
            if (near.squared > kOnFace * kOnFace) continue;
            const Vec3f& normal = normals[one.instant][near.index];
            if (one.eye && normal.dot(*one.eye - one.points[i]) <= 0.0f) continue;
            if (!one.eye && !one.normals.empty() && normal.dot(one.normals[i]) <= 0.0f) continue;
            scan = scan || !one.eye;
            of_faces.push_back(one.hues[i]);
        }
    const auto tone = SkinTone::learn(of_faces, scan);
    if (!tone) return std::nullopt;
    std::size_t skin = 0, all = 0;
    for (Observation& one : observations) {
        one.covers.assign(one.hues.size(), Cover::unknown);
        for (std::size_t i = 0; i < one.hues.size(); ++i) {
            if (!one.hues[i].allFinite()) continue;
            one.covers[i] = tone->like(one.hues[i]) ? Cover::skin : Cover::cloth;
            skin += one.covers[i] == Cover::skin ? 1 : 0;
        }
        all += one.points.size();
    }
    return static_cast<double>(skin) / static_cast<double>(all);
}

/// Skin alone, where colours tell it from cloth and there is enough of it; else nothing.
std::vector<Observation> Fitter::bare_points(const FitState& state,
                                             std::span<const Observation> observations) const {
    std::vector<Observation> told(observations.begin(), observations.end());
    const auto share = find_covers(state, told);
    if (!share || *share < kLeastBare) return {};
    for (Observation& one : told) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < one.points.size(); ++i) {
            if (one.covers[i] != Cover::skin) continue;
            // What closes a hem is no skin, although it has the colour of the legs beside it.
            const Vec3f up = state.poses.at(one.instant).rotations[0] * Vec3f::UnitY();
            if (!one.normals.empty() && one.normals[i].dot(up) < kBeneath) continue;
            one.points[kept] = one.points[i];
            if (!one.normals.empty()) one.normals[kept] = one.normals[i];
            one.areas[kept] = one.areas[i];
            ++kept;
        }
        one.points.resize(kept);
        if (!one.normals.empty()) one.normals.resize(kept);
        one.areas.resize(kept);
        one.hues.clear();
        one.covers.clear();
        one.rim.clear();
        one.complete = false;
    }
    return told;
}

/// A dressed body in a scan of one instant: from its skin, within its cloth.
void Fitter::fit_bare(std::span<const Observation> observations, const Scope& scope,
                      FitOptions options, const RowLoop& rows, std::vector<Observation>& bare,
                      FitResult& result) {
    double bare_points = 0.0, all_points = 0.0;
    for (const Observation& one : bare)
        bare_points += static_cast<double>(one.points.size());
    for (const Observation& one : observations)
        all_points += static_cast<double>(one.points.size());
    result = start(bare, scope, options, rows);
    result.sex = options.sex.value_or(likelier_sex(result.state.shape.coefficients));
    for (int round = 0; round <= kPokeRounds; ++round) {
        auto held = bare;
        if (round > 0) add_poked(observations, result.state, held);
        find_together(held, scope, options, rows, result);
        if (round == kPokeRounds && !options.rough) find_detail(held, scope, options, rows, result);
    }
    result.skin_share = bare_points / all_points;
}

/// Points of cloth that the body sticks out of hold it, as skin does.
void Fitter::add_poked(std::span<const Observation> observations, const FitState& state,
                       std::vector<Observation>& held) const {
    for (std::size_t f = 0; f < observations.size(); ++f) {
        const Observation& one = observations[f];
        PosedLevel posed;
        pose_level(model_, model_.level(1), state.shape, state.poses.at(one.instant), posed);
        const geometry::NearestSurface body(posed.positions, model_.level(1).triangles);
        for (std::size_t i = 0; i < one.points.size(); ++i) {
            const auto near = body.nearest(one.points[i], kMostPoke);
            if (near.triangle == geometry::kNoTriangle || near.signed_distance > -kPoke) continue;
            if (!one.normals.empty() && near.normal.dot(one.normals[i]) < 0.7f) continue;
            held[f].points.push_back(one.points[i]);
            if (!one.normals.empty()) held[f].normals.push_back(one.normals[i]);
            held[f].areas.push_back(one.areas[i]);
        }
    }
}

/// What is seen is cloth: the body lies within it, and where cloth is tight in one of the instants
/// it lies on it; one shape for all instants.
void Fitter::find_beneath(std::span<const Observation> observations, const Scope& scope,
                          const FitOptions& options, const RowLoop& rows, FitResult& result) {
    auto points = fewer(observations, kMediumPoints * scope.instants);
    result.skin_share = find_covers(result.state, points);
    std::vector<ObservedPoints> observed(points.begin(), points.end());
    Stage beneath{1, 14, {0.12f, 0.10f}, {0.10f, 0.08f}};
    beneath.along_rays = scope.depth;
    beneath.outline_weight = scope.depth ? kOutlinePixel : 0.0f;
    beneath.dressed = true;
    beneath.learn_from = kLetGo;
    beneath.shape_weight = options.dressed_shape_weight;
    if (scope.depth) beneath.empty_weight = 0.0f; // as in the fine stage
    beneath.from = 0.6, beneath.to = 0.9;
    refine(observed, beneath, options, rows, result);
    if (!options.use_free_form) return;
    beneath.level = 0;
    beneath.rounds = 3;
    beneath.learn_from = 0;
    beneath.reach_m[0] = beneath.reach_m[1], beneath.scale_m[0] = beneath.scale_m[1];
    beneath.from = 0.9, beneath.to = 1.0;
    beneath.free_form = true;
    refine(observed, beneath, options, rows, result);
}

FitResult Fitter::fit(std::span<const Observation> observations, const FitOptions& wanted,
                      const RowLoop& rows) {
    const Scope scope = scope_of(observations);
    FitOptions options = wanted;
    // Cloth is no shape of a body: the prior holds against it.
    if (wanted.dressed) options.shape_weight = std::max(wanted.shape_weight, kDressedStartWeight);
    FitResult result;
    const bool scan_of_clothes = options.dressed && !scope.depth && !observations[0].hues.empty();
    if (scan_of_clothes) {
        FitOptions face = options; // only where the face is: it tells the colour of skin
        face.starts = kFaceStarts;
        result = start(observations, scope, face, rows);
        // Skirts and sleeves of a scan draw a body far off: what is bare is fitted alone.
        auto bare = bare_points(result.state, observations);
        if (!bare.empty()) {
            fit_bare(observations, scope, options, rows, bare, result);
            return result;
        }
    }
    result = start(observations, scope, options, rows);
    result.sex = options.sex.value_or(likelier_sex(result.state.shape.coefficients));
    find_together(observations, scope, options, rows, result);
    if (options.rough) return result;
    if (options.dressed)
        find_beneath(observations, scope, options, rows, result);
    else
        find_detail(observations, scope, options, rows, result);
    return result;
}

} // namespace toile::scape_fit
