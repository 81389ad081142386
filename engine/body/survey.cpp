#include "body/survey.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

using geometry::GirthCutter;

constexpr int kLevels = 15; // over the zone in which a level is looked for
/// A girth this much larger than the least, relative to it, weighs a third in the waist's level.
constexpr double kWaistSoftness = 0.006;
/// A level whose surface lies this much deeper, relative to the zone, weighs a third in the hip's.
constexpr double kHipSoftness = 0.02;

/// Offsets spread evenly over a zone.
float spread(float low, float high, int k) {
    return low + (high - low) * static_cast<float>(k) / static_cast<float>(kLevels - 1);
}

/// Mean of the zone's levels with weights exp(-cost / softness).
float soft_best(float low, float high, const std::array<double, kLevels>& costs, double softness) {
    const double least = *std::min_element(costs.begin(), costs.end());
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < kLevels; ++k) {
        const double w = std::exp((least - costs[static_cast<std::size_t>(k)]) / softness);
        sum += w * static_cast<double>(spread(low, high, k));
        weights += w;
    }
    return static_cast<float>(sum / weights);
}

} // namespace

Survey::Survey(const Figure& figure) : figure_(figure) {}

void Survey::rest_on(double trust) {
    trust_ = std::min(trust_, trust);
}

Vec3f Survey::at(Landmark landmark) {
    const auto i = static_cast<std::size_t>(landmark);
    rest_on(figure_.landmark_trust[i]);
    return figure_.landmarks[i];
}

Vec3f Survey::middle_of(Landmark a, Landmark b) {
    return 0.5f * (at(a) + at(b));
}

const geometry::SurfacePart& Survey::region(Region region) {
    rest_on(figure_.region_trust[static_cast<std::size_t>(region)]);
    return figure_.region(region);
}

double Survey::height(const Vec3f& point) {
    if (!floor_) {
        float lowest = std::numeric_limits<float>::max();
        for (const Vec3f& p : figure_.positions)
            lowest = std::min(lowest, figure_.up.dot(p));
        floor_ = lowest;
    }
    rest_on(figure_.standing);
    return static_cast<double>(figure_.up.dot(point) - *floor_);
}

const GirthCutter& Survey::cutter(Cutter& kept, const Vec3f& up) {
    const auto& trunk = region(Region::trunk);
    if (!kept) kept.emplace(figure_.positions, trunk, up);
    return *kept;
}

const GirthCutter& Survey::hips() {
    return cutter(hips_, figure_.hips.up);
}
const GirthCutter& Survey::waist() {
    return cutter(waist_, figure_.waist.up);
}
const GirthCutter& Survey::chest() {
    return cutter(chest_, figure_.chest.up);
}

float Survey::waist_level() {
    const GirthCutter& cut = waist();
    if (!waist_level_) {
        const double before = trust_;
        trust_ = 1.0;
        const float low =
            cut.offset(middle_of(Landmark::left_iliac_crest, Landmark::right_iliac_crest));
        const float high =
            cut.offset(middle_of(Landmark::left_lowest_rib, Landmark::right_lowest_rib));
        std::array<double, kLevels> girths{};
        for (int k = 0; k < kLevels; ++k)
            girths[static_cast<std::size_t>(k)] = cut.girth(spread(low, high, k));
        const double least = *std::min_element(girths.begin(), girths.end());
        const float level = soft_best(low, high, girths, std::max(1e-9, kWaistSoftness * least));
        waist_level_ = {level, trust_};
        trust_ = before;
    }
    rest_on(waist_level_->trust);
    return waist_level_->offset;
}

float Survey::hip_level() {
    const GirthCutter& cut = hips();
    if (!hip_level_) {
        const double before = trust_;
        trust_ = 1.0;
        const float low =
            cut.offset(middle_of(Landmark::left_gluteal_fold, Landmark::right_gluteal_fold));
        const float high =
            cut.offset(middle_of(Landmark::left_iliac_crest, Landmark::right_iliac_crest));
        std::array<double, kLevels> depths{};
        for (int k = 0; k < kLevels; ++k)
            depths[static_cast<std::size_t>(k)] =
                -static_cast<double>(cut.extent(spread(low, high, k), -figure_.hips.forward));
        const double zone = std::abs(static_cast<double>(high - low));
        hip_level_ = {soft_best(low, high, depths, std::max(1e-9, kHipSoftness * zone)), trust_};
        trust_ = before;
    }
    rest_on(hip_level_->trust);
    return hip_level_->offset;
}

Vec3f Survey::level_point(const GirthCutter& cutter, float offset, const Vec3f& inside,
                          const Vec3f& towards) {
    const Vec3f& up = cutter.normal();
    const Vec3f origin = inside + (offset - cutter.offset(inside)) * up;
    const Vec3f ahead = (towards - towards.dot(up) * up).normalized();
    const Vec3f across = up.cross(ahead);
    const auto loops =
        geometry::slice(figure_.positions, region(Region::trunk).triangles(), {up, offset});
    Vec3f best = origin;
    float farthest = 0.0f;
    for (const geometry::Loop& loop : loops) {
        const std::size_t count = loop.points.size();
        for (std::size_t i = 0; i + (loop.closed ? 0 : 1) < count; ++i) {
            const Vec3f p = loop.points[i] - origin, q = loop.points[(i + 1) % count] - origin;
            const float a = across.dot(p), b = across.dot(q);
            if ((a < 0.0f) == (b < 0.0f)) continue;
            const Vec3f crossing = p + (a / (a - b)) * (q - p);
            if (ahead.dot(crossing) <= farthest) continue;
            farthest = ahead.dot(crossing);
            best = origin + crossing;
        }
    }
    return best;
}

Vec3f Survey::waist_point(const Vec3f& towards) {
    const Vec3f inside = middle_of(Landmark::left_iliac_crest, Landmark::right_iliac_crest);
    return level_point(waist(), waist_level(), inside, towards);
}

Vec3f Survey::hip_point(const Vec3f& towards) {
    const Vec3f inside = middle_of(Landmark::left_trochanter, Landmark::right_trochanter);
    return level_point(hips(), hip_level(), inside, towards);
}

} // namespace toile::body
