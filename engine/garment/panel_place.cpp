#include "garment/panel_place.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::garment::block {
namespace {

double smooth_step(const double low, const double high, const double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

bool on_torso_or_leg(const WrapOn on) {
    return on != WrapOn::arm;
}

bool is_leg(const WrapOn on) {
    return on == WrapOn::leg_front || on == WrapOn::leg_back;
}

bool in_front(const WrapOn on) {
    return on == WrapOn::torso_front || on == WrapOn::leg_front;
}

// Of a ring sector: apex, radius of its inner edge, and the directions of its ends.
struct Sector {
    Vec2d apex;
    double inner = 0.0;
    double start = 0.0, angle = 0.0; ///< radians, from the centre front on
};

Sector sector_of(const PlacedPanel& panel) {
    Sector sector;
    sector.apex = panel.point(panel.recipe->wrap.polar);
    sector.inner = 1e9;
    Vec2d middle = Vec2d::Zero();
    for (const Vec2d& p : panel.piece->outline) {
        sector.inner = std::min(sector.inner, (p - sector.apex).norm());
        middle += p / static_cast<double>(panel.piece->outline.size());
    }
    const Vec2d axis = (middle - sector.apex).normalized();
    double low = 0.0;
    double high = 0.0;
    for (const Vec2d& p : panel.piece->outline) {
        const Vec2d d = p - sector.apex;
        const double a = std::atan2(axis.x() * d.y() - axis.y() * d.x(), axis.dot(d));
        low = std::min(low, a);
        high = std::max(high, a);
    }
    sector.start = std::atan2(axis.y(), axis.x()) + low;
    sector.angle = high - low;
    return sector;
}

// x of some edges at a height: where they cross it, or the point nearest in height.
double side_at(const std::span<const Curve* const> edges, const double y) {
    double nearest = 1e9;
    double x = 0.0;
    for (const Curve* edge : edges) {
        for (std::size_t i = 0; i < edge->points.size(); ++i) {
            const Vec2d& p = edge->points[i];
            if (std::abs(p.y() - y) < nearest) {
                nearest = std::abs(p.y() - y);
                x = p.x();
            }
            if (i > 0 && (edge->points[i - 1].y() > y) != (p.y() > y)) {
                const Vec2d& q = edge->points[i - 1];
                return q.x() + (p.x() - q.x()) * (y - q.y()) / (p.y() - q.y());
            }
        }
    }
    return x;
}

} // namespace

PanelWidths::PanelWidths(const std::span<const Vec2d> outline,
                         const std::span<const Curve* const> inner,
                         const std::span<const Curve* const> outer) {
    low_ = outline.front().y();
    double high = low_;
    for (const Vec2d& p : outline) {
        low_ = std::min(low_, p.y());
        high = std::max(high, p.y());
    }
    const auto rows = static_cast<std::size_t>((high - low_) / kStep) + 2;
    for (std::size_t r = 0; r < rows; ++r) {
        const double y = low_ + static_cast<double>(r) * kStep;
        rows_.push_back({side_at(inner, y), side_at(outer, y)});
    }
}

double PanelWidths::high() const {
    return low_ + kStep * static_cast<double>(rows_.size() - 1);
}

std::array<double, 2> PanelWidths::ends(const double y) const {
    const double g = std::clamp((y - low_) / kStep, 0.0, static_cast<double>(rows_.size() - 1));
    const auto r = std::min(static_cast<std::size_t>(g), rows_.size() - 2);
    const double t = g - static_cast<double>(r);
    return {(1.0 - t) * rows_[r][0] + t * rows_[r + 1][0],
            (1.0 - t) * rows_[r][1] + t * rows_[r + 1][1]};
}

double PanelWidths::share(const Vec2d& flat) const {
    const auto [inner, outer] = ends(flat.y());
    return std::abs(outer - inner) < 1e-6
               ? 0.5
               : std::clamp((flat.x() - inner) / (outer - inner), 0.0, 1.0);
}

double PanelWidths::width(const double y) const {
    const auto [inner, outer] = ends(y);
    return std::abs(outer - inner);
}

Vec2d PlacedPanel::point(const std::string& name) const {
    const auto at = piece->points.find(name);
    if (at == piece->points.end()) {
        throw Error("panel '" + recipe->name + "': piece '" + piece->name + "' has no point '" +
                    name + "'");
    }
    return at->second;
}

double PlacedPanel::world_height(const double flat_y) const {
    if (flat_y <= heights.front().first || heights.size() == 1) {
        return heights.front().second + flat_y - heights.front().first;
    }
    for (std::size_t i = 1; i < heights.size(); ++i) {
        if (flat_y <= heights[i].first) {
            const double t =
                (flat_y - heights[i - 1].first) / (heights[i].first - heights[i - 1].first);
            return heights[i - 1].second + t * (heights[i].second - heights[i - 1].second);
        }
    }
    return heights.back().second + flat_y - heights.back().first;
}

GarmentWrap::GarmentWrap(const BodyProbe& body, const std::span<const PlacedPanel> panels,
                         const double clearance_m)
    : body_(body), levels_(body_levels(body)) {
    const double least = clearance_m + 0.004;
    double low = 1e9;
    double high = -1e9;
    bool legs = false;
    bool arms = false;
    for (const PlacedPanel& panel : panels) {
        arms = arms || panel.recipe->wrap.on == WrapOn::arm;
        legs = legs || is_leg(panel.recipe->wrap.on);
        if (on_torso_or_leg(panel.recipe->wrap.on) && panel.recipe->wrap.polar.empty()) {
            low = std::min(low, panel.world_height(panel.widths->low()));
            high = std::max(high, panel.world_height(panel.widths->high()));
        } else if (!panel.recipe->wrap.polar.empty()) {
            high = std::max(high, panel.heights.front().second);
            low = std::min(low, panel.heights.front().second - 0.02);
        }
    }
    const auto girth = [&panels](const double y) {
        double sum = 0.0;
        for (const PlacedPanel& panel : panels) {
            if (on_torso_or_leg(panel.recipe->wrap.on) && panel.recipe->wrap.polar.empty()) {
                // The inverse of world_height, by halving.
                double a = panel.widths->low();
                double b = panel.widths->high();
                for (int i = 0; i < 30; ++i) {
                    const double m = 0.5 * (a + b);
                    (panel.world_height(m) < y ? a : b) = m;
                }
                sum += panel.widths->width(0.5 * (a + b));
            }
        }
        return sum;
    };
    if (low < high) {
        const double top = std::min(high + 0.06, levels_.at("underarm"));
        const double bottom = std::clamp(low - 0.02, 0.03, top - 0.02);
        const double crotch = legs ? levels_.at("crotch") + 0.005 : bottom;
        torso_ = std::make_shared<const Loft>(
            body, std::max(bottom, crotch), top, [&](const double y) { return 2.0 * girth(y); },
            least);
        if (legs && bottom < levels_.at("crotch") - 0.02) {
            leg_ = std::make_shared<const LegLoft>(body, bottom, levels_.at("crotch") - 0.012,
                                                   girth, least);
        }
    }
    if (arms) {
        arm_ = std::make_shared<const ArmTube>(body, least);
    }
}

std::function<Vec3d(const Vec2d&)> GarmentWrap::place_of(const PlacedPanel& panel,
                                                         const PlacedPanel& seam_of) const {
    const PanelWrap& wrap = panel.recipe->wrap;
    if (wrap.on == WrapOn::arm) {
        return [=, this](const Vec2d& p) { return on_arm(panel, p); };
    }
    if (!wrap.polar.empty()) {
        return [=, this](const Vec2d& p) { return on_sector(panel, p); };
    }
    if (is_leg(wrap.on) && leg_) {
        return [=, this](const Vec2d& p) { return on_leg(panel, p); };
    }
    if (!wrap.neck.empty()) {
        return [=, this](const Vec2d& p) { return over_shoulder(panel, seam_of, p); };
    }
    return [=, this](const Vec2d& p) { return on_torso(panel, p); };
}

Vec3d GarmentWrap::on_torso(const PlacedPanel& panel, const Vec2d& flat) const {
    const double share = panel.widths->share(flat);
    const WrapOn on = panel.recipe->wrap.on;
    const double fraction = on == WrapOn::torso_half ? share
                            : in_front(on)           ? 0.5 * share
                                                     : 1.0 - 0.5 * share;
    return torso_->at(fraction, panel.world_height(flat.y()));
}

// The shoulder seam lands on the shoulder's ridge; what is below it keeps its share.
Vec3d GarmentWrap::over_shoulder(const PlacedPanel& panel, const PlacedPanel& seam_of,
                                 const Vec2d& flat) const {
    const bool front = in_front(panel.recipe->wrap.on);
    const double underarm = panel.heights.front().second;
    const double underarm_flat = panel.heights.front().first;
    const Vec3d below = on_torso(panel, Vec2d(flat.x(), std::min(flat.y(), underarm_flat)));
    if (flat.y() <= underarm_flat) {
        return below;
    }
    const Vec2d neck = panel.point(panel.recipe->wrap.neck);
    const Vec2d shoulder = panel.point(panel.recipe->wrap.shoulder);
    const double world_neck = seam_of.point(seam_of.recipe->wrap.neck).x();
    const double world_shoulder = seam_of.point(seam_of.recipe->wrap.shoulder).x();
    const double x = std::clamp(flat.x(), neck.x(), shoulder.x());
    const double t = (x - neck.x()) / (shoulder.x() - neck.x());
    const double seam_x = world_neck + t * (world_shoulder - world_neck);
    const Vec3d ridge = body_.ridge(seam_x);
    const double seam = neck.y() + t * (shoulder.y() - neck.y());
    const double height =
        (flat.y() - underarm_flat) / (seam - underarm_flat) * (ridge.y() + 0.012 - underarm);
    const double world_x = flat.x() < neck.x() ? flat.x() * world_neck / std::max(neck.x(), 1e-3)
                                               : flat.x() + seam_x - x;
    Vec3d above(world_x, underarm + height, ridge.z());
    double z = 0.0;
    if (body_.depth(above.x(), above.y(), front, z)) {
        above.z() = z + (front ? 0.012 : -0.012);
    }
    const double blend = smooth_step(0.0, 0.09, flat.y() - underarm_flat);
    Vec3d p = (1.0 - blend) * below + blend * above;
    p.y() = above.y();
    return p;
}

Vec3d GarmentWrap::on_leg(const PlacedPanel& panel, const Vec2d& flat) const {
    const double y = panel.world_height(flat.y());
    const double share = panel.widths->share(flat);
    const bool front = in_front(panel.recipe->wrap.on);
    const double crotch = levels_.at("crotch");
    Vec3d trunk = torso_->at(front ? 0.5 * share : 1.0 - 0.5 * share, std::max(y, crotch + 0.01));
    trunk.y() = y;
    if (y >= crotch) {
        return trunk;
    }
    const Vec3d leg = leg_->at(front ? 0.5 * share : 1.0 - 0.5 * share, y);
    const double blend = smooth_step(0.0, 0.05, crotch - y);
    return (1.0 - blend) * trunk + blend * leg;
}

Vec3d GarmentWrap::on_arm(const PlacedPanel& panel, const Vec2d& flat) const {
    // Above its edges the panel is the cap: it keeps their width's angle.
    const double share = panel.widths->share(flat); // 0..1 from one underarm edge to the other
    const Vec2d front = panel.point(panel.recipe->wrap.front);
    const bool front_is_outer = panel.widths->share({front.x(), flat.y()}) > 0.5;
    const double angle = (2.0 * share - 1.0) * std::numbers::pi * (front_is_outer ? 1.0 : -1.0);
    return arm_->at(panel.widths->high() - flat.y(), angle, panel.widths->width(flat.y()));
}

Vec3d GarmentWrap::on_sector(const PlacedPanel& panel, const Vec2d& flat) const {
    const Sector sector = sector_of(panel);
    const Vec2d d = flat - sector.apex;
    double a = std::atan2(d.y(), d.x()) - sector.start;
    a -= 2.0 * std::numbers::pi * std::floor((a + 0.5) / (2.0 * std::numbers::pi));
    const double share = std::clamp(a / sector.angle, 0.0, 1.0);
    const double down = d.norm() - sector.inner;
    const double top = panel.heights.front().second;
    const Vec3d edge = torso_->at(share, top);
    // A cone that opens as the cloth does, at most as wide as cloth that falls at 45 degrees.
    const Vec3d hips = torso_->at(share, std::max(levels_.at("hip"), 0.03));
    const Vec3d middle(0.0, 0.0, body_.joint(body::Joint::hips).z());
    const Vec3d out = (Vec3d(hips.x(), 0.0, hips.z()) - middle).normalized();
    const double steep = std::min(0.7, sector.angle / std::numbers::pi);
    const double fall = std::sqrt(1.0 - steep * steep);
    return edge + Vec3d(0.0, -down * fall, 0.0) + down * steep * out;
}

} // namespace toile::garment::block
