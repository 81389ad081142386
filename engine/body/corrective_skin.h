// The real-time form of the body: dual quaternion skinning of a rest surface that the pose
// corrects, each vertex by its four nearest joints only.
#pragma once

#include "body/scape.h"

namespace toile::body {

/// Learned: displacement of each rest vertex, linear in its features; metres.
struct Correctives {
    std::vector<NearJoints> joints;                              ///< (nv)
    std::vector<Eigen::Matrix<float, 3, kPoseFeatures>> weights; ///< (nv)
};

/// One shape. `pose` is const, allocates nothing and may run on any thread.
class CorrectiveSkin {
  public:
    /// \throw Error when the sizes of shape, weights and correctives differ
    CorrectiveSkin(BodyShape shape, const SkinWeights& skin, const Correctives& correctives);

    [[nodiscard]] const BodyShape& shape() const { return shape_; }
    /// Writes (nv) vertices.
    void pose(const Pose& pose, std::span<Vec3f> positions) const noexcept;

  private:
    /// All that one vertex needs, together in memory.
    struct Vertex {
        Vec3f position;
        std::array<float, 4> weights;
        std::array<std::uint16_t, 4> joints;
        NearJoints near;
        /// Row by row, so that a row meets the features in whole vector registers.
        Eigen::Matrix<float, 3, kPoseFeatures, Eigen::RowMajor> corrective;
    };
    BodyShape shape_;
    std::vector<Vertex> vertices_;
};

} // namespace toile::body
