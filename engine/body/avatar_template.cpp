#include "body/avatar_template.h"

#include "core/error.h"
#include "geometry/level_surface.h"
#include "geometry/remesh.h"
#include "geometry/surface_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr float kGridSpacing = 0.003f;
constexpr double kFingerSpread = 1.6; // in the template only, so that its fingers stay apart
constexpr std::array<const char*, 2> kSpreadFingers = {"armslegs/l-hand-fingers-distance-incr",
                                                       "armslegs/r-hand-fingers-distance-incr"};
constexpr float kHandReach = 0.26f;
constexpr float kFilledDistance = 0.0012f; // farther from the base surface: a filled cavity
constexpr double kCarrySmoothness = 0.35;  // everywhere, against the coarse quads of the base
constexpr double kFillSmoothness = 30.0;   // where nothing is followed

/// 0 below `from`, 1 above `to`, smooth between.
float ramp(float value, float from, float to) {
    const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// How far past the wrist a point is along the forearm (metres, negative before it, and where the
/// point is not near the hand at all).
float beyond_wrist(const Skeleton& s, const Vec3f& p) {
    const Vec3f q(std::abs(p.x()), p.y(), p.z());
    const Vec3f along = (s.rest(Joint::left_hand) - s.rest(Joint::left_lower_arm)).normalized();
    const Vec3f off = q - s.rest(Joint::left_hand);
    return off.norm() < kHandReach ? off.dot(along) : -kHandReach;
}

/// Closing radius: folds of the face, ears and toes vanish, fingers stay apart.
float closing_radius(const Skeleton& s, const Vec3f& p) {
    const float head = ramp(p.y(), s.rest(Joint::head).y() - 0.05f, s.rest(Joint::head).y());
    const float foot = 1.0f - ramp(p.y(), 0.05f, 0.09f);
    const Vec3f crotch(0.0f, s.rest(Joint::hips).y() - 0.09f, -0.03f);
    const Vec3f off = (p - crotch).cwiseProduct(Vec3f(1.0f, 0.6f, 0.8f));
    const float cleft = 1.0f - ramp(off.norm(), 0.06f, 0.13f);
    return 0.0045f + 0.0025f * head + 0.0025f * foot + 0.0095f * cleft;
}

/// Wanted edge length: finer on hands, feet and face.
float edge_length(const Skeleton& s, const Vec3f& p) {
    const float wrist = beyond_wrist(s, p);
    const float hand = ramp(wrist, -0.05f, 0.03f), finger = ramp(wrist, 0.05f, 0.10f);
    const float head =
        ramp(p.y(), s.rest(Joint::head).y() - 0.04f, s.rest(Joint::head).y() + 0.03f);
    const float face = head * ramp(p.z(), 0.02f, 0.09f);
    const float foot = 1.0f - ramp(p.y(), 0.05f, 0.13f);
    const float toes = foot * ramp(p.z(), s.rest(Joint::left_toes).z() - 0.03f,
                                   s.rest(Joint::left_toes).z() + 0.02f);
    return 0.0142f - 0.0072f * hand - 0.0014f * finger - 0.0045f * head - 0.0015f * face -
           0.0045f * foot - 0.0020f * toes;
}

std::vector<SurfacePoint> bind(const geometry::TriangleMesh& mesh, std::size_t half,
                               const geometry::TriangleMesh& base) {
    const geometry::SurfaceProbe nearest(base.positions, base.triangles);
    std::vector<SurfacePoint> out(half);
    for (std::size_t v = 0; v < half; ++v) {
        const auto hit = nearest.nearest(mesh.positions[v]);
        const Triangle& t = base.triangles[hit.triangle];
        const Vec3f normal = (base.positions[t[1]] - base.positions[t[0]])
                                 .cross(base.positions[t[2]] - base.positions[t[0]])
                                 .normalized();
        const bool facing = mesh.normals[v].dot(normal) > 0.5f;
        const bool near = hit.distance < kFilledDistance;
        out[v] = {t, hit.barycentric, facing && near ? 1.0f : 0.0f};
    }
    return out;
}

} // namespace

ShapeRecipe template_recipe() {
    ShapeRecipe out = adult_recipe(0.5);
    for (const char* target : kSpreadFingers)
        out[target] = kFingerSpread;
    return out;
}

BaseShape template_shape(const MakeHumanData& data) {
    return make_base_shape(data, template_recipe());
}

