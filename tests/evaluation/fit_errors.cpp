#include "evaluation/fit_errors.h"

#include "core/error.h"
#include "geometry/nearest_surface.h"

#include <algorithm>
#include <cmath>

namespace toile::evaluation {
namespace {

using body::Joint;

constexpr int kAlignRounds = 6;
constexpr double kLeastLegGirth = 0.2;     // metres
constexpr double kCrotchAccuracy = 0.0002; // metres
constexpr double kMillimetres = 1000.0;
constexpr float kLeastFacing = 0.17365f; // cosine of 80 degrees

std::size_t index(Joint joint) {
    return static_cast<std::size_t>(joint);
}

const Vec3f& place(const PosedSurface& surface, Joint joint) {
    return surface.joints[index(joint)].translation;
}

double mean_distance(std::span<const Vec3f> from, std::span<const float> areas,
                     const Selection& keep, const geometry::NearestSurface& to) {
    double sum = 0.0, area = 0.0;
    for (std::size_t v = 0; v < from.size(); ++v) {
        if (!keep(v)) continue;
        const auto share = static_cast<double>(areas[v]);
        sum += share * static_cast<double>(to.nearest(from[v]).distance);
        area += share;
    }
    return kMillimetres * sum / std::max(area, 1e-12);
}

/// A tape around the trunk goes around both thighs where they part above its plane, and not around
/// the arms, even where they grow together with the trunk in it.
std::vector<Triangle> without_arms(const PosedSurface& surface) {
    const auto arm = [&](std::uint32_t v) {
        const body::Part part = surface.parts[v];
        return part == body::Part::left_upper_arm || part == body::Part::right_upper_arm ||
               part == body::Part::left_lower_arm || part == body::Part::right_lower_arm;
    };
    std::vector<Triangle> out;
    for (const auto& t : surface.triangles)
        if (!arm(t[0]) && !arm(t[1]) && !arm(t[2])) out.push_back(t);
    return out;
}

std::optional<double> girth_of(const body::GirthPlane& plane, const RigidTransform& moved,
                               const PosedSurface& surface) {
    const bool trunk =
        plane.name == "bust_girth" || plane.name == "waist_girth" || plane.name == "hip_girth";
    if (!trunk) return body::girth_in(plane, moved, surface.positions, surface.triangles);
    const auto cut = geometry::Plane::through(moved * plane.point, moved.rotation * plane.normal);
    std::vector<Vec3f> points;
    for (const auto& loop : geometry::slice(surface.positions, without_arms(surface), cut))
        points.insert(points.end(), loop.points.begin(), loop.points.end());
    if (points.empty()) return std::nullopt;
    return geometry::hull_girth(points, cut);
}

/// What lengths are taken between, metres.
struct Places {
    double soles = 0.0, top = 0.0, crotch = 0.0; // heights
    Vec3f cervicale = Vec3f::Zero();
    std::array<Vec3f, 2> acromion{}; // left, right
};

/// Where the legs' level cuts become one; bisected between knees and hips.
double crotch_of(const PosedSurface& surface) {
    const auto triangles = without_arms(surface);
    const auto apart = [&](double height) {
        const geometry::Plane level{Vec3f::UnitY(), static_cast<float>(height)};
        const auto loops = geometry::slice(surface.positions, triangles, level);
        return std::count_if(loops.begin(), loops.end(), [](const geometry::Loop& loop) {
                   return loop.closed && loop.length() > kLeastLegGirth;
               }) > 1;
    };
    const auto height = [&](Joint left, Joint right) {
        return 0.5 * static_cast<double>(place(surface, left).y() + place(surface, right).y());
    };
    double below = height(Joint::left_lower_leg, Joint::right_lower_leg);
    double above = height(Joint::left_upper_leg, Joint::right_upper_leg);
    while (above - below > kCrotchAccuracy) {
        const double middle = 0.5 * (below + above);
        (apart(middle) ? below : above) = middle;
    }
    return 0.5 * (below + above);
}

Places places_of(const PosedSurface& surface) {
    Places out;
    const auto [low, high] =
        std::minmax_element(surface.positions.begin(), surface.positions.end(),
                            [](const Vec3f& a, const Vec3f& b) { return a.y() < b.y(); });
    out.soles = static_cast<double>(low->y());
    out.top = static_cast<double>(high->y());
    out.crotch = crotch_of(surface);
    return out;
}

std::map<std::string, double> lengths_of(const PosedSurface& surface, const Places& at) {
    const auto height = [&](Joint joint) {
        return static_cast<double>(place(surface, joint).y()) - at.soles;
    };
    const auto far = [](const Vec3f& a, const Vec3f& b) {
        return static_cast<double>((a - b).norm());
    };
    const auto arm = [&](const Vec3f& acromion, Joint elbow, Joint wrist) {
        return far(acromion, place(surface, elbow)) +
               far(place(surface, elbow), place(surface, wrist));
    };
    return {{"stature", at.top - at.soles},
            {"crotch_height", at.crotch - at.soles},
            {"hip_height", 0.5 * (height(Joint::left_upper_leg) + height(Joint::right_upper_leg))},
            {"cervicale_height", static_cast<double>(at.cervicale.y()) - at.soles},
            {"shoulder_breadth", far(at.acromion[0], at.acromion[1])},
            {"arm_length", 0.5 * (arm(at.acromion[0], Joint::left_lower_arm, Joint::left_hand) +
                                  arm(at.acromion[1], Joint::right_lower_arm, Joint::right_hand))}};
}

/// Whether a picture shows a point that faces its camera, if nothing hides it.
bool faces(const simulated_sensor::DepthCamera& camera, const Vec3f& point, const Vec3f& normal) {
    if (normal.dot((camera.origin() - point).normalized()) < kLeastFacing) return false;
    const auto pixel = imaging::project(
        camera.intrinsics(), camera.settings().world_from_camera.inverse() * point.cast<double>());
    return pixel && pixel->x() >= 0.0 && pixel->y() >= 0.0 &&
           pixel->x() <= camera.intrinsics().width - 1.0 &&
           pixel->y() <= camera.intrinsics().height - 1.0;
}

} // namespace

std::vector<float> vertex_areas(std::span<const Vec3f> positions,
                                std::span<const Triangle> triangles) {
    std::vector<float> out(positions.size(), 0.0f);
    for (const auto& t : triangles) {
        const float third =
            (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]).norm() /
            6.0f;
        for (const auto v : t)
            out[v] += third;
    }
    return out;
}

