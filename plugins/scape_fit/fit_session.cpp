#include "scape_fit/fit_session.h"

#include "body/rotations.h"
#include "geometry/point_tree.h"
#include "scape_fit/cloth_looseness.h"
#include "scape_fit/skin_tone.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace toile::scape_fit {
namespace {

constexpr std::size_t kScanPoints = 40000;
constexpr double kLeastPaired = 0.75;     // of a scan's area within reach of the fitted body
constexpr double kMostRms = 0.02;         // metres, of a scan's points
constexpr double kMostRmsLoose = 0.06;    // beneath the cloth of a scan
constexpr double kLeastPairedDepth = 0.6; // grazing pixels have no partner
constexpr double kMostRmsDepth = 0.045;
constexpr double kLeastSeen = 0.12; // of the body's area: less says too little about it
constexpr double kFarthest = 30.0;  // deviations a coefficient may have: overfitting takes a dozen
constexpr CameraTrust kLooselyPlaced{0.02, 0.03, 0.003}; // found from the person
constexpr CameraTrust kWorld{1e-5, 1e-5, 0.003};         // the others are placed around it
constexpr double kPlacingShare = 0.7;                    // of the time, where cameras are placed

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.0f %%", 100.0 * share);
    return text;
}

std::string millimetres(double metres) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.0f mm", 1000.0 * metres);
    return text;
}

/// Of points on a scan: the hue of its vertex nearest to each.
std::vector<Vec2f> hues_at(std::span<const Vec3f> points, const geometry::TriangleMesh& scan,
                           const std::vector<std::array<std::uint8_t, 4>>& colors,
                           double metres_per_unit) {
    std::vector<Vec3f> places;
    std::vector<std::size_t> vertices;
    for (std::size_t v = 0; v < colors.size(); ++v) {
        if (!scan.positions[v].allFinite()) continue;
        places.emplace_back(static_cast<float>(metres_per_unit) * scan.positions[v]);
        vertices.push_back(v);
    }
    const geometry::PointTree tree(places);
    std::vector<Vec2f> out;
    out.reserve(points.size());
    for (const Vec3f& p : points)
        out.push_back(hue_of(colors[vertices[tree.nearest(p).index]].data()));
    return out;
}

/// Share of the body's area with points within 3 cm.
double seen_share(const FitLevel& level, std::span<const PosedLevel> posed,
                  std::span<const Observation> observations) {
    std::vector<std::uint8_t> seen(level.vertices.size(), 0);
    for (const Observation& one : observations) {
        const geometry::PointTree tree(one.points);
        for (std::size_t v = 0; v < seen.size(); ++v) {
            const Vec3f& x = posed[one.instant].positions[v];
            const auto near = tree.nearest(x);
            if (near.squared > 0.03f * 0.03f) continue;
            if (one.eye && posed[one.instant].normals[v].dot(*one.eye - x) < 0.0f) continue;
            seen[v] = 1;
        }
    }
    double area = 0.0, all = 0.0;
    for (std::size_t v = 0; v < seen.size(); ++v) {
        all += level.areas[v];
        if (seen[v] != 0) area += level.areas[v];
    }
    return area / all;
}

} // namespace

/// What a fit starts from.
struct FitSession::Input {
    std::vector<Observation> observations;
    FitOptions options;
    nlohmann::ordered_json notes;
    bool depth = false;
    std::vector<Eigen::Isometry3d> places; ///< of the cameras
    std::optional<Placement> placement;    ///< where they were found, when some were lost
};

FitSession::FitSession(const FitModel& model)
    : model_(model), fitter_(model), measurer_(model.space().model()) {}

void FitSession::begin(std::vector<FitCamera> cameras) {
    cameras_ = std::move(cameras);
    instants_.clear();
    colors_.clear();
    scan_.reset();
    fitted_ = false;
}

void FitSession::add_instant(std::vector<imaging::DepthImage> depths,
                             std::vector<imaging::Image> colors) {
    colors.resize(cameras_.size());
    if (depths.size() != cameras_.size())
        throw NotFitted("an instant has " + std::to_string(depths.size()) + " pictures, of " +
                        std::to_string(cameras_.size()) + " cameras");
    const auto fits = [](const auto& picture, const imaging::Intrinsics& camera) {
        return picture.width == camera.width && picture.height == camera.height;
    };
    for (std::size_t c = 0; c < depths.size(); ++c) {
        if (!fits(depths[c], cameras_[c].intrinsics))
            throw NotFitted("a depth picture is not of its camera's size");
        if (!colors[c].empty() && !fits(colors[c], cameras_[c].intrinsics))
            throw NotFitted("a colour picture is not of its depth picture's size");
    }
    instants_.push_back(std::move(depths));
    colors_.push_back(std::move(colors));
    fitted_ = false;
}

