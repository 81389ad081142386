// Tiny made-up inputs for the contract: a figure of capsules and a tube of cloth around it.
#pragma once

#include "abi/toile.h"
#include "core/types.h"

#include <array>
#include <string>
#include <vector>

namespace toile::host {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;
using Index4 = std::array<std::uint16_t, 4>;
using Joints = std::array<toile_joint, TOILE_JOINT_COUNT>;

/// 22 joints, 1.7 m tall, one closed capsule per bone, each vertex held by one joint.
/// Not moved: `abi` points into it.
class CapsuleFigure {
  public:
    CapsuleFigure();
    CapsuleFigure(const CapsuleFigure&) = delete;
    CapsuleFigure& operator=(const CapsuleFigure&) = delete;

    [[nodiscard]] const toile_body& abi() const { return body_; }
    [[nodiscard]] const std::vector<Float3>& positions() const { return positions_; }
    [[nodiscard]] const std::vector<Float3>& normals() const { return normals_; }

    /// Joints of the rest pose, turned by `yaw_rad` about the world's y axis and then moved.
    [[nodiscard]] Joints joints(double yaw_rad, const Float3& move) const;
    /// The surface for `joints` (each vertex follows its joint rigidly).
    void pose(const Joints& joints, std::vector<Float3>& positions,
              std::vector<Float3>& normals) const;
    /// A state over `joints` and, when given, a posed surface. Borrowed.
    [[nodiscard]] toile_body_state state(const Joints& joints, std::uint32_t sequence,
                                         const std::vector<Float3>* positions = nullptr,
                                         const std::vector<Float3>* normals = nullptr) const;

  private:
    void add_capsule(std::uint32_t joint, const Float3& from, const Float3& to, float radius,
                     std::uint8_t part);

    std::array<Float3, TOILE_JOINT_COUNT> rest_joints_{};
    std::vector<Float3> positions_, normals_;
    std::vector<Triangle> triangles_;
    std::vector<Index4> joint_indices_;
    std::vector<Float4> joint_weights_;
    std::vector<std::uint8_t> parts_;
    toile_body body_{};
};

/// An open tube around the figure's trunk, its top ring pinned. Not moved.
class ClothTube {
  public:
    explicit ClothTube(const CapsuleFigure& figure);
    ClothTube(const ClothTube&) = delete;
    ClothTube& operator=(const ClothTube&) = delete;

    [[nodiscard]] const toile_garment_package& package() const { return package_; }
    [[nodiscard]] const toile_cloth_garment& garment() const { return garment_; }
    [[nodiscard]] const std::vector<Float3>& positions() const { return positions_; }
    [[nodiscard]] const std::vector<float>& pins() const { return pins_; }

  private:
    std::vector<Float3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<Float2> corner_coords_;
    std::vector<Index4> joint_indices_;
    std::vector<Float4> joint_weights_;
    std::vector<float> pins_;
    toile_garment_package package_{};
    toile_cloth_garment garment_{};
};

} // namespace toile::host
