// A truncated signed distance field in sparse blocks (Curless and Levoy 1996; KinectFusion,
// P1 2.3).
#pragma once

#include "core/row_loop.h"
#include "scan/depth_view.h"

#include <functional>
#include <span>

namespace toile::scan {

/// Where a view's camera stands among the scan's own coordinates.
using Pose = Eigen::Isometry3d;

struct VolumeOptions {
    float voxel_m = 0.005f;
    float truncation_m = 0.025f;
    float reach_m = 1.6f; ///< half the side of the cube that may hold the surface
};

/// A reading that was brought into the scan's coordinates by itself.
struct Reading {
    Vec3f point, normal; ///< the normal unit, outwards
    float weight = 1.0f;
};

/// A map x -> m.leftCols<3>() x + m.col(3): rigid, or a blend of rigid ones.
using Warp = Eigen::Matrix<float, 3, 4>;

[[nodiscard]] inline Vec3f warped(const Warp& m, const Vec3f& p) {
    return m.leftCols<3>() * p + m.col(3);
}

/// Voxels hold the distance to the surface in metres, positive outside, and how sure it is. Blocks
/// of 8 x 8 x 8 exist where a surface was seen.
class Volume {
  public:
    Volume(const Vec3f& middle, const VolumeOptions& options);

    /// Adds a view. Distances are those to the tangent plane of a reading, not along the ray.
    void integrate(const DepthView& view, const Pose& scan_from_camera, const RowLoop& rows);

    /// Adds readings of a subject that moves, each as a disc of `radius_m` of its tangent plane.
    /// Sums are in the order of the readings.
    void add(std::span<const Reading> readings, float radius_m, const RowLoop& rows);

    /// Distance and its slope (unit length) at a point, between voxels. False where not known.
    [[nodiscard]] bool sample(const Vec3f& point, float& distance) const;
    [[nodiscard]] bool sample(const Vec3f& point, float& distance, Vec3f& slope) const;

    /// Of the voxel at integer coordinates, counted from `origin`; false where not known.
    [[nodiscard]] bool voxel(int x, int y, int z, float& distance, float& weight) const;

    [[nodiscard]] const VolumeOptions& options() const { return options_; }
    [[nodiscard]] const Vec3f& origin() const { return origin_; } ///< of voxel 0, 0, 0
    [[nodiscard]] std::size_t block_count() const { return places_.size(); }
    /// Corner (in voxels) of each block.
    [[nodiscard]] const std::vector<Eigen::Vector3i>& blocks() const { return places_; }

    static constexpr int kSide = 8;

  private:
    struct Block {
        std::array<float, kSide * kSide * kSide> distance;
        std::array<float, kSide * kSide * kSide> weight;
    };
    void allocate(const DepthView& view, const Pose& scan_from_camera);
    std::int32_t allocate(int bx, int by, int bz);
    void update(Block& block, const Eigen::Vector3i& place, const DepthView& view,
                const Eigen::Isometry3f& camera_from_scan) const;
    void splat(Block& block, const Eigen::Vector3i& place, const Reading& reading,
               float radius) const;
    [[nodiscard]] const Block* block_at(int bx, int by, int bz) const {
        if (bx < 0 || by < 0 || bz < 0 || bx >= side_ || by >= side_ || bz >= side_) return nullptr;
        const std::int32_t i = index_[static_cast<std::size_t>((bz * side_ + by) * side_ + bx)];
        return i < 0 ? nullptr : &blocks_[static_cast<std::size_t>(i)];
    }

    VolumeOptions options_;
    Vec3f origin_;
    int side_; // blocks along each axis
    std::vector<std::int32_t> index_;
    std::vector<Block> blocks_;
    std::vector<Eigen::Vector3i> places_;
};

/// Points and normals of a surface, one for each pixel; NaN where there is none.
struct SurfaceMap {
    Window camera;
    std::vector<Vec3f> points, normals; ///< in the scan's coordinates
};

/// What a camera at `scan_from_camera` would see of the volume within `reach` (metres) of what
/// `view` reads there or a few pixels beside it, every `stride`th pixel.
[[nodiscard]] SurfaceMap raycast(const Volume& volume, const DepthView& view, int stride,
                                 float reach_m, const Pose& scan_from_camera, const RowLoop& rows);

/// (pixels) depth of the volume's surface near each of the view's readings, 0 where there is none.
[[nodiscard]] std::vector<float> predicted_depth(const Volume& volume, const DepthView& view,
                                                 const Pose& scan_from_camera);

/// The same where each reading has a map of its own; one that is not finite has none.
[[nodiscard]] std::vector<float>
predicted_depth(const Volume& volume, const DepthView& view,
                const std::function<Warp(std::size_t pixel)>& scan_from_camera);

} // namespace toile::scan
