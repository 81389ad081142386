// A surface cache: what a dressed person looked like in every frame of a motion, for whoever wants
// to see it again without simulating it.
//
// FOLDER/cache.json         schema, and what each surface is
// FOLDER/surfaces.glb       topology, texture coordinates, materials; positions of the first frame
// FOLDER/track.jsonl        time and joints of each frame (track_file.h)
// FOLDER/frames/000000.f32  positions of all surfaces one after the other, x y z, 32-bit
//                           little-endian floats, metres, world
#pragma once

#include "assets/scene.h"
#include "body/track_file.h"

namespace toile::body {

/// Values as in abi/truth.h (TOILE_SURFACE_*). `other`: hair, eyes.
enum class SurfaceRole : std::uint8_t { invalid, body, garment, other };

/// One primitive of the cache's scene.
struct CachedSurface {
    std::string name; ///< of its mesh
    SurfaceRole role = SurfaceRole::invalid;
    std::size_t mesh = 0;
    std::size_t primitive = 0;
    std::size_t vertex_count = 0;
};

/// Writes a cache frame by frame; what was written can be read after an interruption.
class SurfaceCacheWriter {
  public:
    /// `scene` holds the surfaces as they are drawn; roles (meshes), in the order of its meshes.
    /// \throw Error, also when the folder already holds a cache
    SurfaceCacheWriter(std::filesystem::path folder, const assets::Scene& scene,
                       const std::vector<SurfaceRole>& roles);

    /// `positions`: of every primitive in the scene's order, as many as it has vertices.
    /// \throw Error, also when the time does not rise
    void add(double time_s, std::span<const TrackedPerson> people,
             std::span<const std::span<const Vec3f>> positions);

    [[nodiscard]] std::uint64_t frame_count() const { return count_; }

  private:
    std::filesystem::path folder_;
    std::vector<CachedSurface> surfaces_;
    std::uint64_t count_ = 0;
    double last_time_s_ = 0.0;
};

struct SurfaceCache {
    std::filesystem::path folder;
    assets::Scene scene; ///< as in the first frame
    std::vector<CachedSurface> surfaces;
    std::vector<TrackFrame> frames;

    /// Positions of one frame, surface by surface. `positions` (surfaces) is given its sizes when
    /// they are not right yet. \throw FileError
    void load(std::size_t frame, std::vector<std::vector<Vec3f>>& positions) const;
};

/// Reads everything but the frames. \throw FileError naming the file and what is wrong with it
[[nodiscard]] SurfaceCache open_surface_cache(const std::filesystem::path& folder);

} // namespace toile::body
