#include "garment/placed_pattern.h"

#include "core/error.h"
#include "garment/body_wrap.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace toile::garment::block {
namespace {

enum class Region : std::uint8_t { trunk, leg, arm, other };

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

Region region_of(const SpatialPanel& panel) {
    if (contains(panel.name, "sleeve") || panel.label == "arm") {
        return Region::arm;
    }
    if (contains(panel.name, "pant")) {
        return Region::leg;
    }
    // Seen from the front or from behind?
    return std::abs((panel.place.linear() * Vec3d::UnitZ()).z()) > 0.7 ? Region::trunk
                                                                       : Region::other;
}

// Least and largest value over rows of a panel; a row takes in its neighbours, so that a slanting
// waist or hem does not count as a side.
class Extents {
  public:
    Extents() = default;
    Extents(const std::vector<Vec2d>& outline, const double window) : window_(window) {
        low_ = 1e9;
        double high = -1e9;
        for (const Vec2d& p : outline) {
            low_ = std::min(low_, p.y());
            high = std::max(high, p.y());
        }
        rows_.assign(static_cast<std::size_t>((high - low_) / kStep) + 2, {1e9, -1e9});
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Vec2d& a = outline[i];
            const Vec2d& b = outline[(i + 1) % outline.size()];
            const int n = static_cast<int>((b - a).norm() / (0.5 * kStep)) + 1;
            for (int k = 0; k <= n; ++k) {
                const Vec2d p = a + (b - a) * (static_cast<double>(k) / n);
                auto& row = rows_[static_cast<std::size_t>((p.y() - low_) / kStep)];
                row[0] = std::min(row[0], p.x());
                row[1] = std::max(row[1], p.x());
            }
        }
    }

    [[nodiscard]] std::array<double, 2> at(const double y) const {
        const auto reach = static_cast<int>(window_ / kStep);
        const int row =
            std::clamp(static_cast<int>((y - low_) / kStep), 0, static_cast<int>(rows_.size()) - 1);
        std::array<double, 2> out{1e9, -1e9};
        for (int r = std::max(0, row - reach);
             r <= std::min(static_cast<int>(rows_.size()) - 1, row + reach); ++r) {
            out[0] = std::min(out[0], rows_[static_cast<std::size_t>(r)][0]);
            out[1] = std::max(out[1], rows_[static_cast<std::size_t>(r)][1]);
        }
        return out;
    }

  private:
    static constexpr double kStep = 0.005;
    double low_ = 0.0, window_ = 0.0;
    std::vector<std::array<double, 2>> rows_;
};

// One panel as it hangs: world x and y of its flat points (arms: along and across the arm).
struct Hung {
    Region region = Region::other;
    bool front = false;
    double side = 1.0; // legs and arms: +1 left, -1 right
    Extents extents;
    std::vector<Vec2d> outline; // in that plane
};

// What the body and the pattern share.
struct Scene {
    const BodyProbe& body;
    std::map<std::string, double> levels;
    double shift = 0.0; // added to the pattern's heights
    bool shoulders = false;
    double underarm = 0.0;                   // the pattern's, world after the shift
    double neck_x = 0.0, tip_x = 0.0;        // ends of the shoulder seam
    std::array<double, 2> neck_y{}, tip_y{}; // front, back
    std::vector<Hung> hung;
    std::shared_ptr<const Loft> trunk;
    std::shared_ptr<const LegLoft> leg;
    std::shared_ptr<const ArmTube> arm;
};

std::vector<Vec2d> outline_of(const SpatialPanel& panel) {
    std::vector<Vec2d> outline;
    for (const Curve& curve : panel.border) {
        outline.insert(outline.end(), curve.points.begin(), curve.points.end() - 1);
    }
    return outline;
}

Vec3d world(const SpatialPanel& panel, const Vec2d& flat) {
    return panel.place * Vec3d(flat.x(), flat.y(), 0.0);
}