void FitSession::add_scan(geometry::TriangleMesh scan,
                          std::vector<std::array<std::uint8_t, 4>> colors) {
    if (!colors.empty() && colors.size() != scan.positions.size())
        throw NotFitted("a scan has " + std::to_string(scan.positions.size()) + " points and " +
                        std::to_string(colors.size()) + " colours");
    scan_ = std::move(scan);
    scan_colors_ = std::move(colors);
    fitted_ = false;
}

FitSession::Input FitSession::scan_input() {
    PreparedScan scan = prepare_scan(*scan_, kScanPoints);
    if (!scan.trouble.empty()) throw NotFitted(scan.trouble);
    Input out;
    out.options = options_for_scan();
    out.options.ups = scan.ups;
    out.options.floor = scan.floor;
    out.notes["unit"] = scan.unit;
    out.notes["metres_per_unit"] = scan.metres_per_unit;
    out.notes["triangles_faced_inwards"] = scan.turned_inside_out;
    out.notes["floor_found"] = scan.floor.has_value();
    out.notes["removed_share"] = scan.removed_share;
    out.notes["has_holes"] = !scan.observation.rim.empty();
    if (!scan_colors_.empty())
        scan.observation.hues =
            hues_at(scan.observation.points, *scan_, scan_colors_, scan.metres_per_unit);
    out.observations.push_back(std::move(scan.observation));
    return out;
}

/// Several cameras, and not all know where they stand: the person tells.
void FitSession::place_lost_cameras(const SessionOptions& options, const RowLoop& rows,
                                    Input& input) {
    PlacementOptions placing;
    placing.sex = options.sex;
    placing.progress = [&](double share) { return options.progress(kPlacingShare * share); };
    input.placement = place_cameras(model_, fitter_, cameras_, instants_, placing, rows);
    if (!input.placement->trouble.empty())
        throw NotFitted(input.placement->trouble +
                        "; not every camera says where it stands: calibrate them (extrinsic.json), "
                        "or let one person stand alone, head to foot in view of all, and feed "
                        "pictures of the same instants");
    input.options.camera = kLooselyPlaced;
    bool known = false;
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
        input.places[c] = input.placement->cameras[c].world_from_camera;
        known = known || cameras_[c].world_from_camera;
        input.options.cameras.push_back(cameras_[c].world_from_camera ? kCalibrated
                                                                      : kLooselyPlaced);
    }
    if (!known) input.options.cameras[0] = kWorld;
    input.options.progress = [progress = options.progress](double share) {
        return progress(kPlacingShare + (1.0 - kPlacingShare) * share);
    };
}

/// The person in all pictures, each camera in its place.
void FitSession::add_pictures(Input& input) const {
    for (std::size_t f = 0; f < instants_.size(); ++f) {
        std::vector<std::shared_ptr<DepthView>> views;
        for (std::size_t c = 0; c < cameras_.size(); ++c) {
            auto view = std::make_shared<DepthView>();
            view->camera = cameras_[c].intrinsics;
            view->world_from_camera = input.places[c];
            view->depth = instants_[f][c];
            view->color = colors_[f][c];
            views.push_back(std::move(view));
        }
        ObservedPerson person = observe_person(views, f);
        if (!person.trouble.empty())
            throw NotFitted("instant " + std::to_string(f) + ": no person: " + person.trouble);
        if (person.observations.empty())
            throw NotFitted("instant " + std::to_string(f) + ": hardly a reading of the person");
        if (f == 0) input.options.floor = person.floor;
        for (Observation& one : person.observations)
            input.observations.push_back(std::move(one));
    }
}

FitSession::Input FitSession::depth_input(const SessionOptions& options, const RowLoop& rows) {
    Input out;
    out.depth = true;
    out.options = options_for_pictures(cameras_.size(), instants_.size());
    bool calibrated = true;
    for (const FitCamera& camera : cameras_) {
        calibrated = calibrated && camera.world_from_camera;
        out.places.push_back(camera.world_from_camera.value_or(Eigen::Isometry3d::Identity()));
    }
    out.options.progress = options.progress;
    if (!calibrated && cameras_.size() > 1) place_lost_cameras(options, rows, out);
    add_pictures(out);
    if (out.options.floor && !calibrated) out.options.ups = {out.options.floor->normal};
    out.notes["cameras"] = cameras_.size();
    out.notes["instants"] = instants_.size();
    out.notes["calibrated"] = calibrated;
    out.notes["floor_found"] = out.options.floor.has_value();
    return out;
}

