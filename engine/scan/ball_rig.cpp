#include "scan/ball_rig.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>

namespace toile::scan {
namespace {

double median_radius(const SeenBalls& seen) {
    std::vector<double> all;
    for (const auto& camera : seen)
        for (const auto& found : camera)
            if (found) all.push_back(found->ball.radius_m);
    if (all.empty())
        throw Error("no picture shows a ball: hold it on a stick or a thread, away from yourself "
                    "and the floor, 4 to 40 cm in radius");
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
}

} // namespace

BallRig rig_from_balls(const SeenBalls& seen, std::span<const double> focal,
                       std::span<const std::string> names, double known_radius_m) {
    // Readings err together over some pixels, and with the steps of a triangulating camera.
    constexpr double kAlike = 8.0, kLeast_m = 0.0005, kPixels = 0.2;
    BallRig out;
    const double found_radius = median_radius(seen);
    out.radius_m = known_radius_m > 0.0 ? known_radius_m : found_radius;
    SeenPlaces places(seen.size());
    for (std::size_t c = 0; c < seen.size(); ++c)
        for (const auto& found : seen[c]) {
            auto& place = places[c].emplace_back();
            if (!found) continue;
            Ball start = found->ball;
            start.centre += (out.radius_m - start.radius_m) * start.centre.normalized();
            start.radius_m = out.radius_m;
            const auto ball = fit_ball(found->points, start, true);
            if (!ball) continue;
            const double sigma = depth_sigma(static_cast<float>(-ball->centre.z()));
            place.emplace();
            place->point = ball->centre;
            place->along_m =
                kLeast_m + sigma * std::sqrt(kAlike / static_cast<double>(ball->readings));
            place->across_m = kLeast_m + kPixels * -ball->centre.z() / focal[c];
        }
    out.rig = solve_rig(places, names);
    return out;
}

} // namespace toile::scan
