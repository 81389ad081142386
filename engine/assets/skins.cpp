#include "assets/skins.h"

#include "core/error.h"
#include "core/log.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace toile::assets {
namespace {

std::string quoted(const std::string& name, std::size_t index) {
    return name.empty() ? "#" + std::to_string(index) : "'" + name + "'";
}

void check_nodes(const Scene& scene, const std::string& file) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.parent < kNone || node.parent >= static_cast<int>(i))
            throw FileError(file, "node " + quoted(node.name, i) +
                                      " does not come after its parent (a cycle of joints?)");
        if (node.mesh < kNone || node.mesh >= static_cast<int>(scene.meshes.size()))
            throw FileError(file, "node " + quoted(node.name, i) + " names a missing mesh");
        if (node.skin < kNone || node.skin >= static_cast<int>(scene.skins.size()))
            throw FileError(file, "node " + quoted(node.name, i) + " names a missing skin");
    }
}

void check_skin(const Scene& scene, const Skin& skin, std::size_t index, const std::string& file) {
    const std::string name = "skin " + quoted(skin.name, index);
    if (skin.joints.empty()) throw FileError(file, name + " has no joints");
    if (skin.inverse_bind.size() != skin.joints.size())
        throw FileError(file, name + " has " + std::to_string(skin.joints.size()) + " joints but " +
                                  std::to_string(skin.inverse_bind.size()) +
                                  " inverse bind matrices");
    std::set<int> seen;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const int node = skin.joints[j];
        if (node < 0 || node >= static_cast<int>(scene.nodes.size()))
            throw FileError(file, name + " names joint node " + std::to_string(node) +
                                      ", which is out of range");
        const std::string joint = quoted(scene.nodes[static_cast<std::size_t>(node)].name,
                                         static_cast<std::size_t>(node));
        if (!seen.insert(node).second)
            throw FileError(file, name + " names the joint " + joint + " twice");
        const Eigen::Matrix4f& m = skin.inverse_bind[j];
        const Eigen::RowVector4f last = m.row(3);
        if (!m.allFinite() || !last.isApprox(Eigen::RowVector4f(0, 0, 0, 1), 1e-4f))
            throw FileError(file, name + ": the inverse bind matrix of joint " + joint +
                                      " is not an affine motion");
        if (std::abs(m.topLeftCorner<3, 3>().determinant()) < 1e-12f)
            throw FileError(file, name + ": the inverse bind matrix of joint " + joint +
                                      " cannot be inverted");
    }
}

// Returns whether the row had to be scaled.
bool check_row(std::array<std::uint16_t, 4>& joints, std::array<float, 4>& weights,
               std::size_t joint_count, double tolerance, const std::string& where) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const float w = weights[k];
        if (!std::isfinite(w)) throw Error(where + ": a weight is not finite");
        if (w < 0.0f) throw Error(where + ": a weight is negative (" + std::to_string(w) + ")");
        if (w == 0.0f) joints[k] = 0;
        if (joints[k] >= joint_count)
            throw Error(where + ": names joint " + std::to_string(joints[k]) + " of " +
                        std::to_string(joint_count));
        sum += static_cast<double>(w);
    }
    if (sum <= 0.0) throw Error(where + ": all weights are zero");
    if (std::abs(sum - 1.0) > tolerance)
        throw Error(where + ": weights sum to " + std::to_string(sum) + " instead of 1");
    if (std::abs(sum - 1.0) <= 2e-7) return false; // rounding of four floats
    for (float& w : weights)
        w = static_cast<float>(static_cast<double>(w) / sum);
    return true;
}

void check_primitive(Primitive& primitive, std::size_t joint_count, const std::string& where,
                     double tolerance, std::size_t& renormalised) {
    const std::size_t count = primitive.positions.size();
    if (primitive.joints.size() != count || primitive.weights.size() != count)
        throw Error(where + ": " + std::to_string(primitive.weights.size()) +
                    " rows of weights for " + std::to_string(count) + " vertices");
    for (std::size_t v = 0; v < count; ++v)
        if (check_row(primitive.joints[v], primitive.weights[v], joint_count, tolerance,
                      where + ", vertex " + std::to_string(v)))
            ++renormalised;
}

} // namespace

void check_skins(Scene& scene, const std::string& file, const SkinRules& rules) {
    check_nodes(scene, file);
    for (std::size_t i = 0; i < scene.skins.size(); ++i)
        check_skin(scene, scene.skins[i], i, file);

    // A mesh may be used with several skins; its joints must be good for the smallest of them.
    std::vector<std::size_t> joint_counts(scene.meshes.size(), 0);
    for (const Node& node : scene.nodes) {
        if (node.mesh == kNone || node.skin == kNone) continue;
        std::size_t& count = joint_counts[static_cast<std::size_t>(node.mesh)];
        const std::size_t joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        count = count == 0 ? joints : std::min(count, joints);
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        std::size_t renormalised = 0;
        Mesh& mesh = scene.meshes[m];
        for (Primitive& primitive : mesh.primitives) {
            if (joint_counts[m] == 0) {
                primitive.joints.clear();
                primitive.weights.clear();
                continue;
            }
            check_primitive(primitive, joint_counts[m], file + ": mesh " + quoted(mesh.name, m),
                            rules.sum_tolerance, renormalised);
        }
        if (renormalised > 0)
            log::debug(file + ": mesh " + quoted(mesh.name, m) + ": weights of " +
                       std::to_string(renormalised) + " vertices scaled to sum to 1");
    }
}

void keep_four(std::vector<Influence>& influences, std::array<std::uint16_t, 4>& joints,
               std::array<float, 4>& weights) {
    std::stable_sort(influences.begin(), influences.end(),
                     [](const Influence& a, const Influence& b) {
                         return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
                     });
    double all = 0.0;
    for (const Influence& i : influences)
        all += static_cast<double>(i.weight);
    double kept = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const bool used = k < influences.size() && influences[k].weight > 0.0f;
        joints[k] = used ? influences[k].joint : std::uint16_t{0};
        weights[k] = used ? influences[k].weight : 0.0f;
        kept += static_cast<double>(weights[k]);
    }
    if (influences.size() <= 4 || kept <= 0.0) return;
    for (float& w : weights)
        w = static_cast<float>(static_cast<double>(w) * all / kept);
}

std::vector<Eigen::Matrix4f> node_transforms(const Scene& scene) {
    std::vector<Eigen::Matrix4f> world(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        Eigen::Affine3f local = Eigen::Affine3f::Identity();
        local.translate(node.translation).rotate(node.rotation).scale(node.scale);
        world[i] = local.matrix();
        if (node.parent != kNone)
            world[i] = (world[static_cast<std::size_t>(node.parent)] * world[i]).eval();
    }
    return world;
}

std::vector<Vec3f> skinned_positions(const Primitive& primitive, const Skin& skin,
                                     const std::vector<Eigen::Matrix4f>& world_from_node) {
    std::vector<Eigen::Matrix4f> world_from_rest(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
        world_from_rest[j] =
            world_from_node[static_cast<std::size_t>(skin.joints[j])] * skin.inverse_bind[j];
    std::vector<Vec3f> posed(primitive.positions.size(), Vec3f::Zero());
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const Vec4f p = primitive.positions[v].homogeneous();
        for (std::size_t k = 0; k < 4; ++k)
            posed[v] +=
                primitive.weights[v][k] * (world_from_rest[primitive.joints[v][k]] * p).head<3>();
    }
    return posed;
}

} // namespace toile::assets
