// The cameras of several sources, and their frames in step.
#pragma once

#include "host/job.h"
#include "pipeline/sensor_source.h"

#include <memory>

namespace toile::apps {

class CameraSet {
  public:
    /// \throw UsageError, Error as SensorSource
    CameraSet(const std::vector<std::string>& uris, host::Registry& registry,
              host::Services& services, const toile_limits& limits, host::Job& job);

    [[nodiscard]] const std::vector<pipeline::SensorStream>& streams() const { return streams_; }

    /// Where the cameras stand, from a file of `toile scan --calibrate`, in the order of the
    /// sources. \throw UsageError when it is of another number of cameras, FileError
    void place(const std::filesystem::path& rig_file);

    /// One frame of each camera; false at the end of one of them.
    bool next(std::vector<pipeline::SensorFrame>& out);

  private:
    bool wait(pipeline::SensorSource& source, std::uint32_t stream, pipeline::SensorFrame& out);

    host::Job& job_;
    std::vector<std::unique_ptr<pipeline::SensorSource>> sources_;
    std::vector<pipeline::SensorStream> streams_;
};

} // namespace toile::apps
