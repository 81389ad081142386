#include "apps/camera_set.h"

#include "core/error.h"
#include "core/log.h"
#include "imaging/rig_file.h"

#include <unistd.h>

namespace toile::apps {

CameraSet::CameraSet(const std::vector<std::string>& uris, host::Registry& registry,
                     host::Services& services, const toile_limits& limits, host::Job& job)
    : job_(job) {
    for (const std::string& uri : uris) {
        sources_.push_back(
            std::make_unique<pipeline::SensorSource>(uri, registry, services, limits, job));
        const auto& streams = sources_.back()->streams();
        streams_.insert(streams_.end(), streams.begin(), streams.end());
        // Of several sources each has a "camera0": what they are called by tells them apart.
        if (uris.size() > 1 && streams.size() == 1)
            streams_.back().name = std::filesystem::path(uri.substr(uri.find(':') + 1)).stem();
        if (streams_.back().name.empty())
            streams_.back().name = "camera" + std::to_string(streams_.size() - 1);
    }
}

void CameraSet::place(const std::filesystem::path& rig_file) {
    const imaging::RigFile rig = imaging::load_rig(rig_file);
    if (rig.cameras.size() != streams_.size())
        throw UsageError("scan --extrinsics " + rig_file.string() + ": is of " +
                         std::to_string(rig.cameras.size()) + " cameras, the sources have " +
                         std::to_string(streams_.size()));
    for (std::size_t c = 0; c < streams_.size(); ++c) {
        if (rig.cameras[c].name != streams_[c].name)
            log::warning("scan --extrinsics " + rig_file.string() + ": '" + streams_[c].name +
                         "' is taken for what was called '" + rig.cameras[c].name +
                         "' in the calibration");
        streams_[c].world_from_camera = rig.cameras[c].world_from_camera;
    }
}

bool CameraSet::next(std::vector<pipeline::SensorFrame>& out) {
    out.resize(streams_.size());
    std::size_t at = 0;
    for (const auto& source : sources_)
        for (std::uint32_t c = 0; c < source->streams().size(); ++c)
            if (!wait(*source, c, out[at++])) return false;
    return true;
}

bool CameraSet::wait(pipeline::SensorSource& source, std::uint32_t stream,
                     pipeline::SensorFrame& out) {
    constexpr int kMostWaits = 5000; // of a millisecond: a live sensor without a new picture
    for (int waits = 0; !source.next(stream, out); ++waits) {
        if (source.ended(stream) || waits > kMostWaits || job_.cancelled()) return false;
        usleep(1000);
    }
    return true;
}

} // namespace toile::apps
