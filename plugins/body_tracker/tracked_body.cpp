#include "body_tracker/tracked_body.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace toile::body_tracker {
namespace {

using body::Joint;
using body::kJointCount;

constexpr float kNearest = 0.2f; // metres
constexpr float kLeastShare = 0.02f;
constexpr float kLeastMoved = 1e-3f;

float cross(const Vec3f& a, const Vec3f& b, float x, float y) noexcept {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

} // namespace

std::optional<std::size_t> wear_of(Joint joint) noexcept {
    switch (joint) {
    case Joint::chest:
    case Joint::upper_chest:
    case Joint::left_shoulder:
    case Joint::right_shoulder:
        return 0;
    case Joint::hips:
    case Joint::spine:
        return 1;
    case Joint::left_upper_arm:
    case Joint::right_upper_arm:
        return 2;
    case Joint::left_lower_arm:
    case Joint::right_lower_arm:
        return 3;
    case Joint::left_upper_leg:
    case Joint::right_upper_leg:
        return 4;
    case Joint::left_lower_leg:
    case Joint::right_lower_leg:
        return 5;
    default:
        return std::nullopt;
    }
}

TrackedBody::TrackedBody(const body::FitModel& model)
    : model_(model), level_(model.level(model.level_count() - 1)) {
    if (model.level_count() < 2) throw Error("tracking needs a body space with levels of detail");
    for (const Triangle& t : level_.triangles) {
        TriangleJoints& out = triangle_joints_.emplace_back();
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const float most =
                std::max({level_.below[t[0]][j], level_.below[t[1]][j], level_.below[t[2]][j]});
            if (most > kLeastShare) out.joints[out.count++] = static_cast<std::uint8_t>(j);
        }
        std::array<float, kJointCount> weight{};
        for (const std::uint32_t v : t)
            for (std::size_t k = 0; k < 4; ++k)
                weight[level_.skin.joints[v][k]] += level_.skin.weights[v][k];
        leaders_.push_back(
            static_cast<Joint>(std::max_element(weight.begin(), weight.end()) - weight.begin()));
    }
    corners_.assign(level_.vertices.size(), 0);
    for (std::size_t n = 0; n < level_.triangles.size(); ++n)
        for (std::size_t k = 0; k < 3; ++k)
            corners_[level_.triangles[n][k]] = static_cast<std::int32_t>(3 * n + k);
    worn_.assign(level_.vertices.size(), Wear{});
    for (std::size_t v = 0; v < worn_.size(); ++v)
        for (std::size_t k = 0; k < 4; ++k)
            if (const auto part = wear_of(static_cast<Joint>(level_.skin.joints[v][k])))
                worn_[v][*part] += level_.skin.weights[v][k];
    set_shape(body::ShapeVector::Zero(model.component_count()));
}

void TrackedBody::set_shape(const body::ShapeVector& coefficients, const Wear& wear) {
    shape_ = coefficients;
    wear_ = wear;
    const Eigen::VectorXf moved = level_.components * shape_.cast<float>();
    rest_.resize(level_.vertices.size());
    for (std::size_t v = 0; v < rest_.size(); ++v)
        rest_[v] = level_.mean[v] + moved.segment<3>(static_cast<int>(3 * v)) +
                   std::inner_product(wear.begin(), wear.end(), worn_[v].begin(), 0.0f) *
                       level_.mean_normals[v];
    skeleton_ = model_.skeleton(shape_);
}

body::BodyShape TrackedBody::dressed() const {
    const body::FitLevel& full = model_.level(0);
    body::FitShape out{shape_, std::vector<float>(full.vertices.size(), 0.0f)};
    for (std::size_t v = 0; v < full.vertices.size(); ++v)
        for (std::size_t k = 0; k < 4; ++k)
            if (const auto part = wear_of(static_cast<Joint>(full.skin.joints[v][k])))
                out.offsets[full.vertices[v]] += full.skin.weights[v][k] * wear_[*part];
    return body::rest_shape(model_, out);
}

void TrackedBody::set_stature(float stature_m) {
    std::size_t top = 0, sole = 0;
    for (std::size_t v = 1; v < level_.mean.size(); ++v) {
        if (level_.mean[v].y() > level_.mean[top].y()) top = v;
        if (level_.mean[v].y() < level_.mean[sole].y()) sole = v;
    }
    const Eigen::VectorXd grows = (level_.components.row(static_cast<int>(3 * top + 1)) -
                                   level_.components.row(static_cast<int>(3 * sole + 1)))
                                      .cast<double>()
                                      .transpose();
    const double more =
        static_cast<double>(stature_m - (level_.mean[top].y() - level_.mean[sole].y()));
    set_shape(grows * (more / grows.squaredNorm()));
}

