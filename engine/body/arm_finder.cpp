#include "body/arm_finder.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace toile::body {
namespace {

constexpr int kCuts = 80;        // along the arm
constexpr float kTurns = 0.006f; // share by which a girth must turn to make a peak or a hollow
constexpr float kBend = 0.02f;   // of the arm's length: an elbow this far off the straight line
constexpr double kFeature = 0.8, kNearFeature = 0.6, kPlaced = 0.4, kGuess = 0.2;

/// For each side of each triangle the triangle beyond it.
std::vector<std::array<std::uint32_t, 3>> neighbours(std::span<const Triangle> triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> sides;
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            sides[{triangles[f][k], triangles[f][(k + 1) % 3]}] = f;
    std::vector<std::array<std::uint32_t, 3>> out(triangles.size());
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto beyond = sides.find({triangles[f][(k + 1) % 3], triangles[f][k]});
            out[f][k] = beyond == sides.end() ? f : beyond->second;
        }
    return out;
}

/// What hangs together beyond a plane, from the triangle nearest to `seed`.
std::vector<Triangle> beyond(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                             const geometry::Plane& plane, const Vec3f& seed) {
    const auto middle = [&](const Triangle& t) -> Vec3f {
        return (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3.0f;
    };
    const auto outside = [&](const Triangle& t) {
        return plane.normal.dot(middle(t)) > plane.offset;
    };
    std::uint32_t first = 0;
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t f = 0; f < triangles.size(); ++f) {
        const float d = (middle(triangles[f]) - seed).squaredNorm();
        if (d >= least || !outside(triangles[f])) continue;
        least = d;
        first = f;
    }
    const auto next_to = neighbours(triangles);
    std::vector<char> reached(triangles.size(), 0);
    std::vector<std::uint32_t> queue = {first};
    reached[first] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (const std::uint32_t n : next_to[queue[i]])
            if (reached[n] == 0 && outside(triangles[n])) {
                reached[n] = 1;
                queue.push_back(n);
            }
    std::sort(queue.begin(), queue.end());
    std::vector<Triangle> out;
    for (const std::uint32_t f : queue)
        out.push_back(triangles[f]);
    return out;
}

Vec3f middle_of(const std::vector<Vec3f>& hull) {
    Vec3f sum = Vec3f::Zero();
    float area = 0.0f;
    for (std::size_t i = 1; i + 1 < hull.size(); ++i) {
        const float a = (hull[i] - hull[0]).cross(hull[i + 1] - hull[0]).norm();
        sum += a * (hull[0] + hull[i] + hull[i + 1]) / 3.0f;
        area += a;
    }
    return area > 0.0f ? Vec3f(sum / area) : hull.front();
}

Vec3f extreme(const std::vector<Vec3f>& points, const Vec3f& direction) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3f& a, const Vec3f& b) {
        return direction.dot(a) < direction.dot(b);
    });
}

/// Cuts across the line from shoulder to fingertip.
struct Cuts {
    std::vector<geometry::Loop> tapes;
    std::vector<Vec3f> middles;
    Profile girth; ///< over the distance from the shoulder
};

Cuts cut_along(const geometry::GirthCutter& cutter, const Vec3f& root, const Vec3f& tip) {
    Cuts out;
    const float length = (tip - root).norm();
    for (int k = 0; k < kCuts; ++k) {
        const float s = length * (static_cast<float>(k) + 0.5f) / kCuts;
        geometry::Loop tape = cutter.tape(cutter.offset(root) + s);
        if (tape.points.size() < 3) continue;
        out.girth.add(s, static_cast<float>(tape.length()));
        out.middles.push_back(middle_of(tape.points));
        out.tapes.push_back(std::move(tape));
    }
    return out;
}

struct Place {
    std::size_t cut;
    double trust;
};