// Along (from the body outwards) and across (upwards) of a sleeve panel.
Vec2d along_arm(const SpatialPanel& panel, const Vec2d& flat, const double side) {
    const Vec3d p = world(panel, flat);
    const Vec3d x = panel.place.linear() * Vec3d::UnitX();
    const Vec3d y = panel.place.linear() * Vec3d::UnitY();
    // The panel's axis that points outwards and down is the arm's.
    const Vec3d hanging(side, -0.8, 0.0);
    Vec3d arm = x;
    for (const Vec3d& axis : {Vec3d(-x), y, Vec3d(-y)}) {
        arm = axis.dot(hanging) > arm.dot(hanging) ? axis : arm;
    }
    const Vec3d up = Vec3d::UnitZ().cross(arm) * side;
    return {arm.dot(p), up.dot(p)};
}

Hung hang(const SpatialPanel& panel) {
    Hung hung;
    hung.region = region_of(panel);
    Vec3d middle = Vec3d::Zero();
    const std::vector<Vec2d> outline = outline_of(panel);
    for (const Vec2d& p : outline) {
        middle += world(panel, p) / static_cast<double>(outline.size());
    }
    hung.front = middle.z() > 0.0;
    hung.side = middle.x() < 0.0 ? -1.0 : 1.0;
    for (const Vec2d& p : outline) {
        hung.outline.push_back(hung.region == Region::arm ? along_arm(panel, p, hung.side)
                                                          : Vec2d(world(panel, p).head<2>()));
    }
    if (hung.region == Region::arm) {
        for (Vec2d& p : hung.outline) {
            std::swap(p.x(), p.y()); // rows along the arm
        }
    }
    hung.extents = Extents(hung.outline, hung.region == Region::arm ? 0.015 : 0.03);
    return hung;
}

// Shoulder seams and the top of the side seams, from stitches between front and back of the trunk.
void find_shoulders(const SpatialPattern& pattern, Scene& scene) {
    double top = -1e9;
    double side_top = -1e9;
    for (const Stitch& stitch : pattern.stitches) {
        const Hung& a = scene.hung[stitch.panel_a];
        const Hung& b = scene.hung[stitch.panel_b];
        if (a.region != Region::trunk || b.region != Region::trunk || a.front == b.front) {
            continue;
        }
        std::array<std::array<Vec3d, 2>, 2> ends; // front, back; inner, outer
        for (const auto& [panel, edge] :
             {std::pair{stitch.panel_a, stitch.edge_a}, std::pair{stitch.panel_b, stitch.edge_b}}) {
            const auto& points = pattern.panels[panel].border[edge].points;
            std::array<Vec3d, 2> pair = {world(pattern.panels[panel], points.front()),
                                         world(pattern.panels[panel], points.back())};
            if (std::abs(pair[0].x()) > std::abs(pair[1].x())) {
                std::swap(pair[0], pair[1]);
            }
            ends[scene.hung[panel].front ? 0 : 1] = pair;
        }
        const Vec3d d = ends[0][1] - ends[0][0];
        const double height = 0.5 * (ends[0][0].y() + ends[0][1].y());
        if (std::abs(d.x()) > std::abs(d.y()) && height > top && std::abs(d.x()) > 0.01) {
            top = height;
            scene.shoulders = true;
            scene.neck_x = std::abs(ends[1][0].x());
            scene.tip_x = std::abs(ends[1][1].x());
            for (std::size_t f = 0; f < 2; ++f) {
                scene.neck_y[f] = ends[f][0].y();
                scene.tip_y[f] = ends[f][1].y();
            }
        } else if (std::abs(d.y()) >= std::abs(d.x())) {
            side_top = std::max({side_top, ends[0][0].y(), ends[0][1].y()});
        }
    }
    scene.shoulders = scene.shoulders && side_top > -1e8 && top > side_top;
    if (scene.shoulders) {
        scene.shift = scene.levels.at("underarm") - side_top;
        scene.underarm = scene.levels.at("underarm");
    }
}

// Half of the cloth's girth at a height, by the breadths of what hangs there.
double half_girth(const Scene& scene, const double y) {
    std::array<double, 2> half{};
    for (const Hung& hung : scene.hung) {
        if (hung.region == Region::trunk || hung.region == Region::leg) {
            const auto [low, high] = hung.extents.at(y - scene.shift);
            const double wide =
                hung.region == Region::leg ? high - low : std::max(std::abs(low), std::abs(high));
            auto& most = half[hung.front ? 0 : 1];
            most = low > high ? most : std::max(most, wide);
        }
    }
    return half[0] + half[1];
}

