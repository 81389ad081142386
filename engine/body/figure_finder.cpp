#include "body/figure_finder.h"

#include "body/arm_finder.h"
#include "core/error.h"
#include "geometry/level_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace toile::body {
namespace {

constexpr float kLeastHeight = 0.3f, kMostHeight = 3.0f; // metres

void check(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    const auto report = geometry::check_topology(positions, triangles);
    if (triangles.empty()) throw Error("the surface has no triangles");
    if (!report.manifold()) throw Error("the surface cannot be measured: " + report.text());
    if (report.boundary_edges > 0)
        throw Error("the surface is not closed (" + std::to_string(report.boundary_edges) +
                    " border edges): fill its holes first");
}

void check_height(float height) {
    if (height >= kLeastHeight && height <= kMostHeight) return;
    std::ostringstream text;
    text << "the body is " << height << " m high; a person is 0.3 to 3 m: scale it to metres";
    throw Error(text.str());
}

/// The largest piece by area.
geometry::TriangleMesh largest_piece(std::span<const Vec3f> positions,
                                     std::span<const Triangle> triangles,
                                     std::vector<std::string>& notes) {
    const geometry::TriangleMesh whole{
        {positions.begin(), positions.end()}, {}, {triangles.begin(), triangles.end()}};
    std::vector<geometry::TriangleMesh> pieces = geometry::connected_pieces(whole);
    if (pieces.size() == 1) return whole;
    notes.push_back("the surface has " + std::to_string(pieces.size()) +
                    " pieces; the largest was measured");
    return *std::max_element(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) {
        return geometry::surface_area(a) < geometry::surface_area(b);
    });
}

Vec3f middle_of_volume(const geometry::TriangleMesh& mesh) {
    Vec3d sum = Vec3d::Zero();
    double volume = 0.0;
    const Vec3d base = mesh.positions.front().cast<double>();
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0]].cast<double>() - base;
        const Vec3d b = mesh.positions[t[1]].cast<double>() - base;
        const Vec3d c = mesh.positions[t[2]].cast<double>() - base;
        const double v = a.dot(b.cross(c)) / 6.0;
        sum += v * (a + b + c) / 4.0;
        volume += v;
    }
    if (!(volume > 0.0)) throw Error("the surface is turned inside out: turn its triangles round");
    return (base + sum / volume).cast<float>();
}

Vec2f turned_left(const Vec2f& ahead) { // seen from above, y is z
    return {ahead.y(), -ahead.x()};
}

