#include "body_tracker/parts_frames.h"

#include "body/motion.h"
#include "body/skinning.h"
#include "body_tracker/parts_clothes.h"
#include "body_tracker/parts_poses.h"
#include "core/error.h"
#include "geometry/mesh.h"
#include "imaging/depth_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::body_tracker {
namespace {

constexpr float kNearest_m = 0.3f;

Eigen::VectorXd draw_shape(const body::CoefficientPrior& prior, double spread, Random& random) {
    const Eigen::LDLT<Eigen::MatrixXd> factor(prior.covariance);
    Eigen::VectorXd z(prior.mean.size());
    for (double& value : z)
        value = random.normal();
    const Eigen::VectorXd scale = factor.vectorD().cwiseMax(0.0).cwiseSqrt();
    const Eigen::VectorXd lower = factor.matrixL() * Eigen::VectorXd(scale.cwiseProduct(z));
    return prior.mean + spread * (factor.transpositionsP().transpose() * lower);
}

double draw(const std::array<double, 2>& range, Random& random) {
    return random.uniform(range[0], range[1]);
}

/// Any facing or towards the camera, lowest sole on the floor.
body::Pose stand(const body::Skeleton& skeleton, body::Pose pose, const FrameRange& range,
                 Random& random) {
    const double widest = random.uniform() < range.facing_share ? 1.0 / 3.0 : 1.0;
    const auto turn = static_cast<float>(random.uniform(-1.0, 1.0) * widest * std::numbers::pi);
    pose.rotations[0] = Quatf(Eigen::AngleAxisf(turn, Vec3f::UnitY())) * pose.rotations[0];
    pose.hips_position = skeleton.rest(body::Joint::hips);
    pose.hips_position.y() -= body::lowest_sole(skeleton, body::forward_kinematics(skeleton, pose));
    return pose;
}

/// Camera in front of the hips, aimed at them but for the tilt, with them a little aside.
Eigen::Isometry3f draw_camera(const Vec3f& hips, const FrameRange& range, int width,
                              Random& random) {
    const double distance = draw(range.distance_m, random);
    const double height = draw(range.camera_height_m, random);
    const double half = 0.5 * width / static_cast<double>(range.focal_px);
    const double share = random.uniform() < range.cut_share ? 1.0 : range.aside_share;
    const double aside = random.uniform(-1.0, 1.0) * share * half * distance;
    const double ahead = std::atan2(static_cast<double>(hips.y()) - height, distance);
    Eigen::Isometry3f world_from_camera = Eigen::Isometry3f::Identity();
    world_from_camera.translation() =
        Vec3f(hips.x() + static_cast<float>(aside), static_cast<float>(height),
              hips.z() + static_cast<float>(distance));
    const double tilt = ahead + random.uniform(-1.0, 1.0) * range.tilt_rad;
    world_from_camera.rotate(Eigen::AngleAxisf(static_cast<float>(tilt), Vec3f::UnitX()));
    return world_from_camera.inverse();
}

/// Sensor noise; labels follow the readings.
void add_noise(PartsFrame& frame, Random& random) {
    imaging::DepthNoiseMaker noise({});
    const std::vector<PartLabel> clean = frame.labels;
    std::vector<std::uint32_t> source(frame.mm.size());
    noise.apply(frame.width, frame.height, frame.focal_px, frame.mm, source, random);
    for (std::size_t i = 0; i < source.size(); ++i)
        frame.labels[i] = frame.mm[i] != 0 ? clean[source[i]] : PartLabel::invalid;
}

/// A vertex in the picture: pixels, and 1 / depth, which is linear there.
struct Corner {
    float x, y, inverse;
};

float cross(const Corner& a, const Corner& b, float x, float y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

void draw_triangle(const std::array<Corner, 3>& c, const std::array<PartLabel, 3>& labels,
                   PartsFrame& frame) {
    const float area = cross(c[0], c[1], c[2].x, c[2].y);
    if (std::abs(area) < 1e-6f) return;
    const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [top, bottom] = std::minmax({c[0].y, c[1].y, c[2].y});
    const auto within = [](float value, int size) {
        return static_cast<int>(std::clamp(value, -1.0f, static_cast<float>(size)));
    };
    for (int y = std::max(within(top, frame.height), 0);
         y <= std::min(within(bottom, frame.height), frame.height - 1); ++y)
        for (int x = std::max(within(left, frame.width), 0);
             x <= std::min(within(right, frame.width), frame.width - 1); ++x) {
            const auto px = static_cast<float>(x), py = static_cast<float>(y);
            const std::array<float, 3> share = {cross(c[1], c[2], px, py) / area,
                                                cross(c[2], c[0], px, py) / area,
                                                cross(c[0], c[1], px, py) / area};
            if (share[0] < 0.0f || share[1] < 0.0f || share[2] < 0.0f) continue;
            const float inverse =
                share[0] * c[0].inverse + share[1] * c[1].inverse + share[2] * c[2].inverse;
            const auto mm =
                static_cast<std::uint16_t>(std::min(1000.0f / inverse + 0.5f, 65535.0f));
            const auto at = static_cast<std::size_t>(y * frame.width + x);
            if (frame.mm[at] != 0 && frame.mm[at] <= mm) continue;
            frame.mm[at] = mm;
            frame.labels[at] = labels[static_cast<std::size_t>(
                std::max_element(share.begin(), share.end()) - share.begin())];
        }
}

} // namespace

FrameMaker::FrameMaker(const body::BodySpace& space, int people, std::uint64_t seed,
                       const FrameRange& range, std::vector<body::Pose> recorded)
    : range_(range), seed_(seed), recorded_(std::move(recorded)),
      triangles_(space.levels().front().triangles) {
    if (people < 1) throw Error("frames of body parts: people must be 1 or more");
    const auto& vertices = space.levels().front().vertices;
    const std::vector<PartLabel> all = label_vertices(space.model());
    for (const std::uint32_t v : vertices) {
        skin_.joints.push_back(space.model().skin.joints[v]);
        skin_.weights.push_back(space.model().skin.weights[v]);
        labels_.push_back(all[v]);
    }
    Random random(seed);
    for (int p = 0; p < people; ++p) {
        const body::Sex sex = body::kSexes[static_cast<std::size_t>(p % 2)];
        const Eigen::VectorXd drawn = draw_shape(space.prior(sex), range.shape_spread, random);
        const body::BodyShape shape =
            space.shape({drawn.data(), static_cast<std::size_t>(drawn.size())});
        Person person;
        for (const std::uint32_t v : vertices)
            person.shape.positions.push_back(shape.positions[v]);
        person.shape.skeleton = shape.skeleton;
        person.normals.resize(vertices.size());
        geometry::vertex_normals(person.shape.positions, triangles_, person.normals);
        people_.push_back(std::move(person));
    }
}

std::vector<Vec3f> FrameMaker::pose(const Person& person, const body::JointTransforms& world,
                                    Random& random) const {
    const body::Skeleton& skeleton = person.shape.skeleton;
    std::vector<Vec3f> dressed = person.shape.positions;
    if (range_.clothes)
        dress(draw_outfit(random), skeleton, person.normals, labels_, std::span(dressed));
    const body::SkinnedSurface surface(dressed, {}, skin_.joints, skin_.weights);
    std::vector<Vec3f> points(dressed.size());
    surface.pose(body::skinning_transforms(skeleton, world), body::SkinningMethod::dual_quaternion,
                 body::VectorRows(std::span(points)), {});
    return points;
}

PartsFrame FrameMaker::make(std::uint32_t index) const {
    Random random(Random(seed_ ^ (std::uint64_t{index} << 20)).next());
    const Person& person = people_[random.next() % people_.size()];
    const body::Skeleton& skeleton = person.shape.skeleton;
    const body::Pose pose =
        stand(skeleton, draw_pose(skeleton, recorded_, range_.poses, random), range_, random);
    const auto world = body::forward_kinematics(skeleton, pose);
    std::vector<Vec3f> points = this->pose(person, world, random);

    PartsFrame frame;
    frame.width = range_.width;
    frame.height = range_.height;
    frame.focal_px = range_.focal_px;
    if (random.uniform() < range_.upright_share) std::swap(frame.width, frame.height);
    const Eigen::Isometry3f camera = draw_camera(pose.hips_position, range_, frame.width, random);
    for (Vec3f& point : points)
        point = camera * point;
    for (std::size_t j = 0; j < body::kJointCount; ++j)
        frame.joints[j] = camera * world[j].translation;
    draw_parts(points, triangles_, labels_, frame);
    if (range_.noise) add_noise(frame, random);
    return frame;
}

void draw_parts(std::span<const Vec3f> points, std::span<const Triangle> triangles,
                std::span<const PartLabel> labels, PartsFrame& frame) {
    const auto size =
        static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    frame.mm.assign(size, 0);
    frame.labels.assign(size, PartLabel::invalid);
    const float cx = 0.5f * static_cast<float>(frame.width - 1);
    const float cy = 0.5f * static_cast<float>(frame.height - 1);
    for (const Triangle& triangle : triangles) {
        std::array<Corner, 3> corners{};
        std::array<PartLabel, 3> parts{};
        bool near = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f& p = points[triangle[k]];
            near = near || -p.z() < kNearest_m;
            corners[k] = {cx - frame.focal_px * p.x() / p.z(), cy + frame.focal_px * p.y() / p.z(),
                          -1.0f / p.z()};
            parts[k] = labels[triangle[k]];
        }
        if (!near) draw_triangle(corners, parts, frame);
    }
}

} // namespace toile::body_tracker
