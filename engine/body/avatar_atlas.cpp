#include "body/avatar_atlas.h"

#include "core/error.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>

namespace toile::body {
namespace {

/// Regions of charts; each has a front (even) and a back (odd chart).
enum Region {
    kHead,
    kTrunk,
    kLeftArm,
    kRightArm,
    kLeftHand,
    kRightHand,
    kLeftLeg,
    kRightLeg,
    kLeftFoot,
    kRightFoot,
    kRegions
};

constexpr int kSideSmoothing = 12; // steps on the front-back field, for smooth seams
constexpr int kHandSmoothing = 3;

Region region_of(Joint joint) {
    switch (joint) {
    case Joint::neck:
    case Joint::head:
        return kHead;
    case Joint::left_upper_arm:
    case Joint::left_lower_arm:
        return kLeftArm;
    case Joint::right_upper_arm:
    case Joint::right_lower_arm:
        return kRightArm;
    case Joint::left_hand:
        return kLeftHand;
    case Joint::right_hand:
        return kRightHand;
    case Joint::left_upper_leg:
    case Joint::left_lower_leg:
        return kLeftLeg;
    case Joint::right_upper_leg:
    case Joint::right_lower_leg:
        return kRightLeg;
    case Joint::left_foot:
    case Joint::left_toes:
        return kLeftFoot;
    case Joint::right_foot:
    case Joint::right_toes:
        return kRightFoot;
    default:
        return kTrunk;
    }
}

/// The region of a triangle: that with the greatest weight at its corners.
Region region_of(const SkinWeights& skin, const Triangle& t) {
    std::array<float, kRegions> sums{};
    for (const auto v : t)
        for (std::size_t k = 0; k < 4; ++k)
            sums[region_of(static_cast<Joint>(skin.joints[v][k]))] += skin.weights[v][k];
    return static_cast<Region>(std::max_element(sums.begin(), sums.end()) - sums.begin());
}

/// Front-back field of one region at a vertex: how much it faces `direction`.
Vec3f facing(Region region, const Vec3f& palm) {
    switch (region) {
    case kLeftHand:
        return palm;
    case kRightHand:
        return Vec3f(-palm.x(), palm.y(), palm.z());
    case kLeftFoot:
    case kRightFoot:
        return Vec3f(0.0f, 1.0f, 0.35f).normalized();
    default:
        return Vec3f::UnitZ();
    }
}

/// The direction in which the back of the left hand faces: the flattest axis of the hand.
Vec3f back_of_hand(const AvatarTemplate& avatar, const SkinWeights& skin) {
    std::vector<Vec3f> points;
    Vec3f mean = Vec3f::Zero();
    for (std::size_t v = 0; v < avatar.mesh.positions.size(); ++v)
        if (skin.joints[v][0] == static_cast<std::uint16_t>(Joint::left_hand)) {
            points.push_back(avatar.mesh.positions[v]);
            mean += points.back();
        }
    mean /= static_cast<float>(points.size());
    Mat3f covariance = Mat3f::Zero();
    for (const auto& p : points)
        covariance += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3f> solver(covariance);
    const Vec3f axis = solver.eigenvectors().col(0);
    return axis.x() < 0.0f ? Vec3f(-axis) : axis;
}

/// Normals smoothed along the surface, so that the line where they turn away is smooth.
std::vector<Vec3f> smooth_normals(const AvatarTemplate& avatar, int steps) {
    const auto rings =
        geometry::vertex_adjacency(avatar.mesh.positions.size(), avatar.mesh.triangles);
    std::vector<Vec3f> normals = avatar.mesh.normals, next(normals.size());
    for (int step = 0; step < steps; ++step) {
        for (std::size_t v = 0; v < normals.size(); ++v) {
            Vec3f sum = normals[v];
            for (auto i = rings.first[v]; i < rings.first[v + 1]; ++i)
                sum += normals[rings.neighbours[i]];
            next[v] = sum / static_cast<float>(rings.first[v + 1] - rings.first[v] + 1);
        }
        normals.swap(next);
    }
    return normals;
}

/// Triangles across each edge of each triangle. (nf)
std::vector<std::array<std::uint32_t, 3>> neighbours(std::span<const Triangle> triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_of;
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            face_of[{triangles[f][k], triangles[f][(k + 1) % 3]}] = f;
    std::vector<std::array<std::uint32_t, 3>> out(triangles.size());
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            out[f][k] = face_of.at({triangles[f][(k + 1) % 3], triangles[f][k]});
    return out;
}

/// Gives every piece of a chart but its largest to the neighbour it borders most.
void keep_largest_pieces(std::span<const Triangle> triangles, std::vector<int>& charts) {
    const auto across = neighbours(triangles);
    for (int round = 0; round < 20; ++round) {
        std::vector<int> piece(triangles.size(), -1);
        std::vector<std::vector<std::uint32_t>> pieces;
        for (std::uint32_t f = 0; f < triangles.size(); ++f) {
            if (piece[f] >= 0) continue;
            std::vector<std::uint32_t> members = {f};
            piece[f] = static_cast<int>(pieces.size());
            for (std::size_t i = 0; i < members.size(); ++i)
                for (const auto g : across[members[i]])
                    if (piece[g] < 0 && charts[g] == charts[f]) {
                        piece[g] = piece[f];
                        members.push_back(g);
                    }
            pieces.push_back(std::move(members));
        }
        std::map<int, std::size_t> largest;
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            const auto [found, added] = largest.try_emplace(charts[pieces[p][0]], p);
            if (!added && pieces[p].size() > pieces[found->second].size()) found->second = p;
        }
        bool changed = false;
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            const int chart = charts[pieces[p][0]];
            if (largest.at(chart) == p) continue;
            std::map<int, int> borders;
            for (const auto f : pieces[p])
                for (const auto g : across[f])
                    if (charts[g] != chart) ++borders[charts[g]];
            const auto best =
                std::max_element(borders.begin(), borders.end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; });
            for (const auto f : pieces[p])
                charts[f] = best->first;
            changed = true;
        }
        if (!changed) return;
    }
}

/// Moves triangles with two sides on another chart over to it: seams without teeth.
void smooth_seams(std::span<const Triangle> triangles, std::vector<int>& charts) {
    const auto across = neighbours(triangles);
    for (int round = 0; round < 3; ++round)
        for (std::uint32_t f = 0; f < triangles.size(); ++f) {
            const auto& n = across[f];
            for (std::size_t k = 0; k < 3; ++k)
                if (charts[n[k]] != charts[f] && charts[n[k]] == charts[n[(k + 1) % 3]])
                    charts[f] = charts[n[k]];
        }
}

} // namespace

std::vector<int> make_charts(const AvatarTemplate& avatar, const SkinWeights& skin) {
    const auto normals = smooth_normals(avatar, kSideSmoothing);
    const auto hand_normals = smooth_normals(avatar, kHandSmoothing);
    const Vec3f palm = back_of_hand(avatar, skin);
    std::vector<int> out;
    for (const auto& t : avatar.mesh.triangles) {
        const Region region = region_of(skin, t);
        const bool hand = region == kLeftHand || region == kRightHand;
        const auto& field = hand ? hand_normals : normals;
        const Vec3f direction = facing(region, palm);
        float side = 0.0f;
        for (const auto v : t)
            side += field[v].dot(direction);
        out.push_back(2 * static_cast<int>(region) + (side >= 0.0f ? 0 : 1));
    }
    keep_largest_pieces(avatar.mesh.triangles, out);
    smooth_seams(avatar.mesh.triangles, out);
    keep_largest_pieces(avatar.mesh.triangles, out);
    return out;
}

} // namespace toile::body
