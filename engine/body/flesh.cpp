#include "body/flesh.h"

#include "body/dual_quaternion.h"
#include "body/rotations.h"
#include "body/scape.h"
#include "core/error.h"
#include "geometry/laplacian.h"

#include <algorithm>
#include <cmath>

namespace toile::body {
namespace {

constexpr int kRotationSteps = 4;
constexpr float kThinnest = 0.006f; // of an element, metres: skin that lies on its bone
constexpr float kFlattest = 0.2f;   // volume against rest volume, when its own is restored
constexpr double kLeastPull = 1e-3; // so that nothing floats

/// End of the bone that each joint moves, in the rest pose.
Vec3f bone_end(const Skeleton& s, Joint joint) {
    switch (joint) {
    case Joint::hips:
        return s.rest(Joint::spine);
    case Joint::spine:
        return s.rest(Joint::chest);
    case Joint::chest:
        return s.rest(Joint::upper_chest);
    case Joint::upper_chest:
        return s.rest(Joint::neck);
    case Joint::neck:
        return s.rest(Joint::head);
    case Joint::head:
        return s.rest(joint) + Vec3f(0.0f, 0.1f, 0.02f);
    case Joint::left_shoulder:
        return s.rest(Joint::left_upper_arm);
    case Joint::right_shoulder:
        return s.rest(Joint::right_upper_arm);
    case Joint::left_upper_arm:
        return s.rest(Joint::left_lower_arm);
    case Joint::right_upper_arm:
        return s.rest(Joint::right_lower_arm);
    case Joint::left_lower_arm:
        return s.rest(Joint::left_hand);
    case Joint::right_lower_arm:
        return s.rest(Joint::right_hand);
    case Joint::left_upper_leg:
        return s.rest(Joint::left_lower_leg);
    case Joint::right_upper_leg:
        return s.rest(Joint::right_lower_leg);
    case Joint::left_lower_leg:
        return s.rest(Joint::left_foot);
    case Joint::right_lower_leg:
        return s.rest(Joint::right_foot);
    case Joint::left_foot:
        return s.rest(Joint::left_toes);
    case Joint::right_foot:
        return s.rest(Joint::right_toes);
    case Joint::left_hand:
    case Joint::right_hand: {
        const Joint elbow = *joint_parent(joint);
        return s.rest(joint) + 0.15f * (s.rest(joint) - s.rest(elbow)).normalized();
    }
    case Joint::left_toes:
    case Joint::right_toes:
        return s.rest(joint) + Vec3f(0.0f, 0.0f, 0.05f);
    }
    return s.rest(joint);
}

Vec3f nearest_on_segment(const Vec3f& a, const Vec3f& b, const Vec3f& p) {
    const Vec3f d = b - a;
    const float t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-12f), 0.0f, 1.0f);
    return a + t * d;
}

/// A point deep in the flesh beneath each vertex.
std::vector<Vec3f> find_cores(const BodyModel& model, float depth) {
    std::vector<Vec3f> out;
    for (std::size_t v = 0; v < model.rest.positions.size(); ++v) {
        const Vec3f& p = model.rest.positions[v];
        Vec3f bone = Vec3f::Zero();
        for (std::size_t k = 0; k < 4; ++k) {
            const auto joint = static_cast<Joint>(model.skin.joints[v][k]);
            bone +=
                model.skin.weights[v][k] *
                nearest_on_segment(model.skeleton.rest(joint), bone_end(model.skeleton, joint), p);
        }
        out.push_back(p + depth * (bone - p));
    }
    return out;
}

} // namespace

Quatf nearest_rotation(const Mat3f& F, Quatf guess) noexcept {
    for (int i = 0; i < kRotationSteps; ++i) {
        const Mat3f R = guess.toRotationMatrix();
        const Vec3f turn =
            R.col(0).cross(F.col(0)) + R.col(1).cross(F.col(1)) + R.col(2).cross(F.col(2));
        const float agree =
            std::abs(R.col(0).dot(F.col(0)) + R.col(1).dot(F.col(1)) + R.col(2).dot(F.col(2)));
        const Vec3f w = turn / (agree + 1e-9f);
        guess = (from_rotation_vector(w) * guess).normalized();
        if (w.squaredNorm() < 1e-10f) break;
    }
    return guess;
}

void Flesh::add_element(const BodyModel& model, const Triangle& t,
                        const std::vector<Vec3f>& cores) {
    const auto& p = model.rest.positions;
    const Vec3f middle = (p[t[0]] + p[t[1]] + p[t[2]]) / 3.0f;
    const Vec3f cross = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
    const Vec3f normal = cross.normalized();
    Vec3f depth = middle - (cores[t[0]] + cores[t[1]] + cores[t[2]]) / 3.0f;
    // Skin that turns its back on the bone, or lies on it, is held by a core as deep as allowed.
    if (depth.dot(normal) < kThinnest) depth += (kThinnest - depth.dot(normal)) * normal;
    Mat3f D;
    D << p[t[1]] - p[t[0]], p[t[2]] - p[t[0]], depth;
    const Mat3f inverse = D.inverse();
    const Vec3f r1 = inverse.row(0), r2 = inverse.row(1), r3 = inverse.row(2);
    Element element;
    element.skin = t;
    element.slope = {Vec3f(r3 / 3.0f - r1 - r2), Vec3f(r3 / 3.0f + r1), Vec3f(r3 / 3.0f + r2)};
    element.core_slope = r3;
    element.stiffness = 0.5f * cross.norm() * depth.dot(normal);
    elements_.push_back(element);
}

