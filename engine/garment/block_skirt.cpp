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

// Where the hips are fuller than the cone, the seams swing out, as a cutter draws them.
void add_hip_curve(const BodyProbe& body, const SkirtOptions& options, Shape& shape) {
    const auto rows = static_cast<std::size_t>(shape.length / Shape::kRow) + 2;
    const double snug = 2.0 * std::numbers::pi * options.band_ease_m;
    std::vector<double> raw(rows, 0.0);
    for (std::size_t i = 1; i < rows; ++i) {
        const double below = static_cast<double>(i) * Shape::kRow;
        const double free = std::min(1.0, below / 0.16);
        const double ease = snug + (options.hip_ease_m - snug) * free * free;
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

struct Gores {
    Shape shape;
    double band_top = 0.0, top_girth = 0.0;
    double front_share = 0.0, top_front_share = 0.0; // of the girth, at the seam and the top
    std::shared_ptr<const Loft> loft, band;

    // Width of one gore, half a quarter of the skirt.
    [[nodiscard]] double width(const bool front, const double below) const {
        return 0.25 * shape.girth_at(below) * (front ? front_share : 1.0 - front_share);
    }
};

std::string gore_name(const bool front, const bool centre) {
    return std::string(front ? "front" : "back") + (centre ? "" : "_side");
}

Vec2d chart_place(const bool front, const bool centre, const double y) {
    return {(front ? 0.0 : 1.6) + (centre ? 0.0 : 0.75), y};
}

// Share of the way round from the centre front, for a share 0..1 across a gore.
double around(const bool front, const bool centre, const double across) {
    const double quarter = 0.5 * across + (centre ? 0.0 : 0.5);
    return front ? 0.5 * quarter : 1.0 - 0.5 * quarter;
}

// A sector of the cone, as wide at each level as its share of the girth: so the hip curve is
// spread over all seams. The centre gore is half a panel, its centre line straight.
void add_gore(Pattern& pattern, const Gores& g, const bool front, const bool centre) {
    const double apex = g.width(front, 0.0) * 4.0 / g.shape.flare *
                        (front ? 1.0 / g.front_share : 1.0 / (1.0 - g.front_share));
    // Angles of the gore's edges at a distance below the seam.
    const auto right = [=](const double below) {
        return g.width(front, below) / (apex + below) * (centre ? 1.0 : 0.5);
    };
    const auto left = [=](const double below) { return centre ? 0.0 : -right(below); };
    const auto point = [=](const double below, const double angle) -> Vec2d {
        return Vec2d(0.0, apex) + (apex + below) * Vec2d(std::sin(angle), -std::cos(angle));
    };
    constexpr int kPieces = 60;
    std::vector<Vec2d> hem;
    std::vector<Vec2d> up;
    std::vector<Vec2d> waist;
    std::vector<Vec2d> down;
    for (int i = 0; i <= kPieces; ++i) {
        const double t = static_cast<double>(i) / kPieces;
        const double length = g.shape.length;
        hem.push_back(point(length, left(length) + t * (right(length) - left(length))));
        up.push_back(point((1.0 - t) * length, right((1.0 - t) * length)));
        waist.push_back(point(0.0, right(0.0) + t * (left(0.0) - right(0.0))));
        down.push_back(point(t * length, left(t * length)));
    }
    HalfPanel panel;
    panel.name = gore_name(front, centre);
    panel.mirrored = !front;
    panel.chart_offset = chart_place(front, centre, 0.0);
    panel.right_chart_shift = centre ? 0.0 : front ? -1.5 : 0.0;
    panel.border = {{"hem", hem},
                    {centre ? "princess" : "side", up},
                    {"waist", waist},
                    {centre ? "centre" : "princess", down}};
    panel.place = [=](const Vec2d& p) {
        const Vec2d d = p - Vec2d(0.0, apex);
        const double below = d.norm() - apex;
        const double angle = std::atan2(d.x(), -d.y());
        const double across = (angle - left(below)) / (right(below) - left(below));
        return g.loft->at(around(front, centre, across), g.shape.waist_y - below);
    };
    pattern.panels.push_back(std::move(panel));
}

void add_band(Pattern& pattern, const Gores& g, const bool front, const bool centre) {
    const double h = g.band_top - g.shape.waist_y;
    const double low = g.width(front, 0.0);
    const double high = 0.25 * g.top_girth * (front ? g.top_front_share : 1.0 - g.top_front_share);
    HalfPanel strip;
    strip.name = "band_" + gore_name(front, centre);
    strip.mirrored = !front;
    strip.chart_offset = chart_place(front, centre, 0.1);
    strip.right_chart_shift = centre ? 0.0 : front ? -1.5 : 0.0;
    strip.priority = 1;
    strip.border = {{"waist", {{0.0, 0.0}, {low, 0.0}}},
                    {centre ? "princess" : "side", {{low, 0.0}, {high, h}}},
                    {"top", {{high, h}, {0.0, h}}},
                    {centre ? "centre" : "princess", {{0.0, h}, {0.0, 0.0}}}};
    strip.place = [=](const Vec2d& p) {
        const double across = p.x() / (low + (high - low) * p.y() / h);
        return g.band->at(around(front, centre, across), g.shape.waist_y + p.y());
    };
    pattern.panels.push_back(std::move(strip));
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
    const auto loft = std::make_shared<const Loft>(
        body, hem - 0.02, cone.waist_y,
        [&](const double y) { return cone.girth_at(cone.waist_y - y); }, options.band_ease_m);
    const auto band = std::make_shared<const Loft>(
        body, cone.waist_y, band_top,
        [&](const double y) {
            return cone.girth + (top_girth - cone.girth) * (y - cone.waist_y) / options.band_m;
        },
        options.band_ease_m);

    const Gores gores{
        cone, band_top, top_girth, band->front_share(cone.waist_y), band->front_share(band_top),
        loft, band};
    Pattern pattern;
    for (const bool front : {true, false}) {
        for (const bool centre : {true, false}) {
            add_gore(pattern, gores, front, centre);
            add_band(pattern, gores, front, centre);
        }
        const std::string face = front ? "front" : "back";
        pattern.seams.push_back({face, "princess", face + "_side", "princess", true});
        pattern.seams.push_back(
            {"band_" + face, "princess", "band_" + face + "_side", "princess", true});
        pattern.centres.push_back({face, "centre"});
        pattern.centres.push_back({"band_" + face, "centre"});
    }
    for (const std::string gore : {"front", "front_side", "back", "back_side"}) {
        pattern.seams.push_back({gore, "waist", "band_" + gore, "waist", true});
    }
    pattern.seams.push_back({"front_side", "side", "back_side", "side", false});
    pattern.seams.push_back({"band_front_side", "side", "band_back_side", "side", false});
    return pattern;
}

} // namespace toile::garment::block
