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

// A cone with a hip curve: the girth of the skirt over the length below the waist seam.
struct Shape {
    double waist_y = 0.0;          // height of the seam between band and skirt
    double girth = 0.0;            // there
    double flare = 0.0;            // girth per length of the cone
    double length = 0.0;           // of the panels
    std::vector<double> hip_curve; // girth beyond the cone, every centimetre below the seam

    [[nodiscard]] double girth_at(const double below) const {
        const double d = std::max(0.0, below) / kRow;
        const auto i = std::min(static_cast<std::size_t>(d), hip_curve.size() - 2);
        const double t = std::min(1.0, d - static_cast<double>(i));
        return girth + flare * std::max(0.0, below) + (1.0 - t) * hip_curve[i] +
               t * hip_curve[i + 1];
    }
    static constexpr double kRow = 0.01;
};

// Where the hips are fuller than the cone, the side seams swing out, as a cutter draws them.
void add_hip_curve(const BodyProbe& body, const SkirtOptions& options, Shape& shape) {
    const auto rows = static_cast<std::size_t>(shape.length / Shape::kRow) + 2;
    const double snug = 2.0 * std::numbers::pi * options.band_ease_m;
    std::vector<double> raw(rows, 0.0);
    for (std::size_t i = 1; i < rows; ++i) {
        const double below = static_cast<double>(i) * Shape::kRow;
        const double ease = snug + (options.hip_ease_m - snug) * std::min(1.0, below / 0.12);
        const double needed = body.ring(shape.waist_y - below).girth() + ease;
        raw[i] = std::max(0.0, needed - shape.girth - shape.flare * below);
    }
    constexpr int kWindow = 2; // rows on each side
    shape.hip_curve.assign(rows, 0.0);
    for (int i = 1; i < static_cast<int>(rows); ++i) {
        for (int j = i - kWindow; j <= i + kWindow; ++j) {
            const int k = std::clamp(j, 0, static_cast<int>(rows) - 1);
            shape.hip_curve[i] += raw[k] / (2 * kWindow + 1);
        }
    }
}

} // namespace

Pattern draft_skirt(const BodyProbe& body, const SkirtOptions& options) {
    const double waist = waist_height(body);
    Shape cone;
    cone.waist_y = waist - 0.5 * options.band_m;
    const double around = 2.0 * std::numbers::pi * options.band_ease_m;
    cone.girth = body.ring(cone.waist_y).girth() + around;
    const double band_top = cone.waist_y + options.band_m;
    const double top_girth = body.ring(band_top).girth() + around;
    const double hem = body.joint(Joint::left_lower_leg).y() - options.below_knee_m;
    cone.flare = options.least_flare;
    cone.length = cone.waist_y - hem;
    add_hip_curve(body, options, cone);
    const double apex = cone.girth / cone.flare; // radius of the waist seam in the flat

    const auto loft = std::make_shared<const Loft>(
        body, hem - 0.02, cone.waist_y,
        [&](const double y) { return cone.girth_at(cone.waist_y - y); },
        options.band_ease_m);
    const auto band = std::make_shared<const Loft>(
        body, cone.waist_y, band_top,
        [&](const double y) {
            return cone.girth + (top_girth - cone.girth) * (y - cone.waist_y) / options.band_m;
        },
        options.band_ease_m);

    // The side seams run down from the body's widest points: front and back differ in width.
    const double front_share = band->front_share(cone.waist_y);
    const double top_share = band->front_share(band_top);
    Pattern pattern;
    for (const bool front : {true, false}) {
        const double share_of_girth = 0.5 * (front ? front_share : 1.0 - front_share);
        const double angle = cone.flare * share_of_girth; // of the cone's sector
        // Half width of the panel as an angle, at a distance below the seam.
        const auto half_angle = [=](const double below) {
            return cone.girth_at(below) * share_of_girth / (apex + below);
        };
        HalfPanel panel;
        panel.name = front ? "front" : "back";
        panel.mirrored = !front;
        panel.chart_offset = Vec2d(front ? 0.0 : 1.2, 0.0);
        const std::vector<Vec2d> top = arc(apex, apex, angle);
        const std::vector<Vec2d> bottom =
            arc(apex, apex + cone.length, half_angle(cone.length));
        std::vector<Vec2d> side;
        constexpr int kPieces = 60;
        for (int i = kPieces; i >= 0; --i) {
            const double below = cone.length * i / kPieces;
            const double a = half_angle(below);
            side.push_back(Vec2d(0.0, apex) + (apex + below) * Vec2d(std::sin(a), -std::cos(a)));
        }
        panel.border = {{"hem", bottom},
                        {"side", side},
                        {"waist", reversed(top)},
                        {"centre", {top.front(), bottom.front()}}};
        panel.place = [=](const Vec2d& p) {
            const Vec2d d = p - Vec2d(0.0, apex);
            const double below = d.norm() - apex;
            const double share = std::atan2(d.x(), -d.y()) / half_angle(below);
            return loft->at(front ? 0.5 * share : 1.0 - 0.5 * share, cone.waist_y - below);
        };
        pattern.panels.push_back(panel);

        HalfPanel strip;
        strip.name = front ? "band_front" : "band_back";
        strip.mirrored = !front;
        strip.chart_offset = Vec2d(front ? 0.0 : 1.2, 0.1);
        strip.priority = 1;
        const double low = cone.girth * share_of_girth;
        const double high = top_girth * 0.5 * (front ? top_share : 1.0 - top_share);
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