/// The direction across which a section is thinnest, weighted by how plainly: its second moments.
Vec2f breadth_axis(const Outline& o) {
    Eigen::Matrix2f moments = Eigen::Matrix2f::Zero();
    for (std::size_t i = 0; i < o.points.size(); ++i) {
        const Vec3f& a = o.points[i];
        const Vec3f& b = o.points[(i + 1) % o.points.size()];
        const Vec2f p = 0.5f * Vec2f(a.x() + b.x(), a.z() + b.z()) - o.centroid;
        moments += (b - a).norm() * p * p.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> solver(moments);
    const float ratio = solver.eigenvalues()[0] / solver.eigenvalues()[1];
    return (1.0f - ratio) * solver.eigenvectors().col(1);
}

/// Where the body faces (x, z): across its seat and the line between its legs, to its toes.
Vec2f facing(const FoundLegs& legs, std::vector<std::string>& notes) {
    const auto& [a, b] = legs.legs;
    const float half = 0.5f * (legs.crotch.y() + a.knee);
    Vec2f across = (a.near(half).centroid - b.near(half).centroid).normalized();
    Vec2f seat = breadth_axis(legs.seat);
    if (seat.dot(across) < 0.0f) seat = -seat;
    across = (across + seat).normalized();
    const Vec2f ahead(-across.y(), across.x());
    float feet = 0.0f;
    for (const FoundLeg& leg : legs.legs)
        feet += ahead.dot(leg.toe - leg.near(leg.thinnest).centroid);
    if (std::abs(feet) < 0.02f)
        notes.emplace_back("the feet do not tell where the body faces; it may be turned round");
    return feet < 0.0f ? Vec2f(-ahead) : ahead;
}

RigidTransform figure_from_world(const geometry::TriangleMesh& mesh, const Vec3f& middle,
                                 std::vector<std::string>& notes) {
    const Sections sections(mesh.positions, mesh.triangles);
    const FoundLegs legs = find_legs(sections, middle);
    const Vec2f ahead = facing(legs, notes);
    const Vec2f left = turned_left(ahead);
    Mat3f turn;
    turn << left.x(), 0.0f, left.y(), 0.0f, 1.0f, 0.0f, ahead.x(), 0.0f, ahead.y();
    RigidTransform out;
    out.rotation = Quatf(turn);
    out.translation = -(out.rotation * Vec3f(legs.crotch.x(), sections.floor(), legs.crotch.z()));
    return out;
}

/// Landmarks with their trust, by name.
class Marks {
  public:
    explicit Marks(Figure& figure) : figure_(figure) {
        figure_.landmarks.fill(Vec3f::Zero());
        figure_.landmark_trust.fill(0.0);
    }
    void set(Landmark landmark, const FoundPoint& found) {
        figure_.landmarks[static_cast<std::size_t>(landmark)] = found.point;
        figure_.landmark_trust[static_cast<std::size_t>(landmark)] = found.trust;
    }
    void set(Landmark left, const std::array<FoundPoint, 2>& found) {
        set(left, found[0]);
        set(opposite(left), found[1]);
    }

  private:
    Figure& figure_;
};

/// Outermost point of the leg at a height, to the body's left or right.
Vec3f side_of(const FoundLeg& leg, float y, float direction) {
    const Outline& o = leg.near(y);
    return *std::max_element(o.points.begin(), o.points.end(), [&](const Vec3f& a, const Vec3f& b) {
        return direction * a.x() < direction * b.x();
    });
}

Vec3f front_of(const FoundLeg& leg, float y) {
    const Outline& o = leg.near(y);
    return *std::max_element(o.points.begin(), o.points.end(),
                             [](const Vec3f& a, const Vec3f& b) { return a.z() < b.z(); });
}

void mark_leg(Marks& marks, const FoundLeg& leg, bool left) {
    constexpr double kAnkle = 0.4; // ankle bones show little on a surface
    const auto pick = [left](Landmark l) { return left ? l : opposite(l); };
    const float out = left ? 1.0f : -1.0f;
    marks.set(pick(Landmark::left_knee), FoundPoint{front_of(leg, leg.knee), leg.knee_trust});
    marks.set(pick(Landmark::left_lower_knee),
              FoundPoint{front_of(leg, leg.lower_knee), leg.knee_trust});
    marks.set(pick(Landmark::left_ankle), FoundPoint{side_of(leg, leg.ankle, out), kAnkle});
    marks.set(pick(Landmark::left_inner_ankle), FoundPoint{side_of(leg, leg.ankle, -out), kAnkle});
}

Vec3f joint_at(const FoundLeg& leg, float y) {
    const Vec2f c = leg.near(y).centroid;
    return {c.x(), y, c.y()};
}

Limb leg_joints(const FoundLeg& leg, const Vec3f& trochanter) {
    const Vec2f hip = leg.sections.front().centroid;
    const Vec2f ball =
        leg.near(leg.thinnest).centroid + 0.7f * (leg.toe - leg.near(leg.thinnest).centroid);
    return {Vec3f(hip.x(), trochanter.y(), hip.y()), joint_at(leg, leg.knee),
            joint_at(leg, leg.thinnest), Vec3f(ball.x(), 0.01f, ball.y())};
}

void mark_arm(Marks& marks, const FoundArm& arm, bool left) {
    const auto pick = [left](Landmark l) { return left ? l : opposite(l); };
    marks.set(pick(Landmark::left_elbow), arm.elbow);
    marks.set(pick(Landmark::left_radiale), arm.radiale);
    marks.set(pick(Landmark::left_wrist), arm.wrist);
    marks.set(pick(Landmark::left_inner_wrist), arm.inner_wrist);
    marks.set(pick(Landmark::left_fingertip), arm.fingertip);
}

void mark_trunk(Marks& marks, const FoundTrunk& trunk) {
    using enum Landmark;
    marks.set(brow, trunk.brow);
    marks.set(head_back, trunk.head_back);
    marks.set(larynx, trunk.larynx);
    marks.set(neck_back, trunk.neck_back);
    marks.set(neck_front, trunk.neck_front);
    marks.set(navel, trunk.navel);
    marks.set(left_neck_side, trunk.neck_side);
    marks.set(left_shoulder, trunk.shoulder);
    marks.set(left_armpit, trunk.armpit);
    marks.set(left_scye_front, trunk.scye_front);
    marks.set(left_scye_back, trunk.scye_back);
    marks.set(left_bust_point, trunk.bust_point);
    marks.set(left_under_bust, trunk.under_bust);
    marks.set(left_lowest_rib, trunk.lowest_rib);
    marks.set(left_iliac_crest, trunk.iliac_crest);
    marks.set(left_iliac_spine, trunk.iliac_spine);
    marks.set(left_trochanter, trunk.trochanter);
    marks.set(left_gluteal_fold, trunk.gluteal_fold);
}

/// Triangles sorted by what they belong to; `arms` are known.
Regions sort_regions(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                     const std::array<std::vector<Triangle>, 2>& arms, const FoundLegs& legs,
                     const FoundTrunk& trunk) {
    std::set<Triangle> of_arms(arms[0].begin(), arms[0].end());
    of_arms.insert(arms[1].begin(), arms[1].end());
    std::array<std::vector<Triangle>, kRegionCount> sorted;
    const float knee = std::max(legs.legs[0].knee, legs.legs[1].knee);
    const float hip = trunk.trochanter[0].point.y();
    for (const Triangle& t : triangles) {
        if (of_arms.count(t) != 0) continue;
        const Vec3f middle = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3.0f;
        const auto put = [&](Region r) { sorted[static_cast<std::size_t>(r)].push_back(t); };
        if (middle.y() < hip)
            put(middle.x() > legs.crotch.x() ? Region::left_leg : Region::right_leg);
        if (middle.y() > knee && middle.y() < trunk.brow.point.y()) put(Region::trunk);
        if (middle.y() > trunk.neck_front.point.y()) put(Region::head);
    }
    sorted[static_cast<std::size_t>(Region::left_arm)] = arms[0];
    sorted[static_cast<std::size_t>(Region::right_arm)] = arms[1];
    Regions out;
    for (std::size_t r = 0; r < kRegionCount; ++r)
        out[r] = geometry::SurfacePart(std::move(sorted[r]));
    return out;
}

} // namespace