void TrackedBody::motion(const PosedBody& posed, std::int32_t triangle,
                         const std::array<float, 3>& weights, const Vec3f& at, const Vec3f& along,
                         PlaceMotion& out) const noexcept {
    out.block[0] = along;
    out.start[0] = 0;
    std::size_t count = 1;
    const Triangle& corners = level_.triangles[static_cast<std::size_t>(triangle)];
    const TriangleJoints& moved = joints_of(triangle);
    for (std::uint8_t k = 0; k < moved.count; ++k) {
        const std::size_t j = moved.joints[k];
        const float share = weights[0] * level_.below[corners[0]][j] +
                            weights[1] * level_.below[corners[1]][j] +
                            weights[2] * level_.below[corners[2]][j];
        if (share < kLeastMoved) continue;
        Vec3f turn = share * (at - posed.joints[j].translation).cross(along);
        if (const auto parent = body::joint_parent(static_cast<body::Joint>(j)))
            turn = posed.joints[static_cast<std::size_t>(*parent)].rotation.conjugate() * turn;
        out.block[count] = turn;
        out.start[count++] = 3 + 3 * static_cast<int>(j);
    }
    out.count = static_cast<int>(count);
}

PosedBody TrackedBody::blank() const {
    PosedBody out;
    out.positions.resize(rest_.size());
    out.normals.resize(rest_.size());
    out.rotations.resize(rest_.size());
    return out;
}

void TrackedBody::pose(const body::Pose& pose, PosedBody& out) const noexcept {
    place(pose, out);
    geometry::vertex_normals(out.positions, level_.triangles, out.normals);
}

void TrackedBody::place(const body::Pose& pose, PosedBody& out) const noexcept {
    out.joints = body::forward_kinematics(skeleton_, pose);
    const auto motions =
        body::to_dual_quaternions(body::skinning_transforms(skeleton_, out.joints));
    const body::RotationVectors turns = body::rotation_vectors(pose);
    for (std::size_t v = 0; v < rest_.size(); ++v) {
        const RigidTransform skin =
            body::blend(motions, level_.skin.joints[v], level_.skin.weights[v]);
        const Vec3f rest = rest_[v] + level_.correctives.weights[v] *
                                          body::pose_features(turns, level_.correctives.joints[v]);
        out.positions[v] = skin * rest;
        out.rotations[v] = skin.rotation;
    }
}

Drawing TrackedBody::blank_drawing(const GridCamera& camera) const {
    Drawing out;
    out.cells.resize(camera.size());
    out.corners.resize(rest_.size());
    return out;
}

void TrackedBody::draw(const PosedBody& posed, const GridCamera& camera,
                       Drawing& out) const noexcept {
    for (int y = out.low[1]; y <= out.high[1]; ++y)
        std::fill_n(out.cells.begin() + y * camera.width + out.low[0], out.high[0] - out.low[0] + 1,
                    DrawnCell{});
    out.low = {camera.width, camera.height};
    out.high = {-1, -1};
    for (std::size_t v = 0; v < posed.positions.size(); ++v) {
        const Vec3f& p = posed.positions[v];
        if (-p.z() < kNearest) {
            out.corners[v].setZero();
            continue;
        }
        const Vec2f at = camera.cell(p);
        out.corners[v] = Vec3f(at.x(), at.y(), -1.0f / p.z());
    }
    for (std::size_t n = 0; n < level_.triangles.size(); ++n) {
        const Triangle& t = level_.triangles[n];
        const Vec3f &a = out.corners[t[0]], &b = out.corners[t[1]], &c = out.corners[t[2]];
        // Rows go down: what faces the camera runs clockwise here.
        const float area = cross(a, b, c.x(), c.y());
        if (area >= 0.0f || a.z() <= 0.0f || b.z() <= 0.0f || c.z() <= 0.0f) continue;
        const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))));
        const int x1 = std::min(camera.width - 1,
                                static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))));
        const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()}))));
        const int y1 = std::min(camera.height - 1,
                                static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()}))));
        if (x0 > x1 || y0 > y1) continue;
        out.low = {std::min(out.low[0], x0), std::min(out.low[1], y0)};
        out.high = {std::max(out.high[0], x1), std::max(out.high[1], y1)};
        const float scale = 1.0f / area;
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
                const float wa = cross(b, c, fx, fy) * scale, wb = cross(c, a, fx, fy) * scale;
                const float wc = 1.0f - wa - wb;
                if (wa < 0.0f || wb < 0.0f || wc < 0.0f) continue;
                const float inverse = wa * a.z() + wb * b.z() + wc * c.z();
                const float depth = 1.0f / inverse;
                DrawnCell& cell = out.cells[static_cast<std::size_t>(y * camera.width + x)];
                if (cell.depth != 0.0f && depth >= cell.depth) continue;
                // Weights on the triangle itself, not in the picture.
                cell = {depth, static_cast<std::int32_t>(n), wb * b.z() * depth,
                        wc * c.z() * depth};
            }
    }
}

} // namespace toile::body_tracker
