#include "scan/tracking.h"

namespace toile::scan {

Pose times_over(const Pose& motion, double times) {
    const Eigen::AngleAxisd turn(motion.linear());
    Pose out = Pose::Identity();
    out.linear() = Eigen::AngleAxisd(times * turn.angle(), turn.axis()).toRotationMatrix();
    out.translation() = times * motion.translation();
    return out;
}

Registered
track_on(const Pose& last, const Pose& step,
         const std::function<Registered(const Pose& start, float reach_m)>& register_from) {
    constexpr double kEnough = 0.7; // overlap of what need not be tried otherwise
    struct Try {
        Pose start;
        std::array<float, 2> reach_m;
    };
    Registered best;
    for (const Try& attempt : {Try{step * last, {0.04f, 0.025f}}, Try{step * last, {0.1f, 0.04f}},
                               Try{last, {0.1f, 0.04f}}}) {
        Registered found;
        found.pose = attempt.start;
        for (const float reach : attempt.reach_m)
            found = register_from(found.pose, reach);
        if (found.overlap > best.overlap) best = found;
        if (best.overlap > kEnough && best.rms_m < kMostRms_m) break;
    }
    return best;
}

} // namespace toile::scan
