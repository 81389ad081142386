// Depth frames of bodies drawn from the body space, with the part under each pixel.
#pragma once

#include "body/body_space.h"
#include "body_tracker/parts_labels.h"
#include "body_tracker/parts_poses.h"
#include "core/random.h"

#include <array>
#include <span>
#include <vector>

namespace toile::body_tracker {

/// What frames are drawn from. The camera's height is above the floor, its distance to the hips.
struct FrameRange {
    int width = 160, height = 120;
    float focal_px = 145.0f;
    double upright_share = 0.25; ///< of frames by a camera on its side: width and height exchanged
    std::array<double, 2> camera_height_m = {0.5, 2.2};
    std::array<double, 2> distance_m = {1.5, 4.0};
    double tilt_rad = 0.18;    ///< aims up to so much above or below the hips
    double aside_share = 0.25; ///< the person's place off the axis, in half widths of the view
    double cut_share = 0.15;   ///< of frames with the person up to the picture's edge
    double facing_share = 0.5; ///< of frames where people face the camera, up to 60 degrees off
    double shape_spread = 1.3; ///< of the population's deviation
    PoseMix poses;
    bool clothes = true; ///< clothes and hair
    bool noise = true;   ///< of a Kinect v1: imaging/depth_noise.h
};

struct PartsFrame {
    int width = 0, height = 0;
    float focal_px = 0.0f;
    std::vector<std::uint16_t> mm;               ///< (width * height), 0 where nobody is
    std::vector<PartLabel> labels;               ///< (width * height), invalid where nobody is
    std::array<Vec3f, body::kJointCount> joints; ///< metres, camera frame (-Z ahead, +Y up)
};

/// Draws frames; frame `index` of a seed is the same whoever asks and when. Calls are const and may
/// run side by side.
class FrameMaker {
  public:
    /// Draws `people` shapes from both sexes' populations; `recorded` poses are those of read_poses
    /// or none. \throw Error for no people
    FrameMaker(const body::BodySpace& space, int people, std::uint64_t seed,
               const FrameRange& range, std::vector<body::Pose> recorded = {});

    [[nodiscard]] PartsFrame make(std::uint32_t index) const;

  private:
    struct Person {
        body::BodyShape shape; ///< the level's vertices
        std::vector<Vec3f> normals;
    };
    [[nodiscard]] std::vector<Vec3f> pose(const Person& person, const body::JointTransforms& world,
                                          Random& random) const;

    FrameRange range_;
    std::uint64_t seed_;
    std::vector<body::Pose> recorded_;
    std::vector<Person> people_;
    body::SkinWeights skin_;          ///< of the level's vertices
    std::vector<Triangle> triangles_; ///< of the level's vertices
    std::vector<PartLabel> labels_;   ///< of the level's vertices
};

/// Draws triangles with the nearest in front. points (nv) in the camera frame; a pixel takes the
/// label of the triangle's vertex nearest to it. Triangles nearer than 0.3 m are left out.
void draw_parts(std::span<const Vec3f> points, std::span<const Triangle> triangles,
                std::span<const PartLabel> labels, PartsFrame& frame);

} // namespace toile::body_tracker