AvatarTemplate make_avatar_template(const MakeHumanData& data, float coarseness) {
    const BaseShape shape = template_shape(data);
    AvatarTemplate out;
    out.skeleton = shape.skeleton;
    std::vector<Quad> quads = data.body;
    quads.insert(quads.end(), data.eyes.begin(), data.eyes.end());
    out.refinement = geometry::catmull_clark(data.positions.size(), quads);
    out.base = geometry::refine(out.refinement, shape.positions);
    const geometry::TriangleMesh base = {out.base, {}, out.refinement.triangles};

    // The helpers' vertices are not part of the surface; only triangles count below.
    geometry::TriangleMesh used;
    std::vector<std::uint32_t> index(base.positions.size(), 0xffffffffu);
    for (auto t : base.triangles) {
        for (auto& v : t) {
            if (index[v] == 0xffffffffu) {
                index[v] = static_cast<std::uint32_t>(used.positions.size());
                used.positions.push_back(base.positions[v]);
            }
            v = index[v];
        }
        used.triangles.push_back(t);
    }
    const geometry::TriangleMesh outer =
        geometry::closed_outer_surface(used, coarseness * kGridSpacing, [&](const Vec3f& p) {
            return closing_radius(shape.skeleton, p);
        });
    const geometry::SurfaceProbe nearest(outer.positions, outer.triangles);
    geometry::RemeshOptions options;
    options.border_on_x0 = true;
    options.edge_length = [&](const Vec3f& p) {
        return coarseness * edge_length(shape.skeleton, p);
    };
    options.project = [&](const Vec3f& p) { return nearest.nearest(p).point; };
    const auto half = geometry::remesh(geometry::clip_to_left_half(outer), options);
    out.half = half.positions.size();
    out.mesh = geometry::mirror_and_weld(half, out.mirror_of);
    if (2 * out.mesh.positions.size() != out.mesh.triangles.size() + 4)
        throw Error("the template has a handle: some limbs or fingers grew together");
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    out.points = bind(out.mesh, out.half, base);
    return out;
}

Eigen::SparseMatrix<double> half_laplacian(const AvatarTemplate& avatar, bool odd) {
    const auto rings =
        geometry::vertex_adjacency(avatar.mesh.positions.size(), avatar.mesh.triangles);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::uint32_t v = 0; v < avatar.half; ++v) {
        const auto first = rings.first[v], last = rings.first[v + 1];
        entries.emplace_back(static_cast<int>(v), static_cast<int>(v), 1.0);
        for (auto i = first; i < last; ++i) {
            const auto w = rings.neighbours[i];
            const bool mirrored = w >= avatar.half;
            entries.emplace_back(
                static_cast<int>(v), static_cast<int>(mirrored ? avatar.mirror_of[w] : w),
                (mirrored && odd ? 1.0 : -1.0) / static_cast<double>(last - first));
        }
    }
    const auto n = static_cast<int>(avatar.half);
    Eigen::SparseMatrix<double> out(n, n);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
}

ShapeCarrier::ShapeCarrier(const AvatarTemplate& avatar, std::span<const float> smoothness)
    : avatar_(avatar), follow_(static_cast<int>(avatar.half)) {
    // min sum f |D - D0|^2 + s |L D|^2 over each coordinate of the displacements D.
    Eigen::VectorXd smooth(follow_.size());
    for (int v = 0; v < follow_.size(); ++v) {
        const auto i = static_cast<std::size_t>(v);
        follow_[v] = avatar.points[i].trust > 0.0f ? 1.0 : 1.0 / kFillSmoothness;
        smooth[v] = kCarrySmoothness + static_cast<double>(smoothness[i]);
    }
    for (const bool odd : {true, false}) {
        const Eigen::SparseMatrix<double> laplacian = half_laplacian(avatar, odd);
        Eigen::SparseMatrix<double> system =
            laplacian.transpose() * smooth.asDiagonal() * laplacian;
        system += Eigen::SparseMatrix<double>(follow_.asDiagonal());
        Solver& solver = odd ? odd_ : even_;
        solver.compute(system);
        if (solver.info() != Eigen::Success) throw Error("carrying shapes: the solver failed");
    }
}

Eigen::MatrixXd ShapeCarrier::follow(std::span<const Vec3f> refined_offsets) const {
    const auto n = static_cast<int>(avatar_.half);
    Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(n, 3);
    for (int v = 0; v < n; ++v) {
        const auto& point = avatar_.points[static_cast<std::size_t>(v)];
        Vec3f d = Vec3f::Zero();
        for (int k = 0; k < 3; ++k)
            d += point.barycentric[k] * refined_offsets[point.corners[static_cast<std::size_t>(k)]];
        displacement.row(v) = follow_[v] * d.cast<double>();
    }
    for (int k = 0; k < 3; ++k)
        displacement.col(k) = (k == 0 ? odd_ : even_).solve(displacement.col(k).eval()).eval();
    for (std::size_t v = 0; v < avatar_.half; ++v)
        if (avatar_.mirror_of[v] == v) displacement(static_cast<int>(v), 0) = 0.0;
    return displacement;
}

Eigen::MatrixXd ShapeCarrier::carry_offsets(std::span<const Vec3f> offsets) const {
    return follow(geometry::refine(avatar_.refinement, offsets));
}

std::vector<Vec3f> ShapeCarrier::carry(const BaseShape& shape) const {
    auto refined = geometry::refine(avatar_.refinement, shape.positions);
    for (std::size_t v = 0; v < refined.size(); ++v)
        refined[v] -= avatar_.base[v];
    const Eigen::MatrixXd displacement = follow(refined);

    std::vector<Vec3f> out(avatar_.mesh.positions.size());
    float floor = std::numeric_limits<float>::max();
    for (std::size_t v = 0; v < avatar_.half; ++v) {
        const Vec3f p = avatar_.mesh.positions[v] +
                        Vec3f(displacement.row(static_cast<int>(v)).cast<float>().transpose());
        const auto m = avatar_.mirror_of[v];
        out[v] = p;
        if (m == v)
            out[v].x() = 0.0f;
        else
            out[m] = Vec3f(-p.x(), p.y(), p.z());
        floor = std::min(floor, p.y());
    }
    for (auto& p : out)
        p.y() -= floor;
    return out;
}

} // namespace toile::body
