#include "apps/still_look.h"

#include "body/body_volumes.h"
#include "body/motion.h"
#include "core/error.h"
#include "pipeline/motion_source.h"

#include <charconv>
#include <filesystem>

namespace toile::apps {
namespace {

constexpr double kSettle_s = 2.0; // how long a still is left to come to hang

// Seconds behind the last "@"; false when there are none.
bool seconds_behind(const std::string& text, std::size_t at, double& seconds) {
    const char* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + at + 1, end, seconds);
    return read.ec == std::errc() && read.ptr == end;
}

body::Pose pose_from(const std::string& text, const body::Skeleton& skeleton,
                     const body::BodyVolumes& volumes) {
    if (text.empty() || text == "rest") return body::rest_pose(skeleton);
    const std::size_t at = text.rfind('@');
    double seconds = 0.0;
    if (at == std::string::npos || std::filesystem::exists(text) ||
        !seconds_behind(text, at, seconds))
        return body::load_pose(text, skeleton, &volumes);
    const std::string file = text.substr(0, at);
    const body::Motion motion = body::load_motion(file, skeleton, &volumes);
    if (!(seconds >= 0.0 && seconds <= motion.duration()))
        throw UsageError("pose '" + text + "': " + file + " lasts " +
                         std::to_string(motion.duration()) + " s");
    return body::sample(motion, seconds);
}

} // namespace

pipeline::RunReport leave_to_hang(FittingRoom& room, const std::string& pose,
                                  const pipeline::RunOptions& options) {
    const body::BodyModel& model = room.body().model();
    const body::BodyVolumes volumes =
        body::measure_volumes(model.skeleton, model.rest.positions, model.parts);
    pipeline::MotionSource source(pipeline::still(pose_from(pose, model.skeleton, volumes)),
                                  model.skeleton, kFramesPerSecond, kSettle_s);
    pipeline::TryOnRun run(source, room.person(), options);
    while (run.next()) {
    }
    return run.report();
}

} // namespace toile::apps
