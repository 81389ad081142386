// The common scene for cloth (shared data set cloth_scene): a dress on a body that stands or raises
// its arms, and what is measured on it, frame by frame, as the data set's measure.py does.
#pragma once

#include "geometry/nearest_surface.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace toile::bench {

struct SceneMesh {
    std::vector<Vec3f> positions;    ///< (nv) metres
    std::vector<Triangle> triangles; ///< (nf)
};

/// Vertices and triangles as they stand in the file. \throw std::runtime_error naming it
[[nodiscard]] SceneMesh read_scene_mesh(const std::filesystem::path& file);
void write_scene_mesh(const std::filesystem::path& file, const SceneMesh& mesh);
/// The same with a second one around it, `apart` metres out.
[[nodiscard]] SceneMesh doubled(const SceneMesh& mesh, float apart);
/// Every triangle in four, in its plane.
[[nodiscard]] SceneMesh subdivided(const SceneMesh& mesh);

struct ClothScene {
    static constexpr int kFrames = 180;
    static constexpr double kFrame = 1.0 / 60.0;

    SceneMesh body, cloth;
    std::size_t layers = 1;                ///< equal parts of the cloth, the innermost first
    std::vector<std::array<float, 2>> arm; ///< (body nv) weights of the left and right arm
    std::vector<std::array<float, 2>> cloth_arm;

    /// `level` "3k", "10k", "30k" (10k, subdivided) or "3k+3k" (two layers)
    ClothScene(const std::filesystem::path& folder, const std::string& level);
    /// Moves rest positions as the arms do at a time: up by 45 degrees and down again.
    static void pose(const std::vector<Vec3f>& rest, const std::vector<std::array<float, 2>>& arm,
                     double time_s, std::vector<Vec3f>& posed);
};

/// What is wrong in one frame, and how long the cloth's edges are.
class SceneMeasure {
  public:
    explicit SceneMeasure(const ClothScene& scene);

    struct Frame {
        std::size_t deep = 0;    ///< vertices and triangle centres more than 1 mm in the body
        float deepest = 0.0f;    ///< m
        std::size_t through = 0; ///< covered body vertices in front of the cloth
        bool finite = true;
    };
    [[nodiscard]] Frame frame(const std::vector<Vec3f>& body, const std::vector<Vec3f>& cloth);

    struct Strain {
        double largest = 0.0, rms = 0.0, p99 = 0.0;
    };
    [[nodiscard]] Strain strain(const std::vector<Vec3f>& cloth) const;
    /// Pairs of triangles without a common corner that cut each other.
    [[nodiscard]] std::size_t self_intersections(const std::vector<Vec3f>& cloth) const;

  private:
    const ClothScene& scene_;
    geometry::NearestSurface body_, cloth_;
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<std::uint32_t> covered_; ///< body vertices beneath the cloth at rest
};

} // namespace toile::bench
