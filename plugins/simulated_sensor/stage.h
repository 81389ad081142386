// Everything the cameras can see: surfaces that move from frame to frame, and rays against them.
#pragma once

#include "core/types.h"
#include "imaging/image.h"

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace toile::simulated_sensor {

/// Fine structure of a surface's colour, made up from where a point lies at rest.
enum class Grain : std::uint8_t { invalid, plain, skin, cloth, hair, boards, plaster, print };

struct SurfaceLook {
    Vec3f albedo = Vec3f::Constant(0.5f);          ///< linear; multiplies the texture
    std::shared_ptr<const imaging::Image> texture; ///< sRGB; null: none
    Grain grain = Grain::plain;
};

/// What stays the same over a recording. Indices into the vertices given to Stage::move.
struct Surface {
    std::string name;
    std::vector<Triangle> triangles;  ///< (nf)
    std::vector<Vec2f> corner_coords; ///< (3 nf) texture coordinates from the top left, or empty
    std::vector<Vec3f> rest;          ///< (nv) metres; where the grain is fixed
    SurfaceLook look;
    std::vector<Vec3f> tint; ///< (nv) linear; multiplies the albedo, or empty
};

/// Rays of one camera: they leave `origin` and have length 1 along its axis, so that a hit's
/// distance is the depth.
struct HitMap {
    int width = 0;
    int height = 0;
    std::vector<float> depth;                ///< (width * height) metres; infinity: nothing
    std::vector<float> cosine;               ///< of the angle between normal and ray, [0, 1]
    std::vector<std::uint32_t> surface;      ///< as given by Stage::add
    std::vector<std::uint32_t> triangle;     ///< of that surface
    std::vector<std::array<float, 2>> place; ///< weights of the triangle's second and third corner

    void resize(int w, int h);
};

/// One ray's result.
struct Hit {
    float depth = std::numeric_limits<float>::infinity();
    float cosine = 0.0f;
    std::uint32_t surface = 0;
};

/// An Embree scene. `add` first, then in each frame `move` and `commit`, then rays from any thread.
/// Not movable.
class Stage {
  public:
    /// \throw Error when Embree does not start
    Stage();
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// Takes a surface over and numbers it from 0. \throw Error when an index is out of range, a
    /// position not finite or a count wrong
    std::uint32_t add(Surface surface, std::span<const Vec3f> positions);
    /// New places of a surface's vertices (nv, finite).
    void move(std::uint32_t surface, std::span<const Vec3f> positions);
    /// Builds the search tree from where everything now is; it depends on nothing else.
    void commit();

    /// First hits of the pixels [begin, end) of `hits`: ray k has the direction directions[k].
    void trace(const Vec3f& origin, std::span<const Vec3f> directions, std::size_t begin,
               std::size_t end, HitMap& hits) const noexcept;
    [[nodiscard]] Hit trace(const Vec3f& origin, const Vec3f& direction) const noexcept;
    /// Is there anything between the two points? Near both ends (2 mm) nothing counts.
    [[nodiscard]] bool blocked(const Vec3f& from, const Vec3f& to) const noexcept;

    [[nodiscard]] std::size_t surface_count() const noexcept { return surfaces_.size(); }
    [[nodiscard]] const Surface& surface(std::uint32_t index) const { return surfaces_[index]; }
    [[nodiscard]] std::span<const Vec3f> positions(std::uint32_t index) const {
        return moving_[index].positions;
    }
    /// Area-weighted vertex normals as of the last commit. (nv)
    [[nodiscard]] std::span<const Vec3f> normals(std::uint32_t index) const {
        return moving_[index].normals;
    }

  private:
    struct Tree;
    struct Moving {
        std::vector<Vec3f> positions;
        std::vector<Vec3f> normals;
        bool fresh = true; ///< moved since the last commit
    };

    std::unique_ptr<Tree> tree_;
    std::vector<Surface> surfaces_;
    std::vector<Moving> moving_;
};

} // namespace toile::simulated_sensor