void FitSession::judge(const Input& input) const {
    const bool loose = input.options.dressed && !input.depth; // skirts stand far off
    const double paired = input.depth || loose ? kLeastPairedDepth : kLeastPaired;
    const double rms = input.depth ? kMostRmsDepth : loose ? kMostRmsLoose : kMostRms;
    const std::string far = "the likeliest body explains only " + percent(result_.paired_share) +
                            " of what was seen, " + millimetres(result_.rms_m) + " off";
    if (result_.paired_share < paired || result_.rms_m > rms)
        throw NotFitted("this does not look like one person: " + far);
    const double most = result_.state.shape.coefficients.cwiseAbs().maxCoeff();
    if (most > kFarthest)
        throw NotFitted("this does not look like a person: nobody is shaped like the nearest "
                        "body to it (" +
                        std::to_string(static_cast<int>(most)) +
                        " standard deviations from the middle)");
    if (result_.seen_share < kLeastSeen)
        throw NotFitted("only " + percent(result_.seen_share) +
                        " of the body is in view: too little to tell its shape");
}

void FitSession::fit(const SessionOptions& options, const RowLoop& rows) {
    if (!scan_ && instants_.empty()) throw NotFitted("nothing was fed to be fitted");
    fitted_ = false;
    Input input = scan_ ? scan_input() : depth_input(options, rows);
    if (scan_) input.options.progress = options.progress;
    input.options.sex = options.sex;
    input.options.dressed = options.dressed;
    result_ = fitter_.fit(input.observations, input.options, rows);
    std::vector<PosedLevel> posed;
    for (std::size_t f = 0; f < instant_count(); ++f)
        posed.push_back(surface(f));
    result_.seen_share = seen_share(model_.level(0), posed, input.observations);
    judge(input);
    rest_ = rest_shape(model_, result_.state.shape);
    measurements_ = measurer_.measure(rest_.positions, rest_.skeleton);
    report_ = input.notes;
    const Vec3f up = result_.state.poses[0].rotations[0] * Vec3f::UnitY();
    report_["up"] = {up.x(), up.y(), up.z()};
    report_["sex"] = std::string(body::sex_name(result_.sex));
    report_["rms_m"] = result_.rms_m;
    report_["paired_share"] = result_.paired_share;
    report_["seen_share"] = result_.seen_share;
    report_["rounds"] = result_.rounds;
    report_cameras(input);
    if (result_.skin_share) report_["skin_share"] = *result_.skin_share;
    if (options.dressed)
        for (const Looseness& one :
             measure_looseness(model_, measurer_, result_.state, input.observations, rows))
            report_["looseness"][one.girth] = {{"looseness", one.looseness},
                                               {"ease_m", one.ease_m}};
    fitted_ = true;
}

void FitSession::report_cameras(const Input& input) {
    for (std::size_t c = 0; c < result_.state.cameras.size(); ++c) {
        const CameraCorrection& camera = result_.state.cameras[c];
        report_["camera_corrections"].push_back(
            {{"turn_deg", camera.turn.norm() / static_cast<double>(body::kDegree)},
             {"shift_m", camera.shift.norm()},
             {"depth_scale", camera.scale}});
        if (!input.placement) continue;
        Eigen::Isometry3d place = input.places[c];
        place.linear() = rotation_of(camera.turn) * place.linear();
        place.translation() += camera.shift;
        const Eigen::Map<const Eigen::Matrix<double, 16, 1>> numbers(place.matrix().data());
        const CameraTrust& trust = input.options.cameras[c];
        report_["found_cameras"].push_back(
            {{"told", cameras_[c].world_from_camera.has_value()},
             {"world_from_camera", std::vector<double>(numbers.begin(), numbers.end())},
             {"believed_within_deg", trust.turn_rad / static_cast<double>(body::kDegree)},
             {"believed_within_m", trust.shift_m},
             {"distance_m", input.placement->cameras[c].together_m},
             {"distance_alone_m", input.placement->cameras[c].alone_m}});
    }
}

PosedLevel FitSession::surface(std::size_t instant) const {
    PosedLevel out;
    pose_level(model_, model_.level(0), result_.state.shape, result_.state.poses.at(instant), out);
    return out;
}

} // namespace toile::scape_fit
