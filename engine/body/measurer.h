// Measures bodies of one model: any shape and pose of its surface.
#pragma once

#include "body/body_model.h"
#include "body/measurement.h"

#include <memory>

namespace toile::body {

/// Keeps the model's topology, parts and landmarks. Const, so that many threads may measure at
/// once. Values change smoothly with the shape; a whole set takes a few milliseconds.
class Measurer {
  public:
    /// \throw Error naming the landmark that the model lacks
    explicit Measurer(const BodyModel& model);

    /// The figure of one surface (nv) of this model; both are borrowed. `world`: its joints, turned
    /// against the rest pose (forward_kinematics). Bent joints lower the trust in what they move.
    [[nodiscard]] Figure figure(std::span<const Vec3f> positions,
                                const JointTransforms& world) const;
    /// In the rest pose.
    [[nodiscard]] Figure figure(std::span<const Vec3f> positions, const Skeleton& skeleton) const;

    /// The surface (nv) brought back into the rest pose: each vertex is moved by the inverse of its
    /// linear blend. What is measured there does not depend on the pose that it was seen in.
    [[nodiscard]] std::vector<Vec3f> unposed(std::span<const Vec3f> positions,
                                             const Skeleton& skeleton,
                                             const JointTransforms& world) const;

    /// All measurements, or those that `measurement_definitions(names)` chose.
    [[nodiscard]] Measurements measure(std::span<const Vec3f> positions,
                                       const Skeleton& skeleton) const;
    [[nodiscard]] Measurements
    measure(std::span<const Vec3f> positions, const Skeleton& skeleton,
            std::span<const MeasurementDefinition* const> definitions) const;

    /// Vertex of each landmark.
    [[nodiscard]] const std::array<std::uint32_t, kLandmarkCount>& landmarks() const {
        return landmarks_;
    }

  private:
    std::vector<Triangle> triangles_;
    SkinWeights skin_;
    Regions regions_;
    std::array<std::uint32_t, kLandmarkCount> landmarks_{};
};

/// Names to metres, for BodyModel::measurements: all that are trusted at least this far.
[[nodiscard]] std::map<std::string, double> as_map(const Measurements& measurements,
                                                   double least_confidence = 0.0);

} // namespace toile::body