double mean_distance(const PosedSurface& from, const Selection& keep, const PosedSurface& to) {
    const geometry::NearestSurface surface(to.positions, to.triangles);
    return mean_distance(from.positions, vertex_areas(from.positions, from.triangles), keep,
                         surface);
}

double aligned_distance(const PosedSurface& from, const Selection& keep, const PosedSurface& to) {
    const geometry::NearestSurface surface(to.positions, to.triangles);
    const auto areas = vertex_areas(from.positions, from.triangles);
    std::vector<Vec3f> moved(from.positions.begin(), from.positions.end());
    for (int round = 0; round < kAlignRounds; ++round) {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
        for (std::size_t v = 0; v < moved.size(); ++v) {
            if (!keep(v)) continue;
            const auto near = surface.nearest(moved[v]);
            const Triangle& t = to.triangles[near.triangle];
            const Vec3f across = (to.positions[t[1]] - to.positions[t[0]])
                                     .cross(to.positions[t[2]] - to.positions[t[0]])
                                     .normalized();
            Eigen::Matrix<double, 6, 1> row;
            row << moved[v].cross(across).cast<double>(), across.cast<double>();
            normal += areas[v] * row * row.transpose();
            right += areas[v] * row * static_cast<double>(across.dot(near.point - moved[v]));
        }
        const Eigen::Matrix<double, 6, 1> step = normal.ldlt().solve(right);
        const Vec3d turn = step.head<3>();
        const Eigen::AngleAxisf by(static_cast<float>(turn.norm()),
                                   turn.normalized().cast<float>());
        for (Vec3f& p : moved)
            p = by * p + step.tail<3>().cast<float>();
    }
    return mean_distance(moved, areas, keep, surface);
}