Vec3d on_trunk(const Scene& scene, const Hung& hung, const Vec2d& p) {
    const auto [low, high] = hung.extents.at(p.y() - scene.shift);
    double share = 0.0;
    double side = 1.0;
    if (hung.region == Region::leg) {
        const double inner = hung.side > 0.0 ? low : high;
        const double outer = hung.side > 0.0 ? high : low;
        share = (p.x() - inner) / (outer - inner);
        side = hung.side;
    } else {
        side = p.x() < 0.0 ? -1.0 : 1.0;
        share = std::abs(p.x()) / std::max({std::abs(low), std::abs(high), 0.02});
    }
    share = std::clamp(share, 0.0, 1.0);
    Vec3d q = scene.trunk->at(hung.front ? 0.5 * share : 1.0 - 0.5 * share, p.y());
    q.x() *= side;
    return q;
}

Vec3d over_shoulder(const Scene& scene, const Hung& hung, const Vec2d& p) {
    const Vec3d below = on_trunk(scene, hung, {p.x(), std::min(p.y(), scene.underarm)});
    if (p.y() <= scene.underarm) {
        return below;
    }
    const std::size_t face = hung.front ? 0 : 1;
    const double side = p.x() < 0.0 ? -1.0 : 1.0;
    const double x = std::clamp(std::abs(p.x()), scene.neck_x, scene.tip_x);
    const double t = (x - scene.neck_x) / (scene.tip_x - scene.neck_x);
    const Vec3d ridge = scene.body.ridge(x);
    const double seam =
        scene.shift + scene.neck_y[face] + t * (scene.tip_y[face] - scene.neck_y[face]);
    const double height =
        (p.y() - scene.underarm) / (seam - scene.underarm) * (ridge.y() + 0.012 - scene.underarm);
    Vec3d above(p.x(), scene.underarm + height, ridge.z());
    double z = 0.0;
    if (scene.body.depth(std::abs(above.x()), above.y(), hung.front, z)) {
        above.z() = z + (hung.front ? 0.012 : -0.012);
    }
    const double s = std::clamp((p.y() - scene.underarm) / 0.09, 0.0, 1.0);
    const double blend = s * s * (3.0 - 2.0 * s);
    Vec3d q = (1.0 - blend) * below + blend * above;
    q.x() = side * std::abs(q.x());
    q.y() = above.y();
    return q;
}

Vec3d on_leg(const Scene& scene, const Hung& hung, const Vec2d& p) {
    const double crotch = scene.levels.at("crotch");
    Vec3d trunk = on_trunk(scene, hung, {p.x(), p.y()});
    trunk.y() = p.y();
    if (p.y() >= crotch || !scene.leg) {
        return trunk;
    }
    const auto [low, high] = hung.extents.at(p.y() - scene.shift);
    const double inner = hung.side > 0.0 ? low : high;
    const double share = std::clamp(std::abs(p.x() - inner) / std::max(high - low, 0.02), 0.0, 1.0);
    Vec3d leg = scene.leg->at(hung.front ? 0.5 * share : 1.0 - 0.5 * share, p.y());
    leg.x() *= hung.side;
    const double s = std::clamp((crotch - p.y()) / 0.05, 0.0, 1.0);
    return (1.0 - s) * trunk + s * leg;
}

Vec3d on_arm(const Scene& scene, const SpatialPanel& panel, const Hung& hung, const Vec2d& flat) {
    const Vec2d q = along_arm(panel, flat, hung.side); // along, across
    const auto [low, high] = hung.extents.at(q.x());
    double start = 1e9;
    for (const Vec2d& p : hung.outline) {
        start = std::min(start, p.y());
    }
    const double share = std::clamp((high - q.y()) / std::max(high - low, 0.02), 0.0, 1.0);
    const double angle = share * std::numbers::pi * (hung.front ? 1.0 : -1.0);
    Vec3d p = scene.arm->at(q.x() - start, angle, 2.0 * (high - low));
    p.x() *= hung.side;
    return p;
}

