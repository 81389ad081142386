// What stands still before a camera, where the floor is, and what may be people.
#pragma once

#include "body_tracker/depth_grid.h"
#include "geometry/slice.h"

#include <optional>
#include <span>

namespace toile::body_tracker {

/// A connected piece of foreground of a person's size.
struct Piece {
    std::uint16_t label = 0; ///< in SceneWatch::pieces, from 1
    std::size_t cells = 0;
    Vec3f middle = Vec3f::Zero(); ///< camera frame, metres
    float height_m = 0.0f;        ///< along up
    float area_m2 = 0.0f;         ///< seen across the line of sight
};

/// Learns the scene while people move in it; no empty room is needed. After it is made nothing
/// allocates but the search for a floor, until one is found.
class SceneWatch {
  public:
    /// `up`: unit, camera frame, or nothing: the camera is upright within 35 degrees.
    SceneWatch(const GridCamera& camera, std::optional<geometry::Plane> floor);

    /// Finds foreground and its pieces in a new frame.
    void look(const DepthGrid& grid) noexcept;
    /// Learns the scene from the same frame, but for the cells of people (not 0).
    void learn(const DepthGrid& grid, std::span<const std::uint8_t> people, float dt_s) noexcept;
    /// What was taken for a person is none: its cells are scene from now on.
    void dismiss(const DepthGrid& grid, std::uint16_t label) noexcept;

    [[nodiscard]] const std::optional<geometry::Plane>& floor() const noexcept { return floor_; }
    [[nodiscard]] Vec3f up() const noexcept;
    /// (width * height) label of the piece of each foreground cell; 0: scene, or nothing.
    [[nodiscard]] std::span<const std::uint16_t> labels() const noexcept { return labels_; }
    /// Those of a person's size, the largest first.
    [[nodiscard]] std::span<const Piece> people_like() const noexcept { return pieces_; }
    /// Is it known what is behind a foreground cell? Then that has come before it.
    [[nodiscard]] bool came(std::size_t cell) const noexcept { return background_[cell] != 0.0f; }
    /// May a person reach from one cell to its neighbour?
    [[nodiscard]] static bool joined(float a, float b) noexcept;

  private:
    void find_floor(const DepthGrid& grid);
    [[nodiscard]] bool foreground(std::size_t cell, float depth, const Vec3f& at) const noexcept;
    std::size_t grow_piece(const DepthGrid& grid, std::size_t seed, std::uint16_t label) noexcept;
    [[nodiscard]] bool like_a_person(const DepthGrid& grid, std::uint16_t label,
                                     Piece& out) const noexcept;

    GridCamera camera_;
    std::optional<geometry::Plane> floor_;
    bool floor_given_ = false;
    int floor_tries_ = 0;
    std::vector<float> background_; ///< metres; 0: not known
    std::vector<float> still_s_;    ///< how long something nearer stood there
    std::vector<float> nearer_;     ///< and where
    std::vector<std::uint8_t> front_;
    std::vector<std::uint16_t> labels_;
    std::vector<std::uint32_t> stack_;
    std::vector<Piece> pieces_;
};

} // namespace toile::body_tracker
