// A dressed person as a 3D file, and as a surface cache over time.
#pragma once

#include "body/surface_cache.h"
#include "pipeline/dressed_person.h"

#include <filesystem>
#include <optional>

namespace toile::apps {

/// Body and garments as they stand now, with their materials. \throw Error
void save_look(const pipeline::DressedPerson& person, const std::filesystem::path& file);

/// Keeps body and garments of every frame (body/surface_cache.h); no folder, no cache.
class LookCache {
  public:
    explicit LookCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// \throw Error when the folder holds a cache already or cannot be written
    void add(const pipeline::DressedPerson& person, const pipeline::BodyFrame& frame);

  private:
    std::filesystem::path folder_;
    std::optional<body::SurfaceCacheWriter> writer_;
    std::vector<Vec3f> body_; // (seamed vertices) as drawn
    std::int64_t first_ns_ = 0;
};

} // namespace toile::apps