// Sewn edges run towards each other where they are drawn nearest.
bool runs_reversed(const SpatialPattern& pattern, const Stitch& stitch) {
    const auto ends = [&](const std::size_t panel, const std::size_t edge) {
        const auto& points = pattern.panels[panel].border[edge].points;
        return std::array{world(pattern.panels[panel], points.front()),
                          world(pattern.panels[panel], points.back())};
    };
    const auto a = ends(stitch.panel_a, stitch.edge_a);
    const auto b = ends(stitch.panel_b, stitch.edge_b);
    return (a[0] - b[1]).squaredNorm() + (a[1] - b[0]).squaredNorm() <
           (a[0] - b[0]).squaredNorm() + (a[1] - b[1]).squaredNorm();
}

void build_tubes(Scene& scene, const double clearance) {
    double low = 1e9;
    double high = -1e9;
    bool legs = false;
    bool arms = false;
    for (const Hung& hung : scene.hung) {
        arms = arms || hung.region == Region::arm;
        legs = legs || hung.region == Region::leg;
        for (const Vec2d& p : hung.outline) {
            if (hung.region == Region::trunk || hung.region == Region::leg) {
                low = std::min(low, p.y() + scene.shift);
                high = std::max(high, p.y() + scene.shift);
            }
        }
    }
    const double least = clearance + 0.004;
    if (low < high) {
        const double top = std::min(high, scene.levels.at("underarm"));
        const double bottom = std::clamp(low - 0.02, 0.03, top - 0.02);
        const double crotch = scene.levels.at("crotch");
        scene.trunk = std::make_shared<const Loft>(
            scene.body, legs ? std::max(bottom, crotch + 0.005) : bottom, top,
            [&](const double y) { return 2.0 * half_girth(scene, y); }, least);
        if (legs && bottom < crotch - 0.02) {
            scene.leg = std::make_shared<const LegLoft>(
                scene.body, bottom, crotch - 0.012,
                [&](const double y) { return half_girth(scene, y); }, least);
        }
    }
    if (arms) {
        scene.arm = std::make_shared<const ArmTube>(scene.body, least);
    }
}

// The side of the flat panel that faces outwards, from its place.
bool faces_inwards(const HalfPanel& panel, const Vec3d& axis) {
    Vec2d middle = Vec2d::Zero();
    std::vector<Vec2d> outline;
    for (const Curve& curve : panel.border) {
        for (const Vec2d& p : resample(curve.points, 8)) {
            outline.push_back(p);
            middle += p;
        }
    }
    middle /= static_cast<double>(outline.size());
    double sum = 0.0;
    for (const Vec2d& corner : outline) {
        const Vec2d flat = 0.4 * corner + 0.6 * middle;
        const Vec3d p = panel.place(flat);
        const Vec3d normal = (panel.place(flat + Vec2d(0.004, 0.0)) - p)
                                 .cross(panel.place(flat + Vec2d(0.0, 0.004)) - p);
        sum += normal.dot(Vec3d(p.x() - axis.x(), 0.0, p.z() - axis.z()).normalized());
    }
    return sum < 0.0;
}

} // namespace

