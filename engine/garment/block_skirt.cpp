#include "garment/block_drafts.h"
#include "garment/block_loft.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace toile::garment::block {
namespace {

using body::Joint;

// The narrowest height between hips and chest.
double waist_height(const BodyProbe& body) {
    const double low = body.joint(Joint::hips).y() + 0.05;
    const double high = body.joint(Joint::chest).y();
    double best = low;
    double girth = 1e9;
    for (double y = low; y <= high; y += 0.005) {
        const double here = body.ring(y).girth();
        if (here < girth) {
            girth = here;
            best = y;
        }
    }
    return best;
}

struct Cone {
    double waist_y = 0.0;  // height of the seam between band and skirt
    double girth = 0.0;    // there
    double flare = 0.0;    // girth per length = the full sector's angle
    double length = 0.0;   // of the panels
    [[nodiscard]] double girth_at(const double y) const {
        return girth + flare * std::max(0.0, waist_y - y);
    }
};

} // namespace

Pattern draft_skirt(const BodyProbe& body, const SkirtOptions& options) {
    const double waist = waist_height(body);
    Cone cone;
    cone.waist_y = waist - 0.5 * options.band_m;
    const double around = 2.0 * std::numbers::pi * options.band_ease_m;
    cone.girth = body.ring(cone.waist_y).girth() + around;
    const double band_top = cone.waist_y + options.band_m;
    const double top_girth = body.ring(band_top).girth() + around;
    const double hem = body.joint(Joint::left_lower_leg).y() - options.below_knee_m;
    cone.flare = options.least_flare;
    for (double y = cone.waist_y - 0.06; y > hem; y -= 0.01) {
        const double needed = body.ring(y).girth() + options.hip_ease_m - cone.girth;
        cone.flare = std::max(cone.flare, needed / (cone.waist_y - y));
    }
    cone.length = cone.waist_y - hem;
    const double apex = cone.girth / cone.flare; // radius of the waist seam in the flat
    const double angle = cone.flare / 4.0;

    const auto loft = std::make_shared<const Loft>(
        body, hem - 0.02, cone.waist_y, [&](const double y) { return cone.girth_at(y); },
        options.band_ease_m);
    const auto band = std::make_shared<const Loft>(
        body, cone.waist_y, band_top,
        [&](const double y) {
            return cone.girth + (top_girth - cone.girth) * (y - cone.waist_y) / options.band_m;
        },
        options.band_ease_m);

    Pattern pattern;
    for (const bool front : {true, false}) {
        HalfPanel panel;
        panel.name = front ? "front" : "back";
        panel.mirrored = !front;
        panel.chart_offset = Vec2d(front ? 0.0 : 1.2, 0.0);
        const std::vector<Vec2d> top = arc(apex, apex, angle);
        const std::vector<Vec2d> bottom = arc(apex, apex + cone.length, angle);
        panel.border = {{"hem", bottom},
                        {"side", {bottom.back(), top.back()}},
                        {"waist", reversed(top)},
                        {"centre", {top.front(), bottom.front()}}};
        panel.place = [=](const Vec2d& p) {
            const Vec2d d = p - Vec2d(0.0, apex);
            const double share = std::atan2(d.x(), -d.y()) / angle;
            const double y = cone.waist_y - (d.norm() - apex);
            return loft->at(front ? 0.5 * share : 1.0 - 0.5 * share, y);
        };
        pattern.panels.push_back(panel);

        HalfPanel strip;
        strip.name = front ? "band_front" : "band_back";
        strip.mirrored = !front;
        strip.chart_offset = Vec2d(front ? 0.0 : 1.2, 0.1);
        strip.priority = 1;
        const double low = cone.girth / 4.0;
        const double high = top_girth / 4.0;
        const double h = options.band_m;
        strip.border = {{"waist", {{0.0, 0.0}, {low, 0.0}}},
                        {"side", {{low, 0.0}, {high, h}}},
                        {"top", {{high, h}, {0.0, h}}},
                        {"centre", {{0.0, h}, {0.0, 0.0}}}};
        strip.place = [=](const Vec2d& p) {
            const double share = p.x() / (low + (high - low) * p.y() / h);
            return band->at(front ? 0.5 * share : 1.0 - 0.5 * share, cone.waist_y + p.y());
        };
        pattern.panels.push_back(strip);
    }
    pattern.seams = {{"front", "side", "back", "side", false},
                     {"band_front", "side", "band_back", "side", false},
                     {"front", "waist", "band_front", "waist", true},
                     {"back", "waist", "band_back", "waist", true}};
    pattern.centres = {{"front", "centre"},
                       {"back", "centre"},
                       {"band_front", "centre"},
                       {"band_back", "centre"}};
    return pattern;
}

} // namespace toile::garment::block