FoundFigure::FoundFigure(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    check(positions, triangles);
    geometry::TriangleMesh mesh = largest_piece(positions, triangles, notes_);
    const Vec3f middle = middle_of_volume(mesh);
    {
        const Sections sections(mesh.positions, mesh.triangles);
        check_height(sections.stature());
    }
    const RigidTransform turn = figure_from_world(mesh, middle, notes_);
    world_from_figure_ = turn.inverse();
    for (Vec3f& p : mesh.positions)
        p = turn * p;
    positions_ = std::move(mesh.positions);
    triangles_ = std::move(mesh.triangles);

    // Everything again in the frame of the figure, where left and front have a meaning.
    const Sections sections(positions_, triangles_);
    const FoundLegs legs = find_legs(sections, turn * middle);
    const FoundTrunk trunk = find_trunk(positions_, triangles_, sections, legs);
    Marks marks(figure_);
    mark_trunk(marks, trunk);
    marks.set(Landmark::crotch, FoundPoint{legs.crotch, 0.9});
    for (std::size_t side = 0; side < 2; ++side)
        mark_leg(marks, legs.legs[side], side == 0);
    std::array<std::vector<Triangle>, 2> arms;
    figure_.region_trust.fill(1.0);
    for (std::size_t side = 0; side < 2; ++side) {
        const auto region = side == 0 ? Region::left_arm : Region::right_arm;
        if (!trunk.has_arm[side]) {
            notes_.emplace_back(std::string("the ") + (side == 0 ? "left" : "right") +
                                " arm was not found: it must stand off from the trunk");
            figure_.region_trust[static_cast<std::size_t>(region)] = 0.0;
            continue;
        }
        FoundArm arm = find_arm(positions_, triangles_, trunk, side == 0);
        mark_arm(marks, arm, side == 0);
        if (side == 1) figure_.right_arm = arm.joints;
        arms[side] = std::move(arm.triangles);
    }
    regions_ = std::make_unique<Regions>(sort_regions(positions_, triangles_, arms, legs, trunk));
    figure_.positions = positions_;
    figure_.triangles = triangles_;
    figure_.regions = regions_.get();
    figure_.neck_up = trunk.neck_up;
    figure_.right_leg = leg_joints(legs.legs[1], trunk.trochanter[1].point);
}

} // namespace toile::body