Pattern pattern_of(const SpatialPattern& source, const BodyProbe& body, const double clearance_m) {
    const auto spatial = std::make_shared<const SpatialPattern>(source);
    const auto scene = std::make_shared<Scene>(Scene{
        body, body_levels(body), 0.0, false, 0.0, 0.0, 0.0, {}, {}, {}, nullptr, nullptr, nullptr});
    double highest = -1e9;
    for (const SpatialPanel& panel : spatial->panels) {
        scene->hung.push_back(hang(panel));
        for (const Vec2d& p : scene->hung.back().outline) {
            const bool upright = scene->hung.back().region != Region::arm;
            highest = upright ? std::max(highest, p.y()) : highest;
        }
    }
    find_shoulders(*spatial, *scene);
    if (!scene->shoulders) {
        scene->shift = scene->levels.at("waist") - highest;
    }
    build_tubes(*scene, clearance_m);

    Pattern pattern;
    pattern.symmetric = false;
    double chart = 0.0;
    for (std::size_t i = 0; i < spatial->panels.size(); ++i) {
        const SpatialPanel& panel = spatial->panels[i];
        HalfPanel out;
        out.name = panel.name;
        out.border = panel.border;
        std::vector<Vec2d> outline = outline_of(panel);
        double area = 0.0;
        double low = 1e9;
        double high = -1e9;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const Vec2d& a = outline[k];
            const Vec2d& b = outline[(k + 1) % outline.size()];
            area += a.x() * b.y() - a.y() * b.x();
            low = std::min(low, a.x());
            high = std::max(high, a.x());
        }
        if (area < 0.0) {
            std::reverse(out.border.begin(), out.border.end());
            for (Curve& curve : out.border) {
                std::reverse(curve.points.begin(), curve.points.end());
            }
        }
        out.place = [scene, spatial, i](const Vec2d& flat) {
            const Hung& hung = scene->hung[i];
            const SpatialPanel& from = spatial->panels[i];
            Vec3d p = world(from, flat);
            p.y() += scene->shift;
            switch (hung.region) {
            case Region::arm:
                return on_arm(*scene, from, hung, flat);
            case Region::leg:
                return on_leg(*scene, hung, p.head<2>());
            case Region::trunk:
                return scene->shoulders ? over_shoulder(*scene, hung, p.head<2>())
                                        : on_trunk(*scene, hung, p.head<2>());
            case Region::other:
                break;
            }
            return p;
        };
        out.priority = scene->hung[i].region == Region::trunk ? 2 : 1;
        Vec3d axis = body.joint(body::Joint::hips);
        if (scene->hung[i].region == Region::arm) {
            // Around the arm "outwards" is up and down too: decide by front and back.
            axis = Vec3d(0.0, 0.0, body.joint(body::Joint::left_upper_arm).z());
            axis.x() = scene->hung[i].side * body.joint(body::Joint::left_lower_arm).x();
        }
        out.mirrored = faces_inwards(out, axis);
        chart += 0.02;
        out.chart_offset = Vec2d(chart - (out.mirrored ? -high : low), 0.0);
        chart += high - low;
        pattern.panels.push_back(std::move(out));
    }
    const auto backwards = [&](const std::size_t panel, const std::size_t edge) {
        const auto& stored = pattern.curve(pattern.panels[panel].name, std::to_string(edge)).points;
        return (stored.front() - spatial->panels[panel].border[edge].points.front()).norm() > 1e-9;
    };
    std::vector<std::vector<bool>> sewn;
    for (const SpatialPanel& panel : spatial->panels) {
        sewn.emplace_back(panel.border.size(), false);
    }
    for (const Stitch& s : spatial->stitches) {
        const bool reversed = (runs_reversed(*spatial, s) != backwards(s.panel_a, s.edge_a)) !=
                              backwards(s.panel_b, s.edge_b);
        pattern.seams.push_back({spatial->panels[s.panel_a].name, std::to_string(s.edge_a),
                                 spatial->panels[s.panel_b].name, std::to_string(s.edge_b),
                                 reversed});
        sewn[s.panel_a][s.edge_a] = sewn[s.panel_b][s.edge_b] = true;
    }
    if (!scene->shoulders) {
        for (std::size_t i = 0; i < spatial->panels.size(); ++i) {
            for (std::size_t e = 0; e < sewn[i].size(); ++e) {
                const auto& points = spatial->panels[i].border[e].points;
                const double y = 0.5 * (world(spatial->panels[i], points.front()).y() +
                                        world(spatial->panels[i], points.back()).y());
                if (!sewn[i][e] && y > highest - 0.06) {
                    pattern.held.emplace_back(spatial->panels[i].name, std::to_string(e));
                }
            }
        }
        if (pattern.held.empty()) {
            throw Error("the pattern has neither shoulder seams nor free edges at its top: nothing "
                        "would hold it");
        }
    }
    return pattern;
}

} // namespace toile::garment::block