Flesh::Flesh(const BodyModel& model, const FleshOptions& options)
    : options_(options), rest_(model.rest.positions), cores_(find_cores(model, options.core_depth)),
      skin_(model.skin) {
    for (const auto& t : model.rest.triangles)
        add_element(model, t, cores_);
    const auto n = static_cast<int>(rest_.size());
    const Eigen::VectorXd area =
        geometry::lumped_mass(rest_, model.rest.triangles, geometry::MassKind::barycentric);
    pull_.resize(n);
    for (int v = 0; v < n; ++v) {
        const auto& w = skin_.weights[static_cast<std::size_t>(v)];
        const auto held = static_cast<double>(held_by_one_bone(w));
        pull_[v] = options.bone_pull * area[v] * std::max(kLeastPull, held);
    }
    std::vector<Eigen::Triplet<double>> entries;
    const double stiffness = options.shape_stiffness + options.volume_stiffness;
    for (const auto& e : elements_)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                entries.emplace_back(
                    static_cast<int>(e.skin[i]), static_cast<int>(e.skin[j]),
                    stiffness * static_cast<double>(e.stiffness * e.slope[i].dot(e.slope[j])));
    for (int v = 0; v < n; ++v)
        entries.emplace_back(v, v, pull_[v]);
    Eigen::SparseMatrix<double> system(n, n);
    system.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(system);
    if (solver_.info() != Eigen::Success) throw Error("flesh: the system cannot be factored");
}

std::vector<Vec3f> Flesh::relax(const JointTransforms& skinning) const {
    const auto motions = to_dual_quaternions(skinning);
    const auto n = static_cast<int>(rest_.size());
    std::vector<Vec3f> out(rest_.size()), cores(rest_.size());
    std::vector<Quatf> turn(rest_.size());
    for (std::size_t v = 0; v < rest_.size(); ++v) {
        const RigidTransform motion = blend(motions, skin_.joints[v], skin_.weights[v]);
        out[v] = motion * rest_[v];
        cores[v] = motion * cores_[v];
        turn[v] = motion.rotation;
    }
    // The core of an element that was pushed down stays where its slopes put it: see add_element.
    std::vector<Vec3f> core(elements_.size());
    std::vector<Quatf> rotation(elements_.size());
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const Element& e = elements_[i];
        rotation[i] = turn[e.skin[0]];
        Vec3f rest_core = Vec3f::Zero(), posed_core = Vec3f::Zero(), rest_middle = Vec3f::Zero();
        for (const auto v : e.skin) {
            rest_core += cores_[v] / 3.0f;
            posed_core += cores[v] / 3.0f;
            rest_middle += rest_[v] / 3.0f;
        }
        // F is the identity at rest when the core lies at middle - depth; the pushed part of the
        // depth turns with the skin.
        const Vec3f depth = e.core_slope / e.core_slope.squaredNorm(); // across the triangle
        const Vec3f normal = depth.normalized();
        const float have = (rest_middle - rest_core).dot(normal);
        core[i] = posed_core;
        if (have < depth.norm() - 1e-6f) core[i] -= rotation[i] * ((depth.norm() - have) * normal);
    }
    Eigen::MatrixXd pulled(n, 3);
    for (int v = 0; v < n; ++v)
        pulled.row(v) = pull_[v] * out[static_cast<std::size_t>(v)].cast<double>().transpose();

    const auto shape = static_cast<float>(options_.shape_stiffness);
    const auto volume = static_cast<float>(options_.volume_stiffness);
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        Eigen::MatrixXd right = pulled;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const Element& e = elements_[i];
            Mat3f F = -core[i] * e.core_slope.transpose();
            for (std::size_t k = 0; k < 3; ++k)
                F += out[e.skin[k]] * e.slope[k].transpose();
            rotation[i] = nearest_rotation(F, rotation[i]);
            const float size = std::cbrt(std::max(F.determinant(), kFlattest));
            const Mat3f target = shape * rotation[i].toRotationMatrix() + volume / size * F +
                                 (shape + volume) * core[i] * e.core_slope.transpose();
            for (std::size_t k = 0; k < 3; ++k)
                right.row(static_cast<int>(e.skin[k])) +=
                    (e.stiffness * (target * e.slope[k])).cast<double>().transpose();
        }
        const Eigen::MatrixXd solved = solver_.solve(right);
        for (int v = 0; v < n; ++v)
            out[static_cast<std::size_t>(v)] = solved.row(v).cast<float>();
    }
    return out;
}

} // namespace toile::body