/// The hand is the thickest place of the outer third (its fingers spread), the wrist the hollow
/// behind it.
Place find_wrist(const Profile& girth) {
    Profile hand, inwards;
    for (std::size_t i = girth.size(); i-- > 0;) {
        if (girth.at[i] > 0.65f * girth.at.back()) hand.add(girth.at[i], girth.value[i]);
        inwards.add(girth.at[i], girth.value[i]);
    }
    const std::size_t thick = hand.largest();
    const Profile rest = inwards.between(inwards.at[thick], inwards.at.back());
    if (const auto wrist = rest.first_hollow(0.1f); wrist && thick > 0)
        return {girth.size() - 1 - (thick + *wrist), kFeature};
    return {girth.size() - 1 - girth.size() / 4, kGuess};
}

/// The farthest from the straight line of what leads from shoulder to wrist; on a straight arm the
/// hollow behind the forearm's bulge.
Place find_elbow(const Cuts& cuts, const Vec3f& root, std::size_t wrist) {
    const Vec3f line = cuts.middles[wrist] - root;
    std::size_t best = wrist / 2;
    float most = 0.0f;
    for (std::size_t i = 0; i < wrist; ++i) {
        const float off = (cuts.middles[i] - root).cross(line).norm() / line.norm();
        const float along = (cuts.middles[i] - root).dot(line) / line.squaredNorm();
        if (off <= most || along < 0.3f || along > 0.75f) continue;
        most = off;
        best = i;
    }
    if (most > kBend * line.norm()) return {best, kNearFeature};
    Profile inwards;
    for (std::size_t i = wrist; i-- > 0;)
        inwards.add(cuts.girth.at[i], cuts.girth.value[i]);
    if (const auto bulge = inwards.first_peak(kTurns)) {
        const Profile rest = inwards.between(inwards.at[*bulge], inwards.at.back());
        if (const auto hollow = rest.first_hollow(kTurns)) {
            const std::size_t i = wrist - 1 - (*bulge + *hollow);
            if (i > wrist / 4) return {i, kPlaced};
        }
    }
    return {wrist / 2, kGuess};
}

} // namespace

FoundArm find_arm(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                  const FoundTrunk& trunk, bool left) {
    const std::size_t side = left ? 0 : 1;
    const Vec3f armpit = trunk.armpit[side].point, shoulder = trunk.shoulder[side].point;
    Vec3f out_of_body = (shoulder - armpit).cross(Vec3f::UnitZ()).normalized();
    if (!left) out_of_body = -out_of_body;
    FoundArm out;
    const Vec3f root = 0.5f * (armpit + shoulder);
    const float thick = (shoulder - armpit).norm();
    out.triangles = beyond(positions, triangles, geometry::Plane::through(armpit, out_of_body),
                           root + 0.5f * thick * out_of_body);

    // The tip is the farthest point from the shoulder.
    Vec3f tip = root;
    for (const Triangle& t : out.triangles)
        for (const std::uint32_t v : t)
            if ((positions[v] - root).norm() > (tip - root).norm()) tip = positions[v];
    const geometry::SurfacePart part(out.triangles);
    const geometry::GirthCutter cutter(positions, part, (tip - root).normalized());
    const Cuts cuts = cut_along(cutter, root, tip);
    if (cuts.tapes.size() < kCuts / 2)
        throw Error(std::string("nothing of a ") + (left ? "left" : "right") +
                    " arm was found beside the trunk");

    const Place wrist = find_wrist(cuts.girth);
    const Place elbow = find_elbow(cuts, root, wrist.cut);
    const Vec3f at_elbow = cuts.middles[elbow.cut], at_wrist = cuts.middles[wrist.cut];
    out.joints = {root, at_elbow, at_wrist, 0.5f * (at_wrist + tip)};
    const auto on = [&](std::size_t cut, const Vec3f& direction, double trust) {
        return FoundPoint{extreme(cuts.tapes[cut].points, direction), trust};
    };
    out.elbow = on(elbow.cut, -Vec3f::UnitZ(), elbow.trust);
    out.radiale = on(elbow.cut, out_of_body, std::min(elbow.trust, kPlaced));
    out.wrist = on(wrist.cut, -Vec3f::UnitZ(), std::min(wrist.trust, kNearFeature));
    out.inner_wrist = on(wrist.cut, Vec3f::UnitZ(), std::min(wrist.trust, kNearFeature));
    out.fingertip = {tip, wrist.trust};
    return out;
}

} // namespace toile::body
