#include "garment/block_drafts.h"
#include "garment/block_loft.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace toile::garment::block {
namespace {

using body::Joint;

double smooth_step(const double low, const double high, const double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// All that the T-shirt takes from one body, metres.
struct Cut {
    const BodyProbe& body;
    TShirtOptions options;
    double underarm_y = 0.0, hem_y = 0.0; // world heights
    double width = 0.0, hem_width = 0.0;  // of a quarter
    Vec3d neck_point, shoulder_point;     // world: ends of the shoulder seam
    double shoulder = 0.0;                // its length
    std::array<double, 2> rise{};         // underarm level to the neck point: front, back
    std::array<double, 2> neck_depth{};   // below the neck point at the centre
    std::shared_ptr<const Loft> loft;

    [[nodiscard]] double shoulder_drop() const { return neck_point.y() - shoulder_point.y(); }
    [[nodiscard]] Vec2d flat_neck(const int face) const { return {neck_point.x(), rise[face]}; }
    [[nodiscard]] Vec2d flat_shoulder(const int face) const {
        const double drop = shoulder_drop();
        return flat_neck(face) + Vec2d(std::sqrt(shoulder * shoulder - drop * drop), -drop);
    }
};

Cut measure(const BodyProbe& body, const TShirtOptions& options) {
    Cut cut{body, options, 0.0, 0.0, 0.0, 0.0, {}, {}, 0.0, {}, {}, nullptr};
    cut.underarm_y = body.armpit_height() - options.armhole_drop_m;
    cut.hem_y = body.joint(Joint::left_upper_leg).y() - 0.045;
    double chest = 0.0;
    for (double y = body.joint(Joint::chest).y(); y < body.armpit_height(); y += 0.01) {
        chest = std::max(chest, body.ring(y).girth());
    }
    double hips = 0.0;
    for (double y = cut.hem_y; y < cut.hem_y + 0.15; y += 0.01) {
        hips = std::max(hips, body.ring(y).girth());
    }
    cut.width = (chest + options.chest_ease_m) / 4.0;
    cut.hem_width = std::max(cut.width, (hips + options.hem_ease_m) / 4.0);
    cut.neck_point = body.ridge(body.neck_half_width() + options.neck_ease_m);
    cut.shoulder_point = body.ridge(body.joint(Joint::left_upper_arm).x() + 0.012);
    cut.shoulder = (cut.neck_point - cut.shoulder_point).norm() + 0.006;
    // Without darts the front can be only a little longer than the back: the hem takes the rest.
    const double front = body.drop_length(cut.neck_point.x(), cut.underarm_y, true);
    const double back = body.drop_length(cut.neck_point.x(), cut.underarm_y, false);
    const double mean = 0.5 * (front + back) + 0.012;
    const double more = std::clamp(0.2 * (front - back), -0.010, 0.010);
    cut.rise = {mean + more, mean - more};
    cut.neck_depth = {cut.neck_point.x() + 0.005, 0.020};
    cut.loft = std::make_shared<const Loft>(
        body, cut.hem_y - 0.02, cut.underarm_y,
        [&](const double y) {
            const double t = (cut.underarm_y - y) / (cut.underarm_y - cut.hem_y);
            return 4.0 * (cut.width + (cut.hem_width - cut.width) * t);
        },
        0.014);
    return cut;
}

// First guess of a torso point: around the trunk below the underarm, over chest and shoulder
// above it.
Vec3d place_torso(const Cut& cut, const int face, const Vec2d& flat) {
    const double side = flat.y() < 0.0 ? cut.width + (cut.hem_width - cut.width) * flat.y() /
                                                         (cut.hem_y - cut.underarm_y)
                                       : cut.width;
    const double share = std::min(1.0, flat.x() / side);
    const double fraction = face == 0 ? 0.5 * share : 1.0 - 0.5 * share;
    const Vec3d below = cut.loft->at(fraction, cut.underarm_y + std::min(0.0, flat.y()));
    if (flat.y() <= 0.0) {
        return below;
    }
    // The shoulder seam lands on the shoulder's ridge; what is below it keeps its share.
    const Vec2d neck = cut.flat_neck(face);
    const Vec2d shoulder = cut.flat_shoulder(face);
    const double x = std::clamp(flat.x(), neck.x(), shoulder.x());
    const double t = (x - neck.x()) / (shoulder.x() - neck.x());
    const double world_x = cut.neck_point.x() + t * (cut.shoulder_point.x() - cut.neck_point.x());
    const Vec3d ridge = cut.body.ridge(world_x);
    const double seam = neck.y() + t * (shoulder.y() - neck.y());
    const double height = flat.y() / seam * (ridge.y() + 0.012 - cut.underarm_y);
    Vec3d above(flat.x() + world_x - x, cut.underarm_y + height, ridge.z());
    double z = 0.0;
    if (cut.body.depth(above.x(), above.y(), face == 0, z)) {
        above.z() = z + (face == 0 ? 0.012 : -0.012);
    }
    const double blend = smooth_step(0.0, 0.09, flat.y());
    Vec3d p = (1.0 - blend) * below + blend * above;
    p.y() = above.y();
    return p;
}

std::vector<Vec2d> armhole(const Cut& cut, const int face) {
    const Vec2d top = cut.flat_shoulder(face);
    const Vec2d underarm(cut.width, 0.0);
    const double across = top.x() - (face == 0 ? 0.022 : 0.012); // narrowest, at mid height
    return bezier(underarm, {across + 0.12 * (cut.width - across), 0.004},
                  {across - 0.004, 0.42 * top.y()}, top);
}

HalfPanel torso_panel(const std::shared_ptr<const Cut>& cut, const int face) {
    const Vec2d neck = cut->flat_neck(face);
    const Vec2d shoulder = cut->flat_shoulder(face);
    const Vec2d centre(0.0, neck.y() - cut->neck_depth[face]);
    const double hem = cut->hem_y - cut->underarm_y;
    // A round neck: leaves the shoulder squarely and crosses the centre level.
    const Vec2d seam = (neck - shoulder).normalized();
    const Vec2d down(seam.y(), -seam.x());
    const double depth = cut->neck_depth[face];
    const auto neckline =
        face == 0
            ? bezier(neck, neck + 0.62 * depth * Vec2d(-std::abs(down.x()), -std::abs(down.y())),
                     centre + Vec2d(0.60 * neck.x(), 0.0), centre)
            : bezier(neck, neck + 0.55 * depth * Vec2d(-std::abs(down.x()), -std::abs(down.y())),
                     centre + Vec2d(0.62 * neck.x(), 0.0), centre);
    HalfPanel panel;
    panel.name = face == 0 ? "front" : "back";
    panel.mirrored = face == 1;
    panel.chart_offset = Vec2d(face == 0 ? 0.0 : 0.8, 0.0);
    panel.priority = 2;
    panel.border = {{"hem", {{0.0, hem}, {cut->hem_width, hem}}},
                    {"side", {{cut->hem_width, hem}, {cut->width, 0.0}}},
                    {"armhole", armhole(*cut, face)},
                    {"shoulder", {shoulder, neck}},
                    {"neck", neckline},
                    {"centre", {centre, {0.0, hem}}}};
    panel.place = [cut, face](const Vec2d& p) { return place_torso(*cut, face, p); };
    return panel;
}

std::vector<Vec2d> sleeve_cap(const double half_width, const double height) {
    return bezier({half_width, -height}, {0.62 * half_width, -0.95 * height},
                  {0.45 * half_width, 0.0}, {0.0, 0.0});
}

// The value in [low, high] at which a rising function reaches `wanted`.
template <class F>
double solve(double low, double high, const double wanted, const F& f) {
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

void add_sleeve(Pattern& pattern, const std::shared_ptr<const Cut>& cut) {
    const BodyProbe& body = cut->body;
    const Vec3d start = body.joint(Joint::left_upper_arm);
    const Vec3d end = body.joint(Joint::left_lower_arm);
    const Vec3d axis = (end - start).normalized();
    const double arm = (end - start).norm();
    Vec3d middle;
    const double girth = body.arm_girth(0.45, middle);
    const Vec3d on_axis = middle - axis * axis.dot(middle - start); // at the shoulder joint's level
    const double first = axis.dot(cut->shoulder_point - start);
    const double sleeve = arm * cut->options.sleeve_share - first;
    const double height =
        cut->options.cap_share * 0.5 * (cut->flat_shoulder(0).y() + cut->flat_shoulder(1).y());
    std::array<double, 2> widths{}; // of the sleeve's halves: the caps fit the armholes
    for (const int face : {0, 1}) {
        widths[face] = solve(0.05, 0.5, length(armhole(*cut, face)),
                             [&](const double w) { return length(sleeve_cap(w, height)); });
    }
    const Vec3d up = (Vec3d::UnitY() - axis * axis.y()).normalized();
    const double least = girth / (2.0 * std::numbers::pi) + 0.014;
    for (const int face : {0, 1}) {
        const double width = widths[face];
        const double cuff = 0.90 * width;
        HalfPanel panel;
        panel.name = face == 0 ? "sleeve_front" : "sleeve_back";
        panel.mirrored = face == 0;
        panel.chart_offset = Vec2d(1.6, 0.0);
        panel.right_chart_shift = 0.5;
        panel.border = {{"cuff", {{0.0, -sleeve}, {cuff, -sleeve}}},
                        {"underarm", {{cuff, -sleeve}, {width, -height}}},
                        {"cap", sleeve_cap(width, height)},
                        {"fold", {{0.0, 0.0}, {0.0, -sleeve}}}};
        const Vec3d out = face == 0 ? Vec3d::UnitZ() : Vec3d(-Vec3d::UnitZ());
        const Vec3d across = (out - axis * axis.dot(out) - up * up.dot(out)).normalized();
        const double mean_width = 0.5 * (widths[0] + widths[1]);
        panel.place = [=](const Vec2d& p) {
            const double here =
                -p.y() < height ? width
                                : width + (cuff - width) * (-p.y() - height) / (sleeve - height);
            const double angle = std::min(1.0, p.x() / here) * std::numbers::pi;
            const double radius = std::max(least, mean_width / std::numbers::pi * here / width);
            return Vec3d(on_axis + axis * (first - p.y()) +
                         radius * (std::cos(angle) * up + std::sin(angle) * across));
        };
        pattern.panels.push_back(panel);
    }
}

void add_collar(Pattern& pattern, const std::shared_ptr<const Cut>& cut) {
    for (const int face : {0, 1}) {
        const std::vector<Vec2d> seam =
            pattern.curve(face == 0 ? "front" : "back", "neck").points; // shoulder to centre
        // A ring sector, cut a little short as rib is, so that the band lies flat on the body.
        const double outer = face == 0 ? 0.100 : 0.200;
        const double h = cut->options.collar_m;
        const double angle = 0.97 * length(seam) / outer;
        const std::vector<Vec2d> low = arc(outer, outer, angle);
        const std::vector<Vec2d> high = arc(outer, outer - h, angle);
        HalfPanel strip;
        strip.name = face == 0 ? "collar_front" : "collar_back";
        strip.mirrored = face == 1;
        strip.chart_offset = Vec2d(face == 0 ? 0.0 : 0.8, 0.5);
        strip.border = {{"neck", low},
                        {"shoulder", {low.back(), high.back()}},
                        {"edge", reversed(high)},
                        {"centre", {high.front(), low.front()}}};
        strip.place = [=](const Vec2d& p) {
            const Vec2d d = p - Vec2d(0.0, outer);
            const double share = 1.0 - std::atan2(d.x(), -d.y()) / angle;
            const double up = outer - d.norm();
            const auto points = resample(seam, 64);
            const double at = std::clamp(share, 0.0, 1.0) * 64.0;
            const auto i = std::min<std::size_t>(63, static_cast<std::size_t>(at));
            const double t = at - static_cast<double>(i);
            Vec3d q = place_torso(*cut, face, (1.0 - t) * points[i] + t * points[i + 1]);
            const Vec3d neck = cut->body.joint(Joint::neck);
            const Vec3d inward = Vec3d(neck.x() - q.x(), 0.0, neck.z() - q.z()).normalized();
            q += up * (0.6 * Vec3d::UnitY() + 0.7 * inward);
            return q;
        };
        strip.unroll = [=](const Vec2d& chart) {
            const Vec2d d = chart - Vec2d(0.0, outer);
            return Vec2d(std::atan2(d.x(), -d.y()) * outer, outer - d.norm());
        };
        pattern.panels.push_back(strip);
    }
}

} // namespace

Pattern draft_t_shirt(const BodyProbe& body, const TShirtOptions& options) {
    const auto cut = std::make_shared<const Cut>(measure(body, options));
    Pattern pattern;
    pattern.panels = {torso_panel(cut, 0), torso_panel(cut, 1)};
    add_sleeve(pattern, cut);
    add_collar(pattern, cut);
    pattern.seams = {{"front", "side", "back", "side", false},
                     {"front", "shoulder", "back", "shoulder", false},
                     {"front", "armhole", "sleeve_front", "cap", false},
                     {"back", "armhole", "sleeve_back", "cap", false},
                     {"sleeve_front", "fold", "sleeve_back", "fold", false},
                     {"sleeve_front", "underarm", "sleeve_back", "underarm", false},
                     {"front", "neck", "collar_front", "neck", true},
                     {"back", "neck", "collar_back", "neck", true},
                     {"collar_front", "shoulder", "collar_back", "shoulder", false}};
    pattern.centres = {{"front", "centre"},
                       {"back", "centre"},
                       {"collar_front", "centre"},
                       {"collar_back", "centre"}};
    return pattern;
}

} // namespace toile::garment::block
