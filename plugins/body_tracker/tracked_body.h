// The body that is tracked: one shape of the body space at its coarsest level, posed and drawn into
// the grid many times a frame.
#pragma once

#include "body/fit_model.h"
#include "body_tracker/depth_grid.h"

#include <array>
#include <optional>
#include <vector>

namespace toile::body_tracker {

/// A posed surface in the camera's frame.
struct PosedBody {
    body::JointTransforms joints; ///< camera_from_joint
    std::vector<Vec3f> positions; ///< (n) metres
    std::vector<Vec3f> normals;   ///< (n) unit
    std::vector<Quatf> rotations; ///< (n) of the skin there
};

/// The nearest triangle in each cell.
struct DrawnCell {
    float depth = 0.0f; ///< metres; 0: nothing drawn
    std::int32_t triangle = -1;
    float b1 = 0.0f, b2 = 0.0f; ///< weights of the triangle's second and third corner
};

/// What is drawn stays within `low` .. `high` (cells, inclusive).
struct Drawing {
    std::vector<DrawnCell> cells; ///< (width * height)
    std::array<int, 2> low{0, 0}, high{-1, -1};
    std::vector<Vec3f> corners; ///< (n) column, row, 1 / depth of each vertex
};

/// Joints whose turn moves a triangle, and how much of each corner.
struct TriangleJoints {
    std::uint8_t count = 0;
    std::array<std::uint8_t, body::kJointCount> joints{};
};

/// How `along` . x of a place on the surface changes with the pose: three unknowns each for the
/// hips' place and for the turn of every joint that moves it (as body::moved_pose has them). The
/// blend of turns where bones share the skin, and pose correctives, count as fixed.
struct PlaceMotion {
    int count = 0;
    std::array<Vec3f, body::kJointCount + 1> block;
    std::array<int, body::kJointCount + 1> start; ///< of the block among the 69 unknowns
};

/// How far clothes stand off the skin, metres: of chest, waist and seat, upper arms, lower arms,
/// thighs, shanks.
inline constexpr int kWearCount = 6;
using Wear = std::array<float, kWearCount>;
/// Which of `Wear` covers what a joint leads; none: bare.
[[nodiscard]] std::optional<std::size_t> wear_of(body::Joint joint) noexcept;

/// Shape is set now and then; posing and drawing allocate nothing once their outputs are sized.
class TrackedBody {
  public:
    /// \throw Error when the space has no coarse level
    explicit TrackedBody(const body::FitModel& model);

    /// The surface is the skin's, moved outwards by what is worn; joints are those of the skin.
    void set_shape(const body::ShapeVector& coefficients, const Wear& wear = {});
    /// The likeliest body of a height (the smallest change of the mean one), metres.
    void set_stature(float stature_m);
    [[nodiscard]] const body::ShapeVector& shape() const noexcept { return shape_; }
    [[nodiscard]] const Wear& wear() const noexcept { return wear_; }
    /// How much of each of `Wear` a vertex is moved by, outwards.
    [[nodiscard]] const Wear& worn(std::uint32_t vertex) const noexcept { return worn_[vertex]; }
    /// The full surface with what is worn.
    [[nodiscard]] body::BodyShape dressed() const;
    [[nodiscard]] const body::Skeleton& skeleton() const noexcept { return skeleton_; }
    [[nodiscard]] const body::FitModel& model() const noexcept { return model_; }
    [[nodiscard]] const body::FitLevel& level() const noexcept { return level_; }
    [[nodiscard]] const TriangleJoints& joints_of(std::int32_t triangle) const noexcept {
        return triangle_joints_[static_cast<std::size_t>(triangle)];
    }

    /// Whose skin a triangle is for the most part.
    [[nodiscard]] body::Joint leader(std::int32_t triangle) const noexcept {
        return leaders_[static_cast<std::size_t>(triangle)];
    }

    /// A vertex as a corner: three times a triangle that has it, plus which of its corners.
    [[nodiscard]] std::int32_t corner_of(std::uint32_t vertex) const noexcept {
        return corners_[vertex];
    }
    /// All weight on that corner.
    [[nodiscard]] static std::array<float, 3> weights_of(std::int32_t corner) noexcept {
        std::array<float, 3> out{};
        out[static_cast<std::size_t>(corner % 3)] = 1.0f;
        return out;
    }

    /// `weights` of a triangle's corners say where on it `at` (posed) is.
    void motion(const PosedBody& posed, std::int32_t triangle, const std::array<float, 3>& weights,
                const Vec3f& at, const Vec3f& along, PlaceMotion& out) const noexcept;

    [[nodiscard]] PosedBody blank() const;
    void pose(const body::Pose& pose, PosedBody& out) const noexcept;
    /// Joints and positions only.
    void place(const body::Pose& pose, PosedBody& out) const noexcept;

    [[nodiscard]] Drawing blank_drawing(const GridCamera& camera) const;
    /// Triangles that face the camera and lie farther than 0.2 m.
    void draw(const PosedBody& posed, const GridCamera& camera, Drawing& out) const noexcept;

  private:
    const body::FitModel& model_;
    const body::FitLevel& level_;
    body::ShapeVector shape_;
    Wear wear_{};
    std::vector<Wear> worn_; // (n)
    body::Skeleton skeleton_;
    std::vector<Vec3f> rest_; // (n)
    std::vector<TriangleJoints> triangle_joints_;
    std::vector<std::int32_t> corners_; // (n)
    std::vector<body::Joint> leaders_;  // (triangles)
};

} // namespace toile::body_tracker
