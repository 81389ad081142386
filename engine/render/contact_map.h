// The soft dark blob where a body nears the floor: how much of the sky each place of the floor
// loses to what hangs low over it.
#pragma once

#include "render/frame_uniforms.h"

#include <array>
#include <span>
#include <vector>

namespace toile::render {

class ContactMap {
  public:
    static constexpr int kSide = 64; ///< cells along x and along z

    /// Starts a picture; `box` bounds what will be added.
    void begin(const Box& box) noexcept;
    /// Undersides of one mesh. Triangles wholly higher than 70 cm do not count.
    void add(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
             const RigidTransform& world_from_mesh) noexcept;
    /// Light lost per cell, 0 to 1, rows along z; each low cell is a small level disc above the
    /// floor with its exact form factor.
    [[nodiscard]] std::span<const float> finish() noexcept;

    /// x and z of the first cell's corner, and the side of the map; metres.
    [[nodiscard]] Vec3f rectangle() const { return {x_, z_, size_}; }

  private:
    static constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;

    void put(const Vec3f& p) noexcept;

    float x_ = 0.0f;
    float z_ = 0.0f;
    float size_ = 1.0f;
    std::array<float, kCells> heights_{};
    std::array<float, kCells> lost_{};
};

} // namespace toile::render