bool in_core(const body::TestPerson& person, std::size_t vertex) {
    if (person.parts[vertex] == body::Part::head) return false;
    const Vec3f& p = person.rest.positions[vertex];
    const auto& rest = person.skeleton;
    if (p.y() < rest.rest(Joint::left_foot).y()) return false;
    for (const bool left : {true, false}) {
        const Vec3f& wrist = rest.rest(left ? Joint::left_hand : Joint::right_hand);
        const Vec3f& elbow = rest.rest(left ? Joint::left_lower_arm : Joint::right_lower_arm);
        const float to_wrist = (p - wrist).norm();
        const float to_elbow = (p - elbow).norm();
        if (to_wrist < to_elbow && to_wrist < 0.25f && to_elbow > 0.9f * (wrist - elbow).norm())
            return false;
    }
    return true;
}

std::vector<std::uint8_t> seen_vertices(const simulated_sensor::Simulator& simulator,
                                        const PosedSurface& truth) {
    std::vector<Vec3f> normals(truth.positions.size());
    geometry::vertex_normals(truth.positions, truth.triangles, normals);
    std::vector<std::uint8_t> out(truth.positions.size(), 0);
    for (std::size_t c = 0; c < simulator.camera_count(); ++c) {
        const auto& camera = simulator.camera(c);
        for (std::size_t v = 0; v < out.size(); ++v)
            if (out[v] == 0 && faces(camera, truth.positions[v], normals[v]) &&
                !simulator.stage().blocked(camera.origin(), truth.positions[v]))
                out[v] = 1;
    }
    return out;
}

std::map<std::string, double> girth_errors(const body::TestPerson& person,
                                           const PosedSurface& truth, const PosedSurface& result) {
    std::map<std::string, double> out;
    for (const body::GirthPlane& plane : person.girths) {
        RigidTransform moved;
        moved.rotation = truth.joints[index(plane.joint)].rotation;
        moved.translation = place(truth, plane.joint) -
                            moved.rotation * person.skeleton.rest_positions[index(plane.joint)];
        const auto true_girth = girth_of(plane, moved, truth);
        const auto girth = girth_of(plane, moved, result);
        if (true_girth && girth) out[plane.name] = kMillimetres * (*girth - *true_girth);
    }
    return out;
}

std::map<std::string, double> length_errors(const body::TestPerson& person,
                                            const PosedSurface& truth, const PosedSurface& result) {
    const geometry::NearestSurface surface(result.positions, result.triangles);
    Places true_places = places_of(truth);
    Places places = places_of(result);
    const auto carry = [&](const std::string& landmark, Joint joint, Vec3f& on_truth,
                           Vec3f& on_result) {
        const auto found = person.landmarks.find(landmark);
        if (found == person.landmarks.end())
            throw Error("test person '" + person.id + "' has no landmark '" + landmark + "'");
        on_truth = truth.positions[found->second];
        on_result = surface.nearest(on_truth - place(truth, joint) + place(result, joint)).point;
    };
    carry("cervicale", Joint::neck, true_places.cervicale, places.cervicale);
    carry("left_acromion", Joint::left_upper_arm, true_places.acromion[0], places.acromion[0]);
    carry("right_acromion", Joint::right_upper_arm, true_places.acromion[1], places.acromion[1]);
    std::map<std::string, double> out = lengths_of(result, places);
    for (const auto& [name, length] : lengths_of(truth, true_places))
        out[name] = kMillimetres * (out.at(name) - length);
    return out;
}

} // namespace toile::evaluation
