// Moves the tracked body onto what a depth grid shows of one person: damped Gauss-Newton steps over
// the hips' place and all joints' turns (P5 section 3, extended to 22 joints).
#pragma once

#include "body/pose_prior.h"
#include "body_tracker/person_mask.h"
#include "body_tracker/tracked_body.h"
#include "geometry/slice.h"

#include <optional>
#include <span>

namespace toile::body_tracker {

/// Deviations are of one cell's reading; informations of neighbours are no more independent than
/// `cell_information` says.
struct RegistrationOptions {
    float deviation_m = 0.02f;     ///< of depth, along the surface's normal
    float robust_m = 0.05f;        ///< scale of Geman and McClure's weight
    float reach_m = 0.12f;         ///< farther depths on one ray are not one surface
    float cell_information = 0.1f; ///< how much of a reading each cell adds
    float extra_weight = 0.25f;    ///< cells of the person where the body is not
    float extra_reach_m = 0.40f;
    float outline_weight = 0.25f; ///< places of the body where nobody is
    float outline_reach_m = 0.40f;
    std::size_t most_cells = 1200; ///< readings that are used, evenly taken
    double pose_weight = 0.2;      ///< of the ranges of joints
    double damping = 0.02;
    std::array<float, 2> stands{1.0f, 1.0f}; ///< of the left and right foot: 0 while it swings
};

/// What the body should be near to, and how near: after a frame, where it was going.
struct MotionPrior {
    body::Pose pose;
    double place_m = 0.15;                        ///< deviation of the hips
    std::array<double, body::kJointCount> turn{}; ///< deviation of each joint, radians
};

/// How well a pose explains the grid.
struct Agreement {
    float error_m = 0.0f;     ///< mean distance of the cells that the body explains
    float unexplained = 1.0f; ///< share of cells of person or body that the other lacks
    std::size_t cells = 0;    ///< of the person
    /// 0 is perfect, 1 is nothing in common.
    [[nodiscard]] float badness() const noexcept { return unexplained + error_m / 0.15f; }
};

class GreyPicture;

/// A place on the skin that was seen again: it must come to lie on a line of sight. Residuals are
/// along . place, metres, for two directions across that line.
struct SkinPull {
    std::uint32_t vertex = 0;
    Vec3f offset = Vec3f::Zero();  ///< from the vertex, in the frame of the skin there
    std::array<Vec3f, 2> along{};  ///< unit, camera frame
    std::array<float, 2> weight{}; ///< 1 / m^2
    float robust_m = 0.03f;        ///< scale of Geman and McClure's weight
};

/// What one frame shows.
struct SeenPerson {
    const DepthGrid& grid;
    const PersonMask& mask;
    std::optional<geometry::Plane> floor; ///< camera frame
    const GreyPicture* picture = nullptr; ///< null: no colour
    std::span<const SkinPull> pulls{};    ///< of the colour picture
};

/// Keeps its work space; not for several threads at once. After it is made nothing allocates.
class Registration {
  public:
    Registration(const TrackedBody& body, const GridCamera& camera);

    /// One step from `pose`; the largest turn of a joint, radians.
    double step(const SeenPerson& seen, const RegistrationOptions& options,
                const MotionPrior* motion, body::Pose& pose) noexcept;

    /// Poses and draws, then compares. Not `whole`: without normals, for a quick look.
    Agreement judge(const SeenPerson& seen, const body::Pose& pose, bool whole = true) noexcept;

    /// Of the last step (before it moved) or judgement.
    [[nodiscard]] const PosedBody& posed() const noexcept { return posed_; }
    [[nodiscard]] const Drawing& drawing() const noexcept { return drawing_; }
    /// Is the cell the person's, and not where that body is drawn, give or take a cell?
    [[nodiscard]] bool lacks_body(const SeenPerson& seen, int x, int y) const noexcept;

    /// Normal matrix and gradient of shape, wear and pose around the last judged pose, data only:
    /// (shapes + kWearCount + 69). `shapes`: so many of the first coefficients. Allocates.
    void linearise_shape(const SeenPerson& seen, const RegistrationOptions& options, int shapes,
                         Eigen::MatrixXd& normal, Eigen::VectorXd& gradient);

  private:
    static constexpr int kUnknowns = body::kPoseUnknowns;
    static constexpr int kStride = 72;
    /// A place on the body: triangle and weights.
    struct Place {
        std::int32_t triangle = -1;
        std::array<float, 3> weights{};
        Vec3f position = Vec3f::Zero();
        Vec3f normal = Vec3f::Zero();
    };
    /// One residual, as add_row takes it.
    struct Row {
        std::int32_t triangle;
        std::array<float, 3> weights;
        Vec3f at, along;
        float residual, weight;
    };
    [[nodiscard]] bool beside_body(int x, int y, float depth) const noexcept;
    [[nodiscard]] Place place_of(const DrawnCell& cell) const noexcept;
    void draw_pose(const body::Pose& pose) noexcept;
    void add_readings(const SeenPerson& seen, const RegistrationOptions& options) noexcept;
    void add_extra(const SeenPerson& seen, const RegistrationOptions& options) noexcept;
    void add_outline(const SeenPerson& seen, const RegistrationOptions& options) noexcept;
    void add_floor(const SeenPerson& seen) noexcept;
    void add_soles(const SeenPerson& seen, const RegistrationOptions& options) noexcept;
    void add_pulls(const SeenPerson& seen) noexcept;
    void add_row(std::int32_t triangle, const std::array<float, 3>& weights, const Vec3f& at,
                 const Vec3f& along, float residual, float weight) noexcept;
    void add_vertex(std::uint32_t vertex, const Vec3f& along, float residual,
                    float weight) noexcept;
    void add_motion(const MotionPrior& motion, const body::Pose& pose) noexcept;
    [[nodiscard]] Eigen::MatrixXf joint_moves(int shapes) const;
    [[nodiscard]] Eigen::Vector<float, kWearCount> wear_motion(const Row& row) const;
    [[nodiscard]] Eigen::VectorXf shape_motion(const Row& row, const Eigen::MatrixXf& joints) const;
    void find_visible(const SeenPerson& seen) noexcept;

    const TrackedBody& body_;
    GridCamera camera_;
    body::PosePrior prior_;
    PosedBody posed_;
    Drawing drawing_;
    std::vector<Row> rows_; // of linearise_shape
    bool recording_ = false;
    std::array<std::vector<std::uint32_t>, 4> soles_; // vertices of heels and toes
    std::vector<std::uint32_t> visible_;              // vertices that the camera sees
    std::vector<float> seen_x_, seen_y_, seen_z_;
    std::array<float, kStride * kStride> sums_{};
    std::array<float, kStride> sum_{};
    Eigen::MatrixXd normal_;
    Eigen::VectorXd gradient_, move_;
    Eigen::LLT<Eigen::MatrixXd> factor_;
};

} // namespace toile::body_tracker
