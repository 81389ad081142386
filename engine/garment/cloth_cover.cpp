#include "garment/cloth_cover.h"

#include "geometry/nearest_surface.h"
#include "imaging/srgb.h"

#include <algorithm>
#include <cmath>

namespace toile::garment {
namespace {

constexpr float kOnFace = 0.015f;  // metres: such points tell the colour of skin
constexpr float kOffSkin = 0.015f; // farther from the body is no skin, whatever its colour
constexpr float kDark = 0.02f;     // added to light, so that noise of dark colours is no colour
constexpr float kLeastReach = 0.05f, kMostReach = 0.25f; // of the logarithms of light
constexpr float kShade = 0.35f;     // of a difference in brightness alone counts
constexpr std::size_t kFewest = 40; // points of a face
constexpr double kIsland = 0.012;   // of the area: smaller pieces are not believed
constexpr int kRounds = 6;          // of smoothing the seam

/// Hue twice and brightness, as logarithms.
Vec3f tone_of(const std::array<std::uint8_t, 4>& color) {
    std::array<float, 3> l{};
    for (std::size_t k = 0; k < 3; ++k)
        l[k] = std::log(imaging::linear_from_srgb(static_cast<float>(color[k]) / 255.0f) + kDark);
    return {l[0] - l[1], l[2] - l[1], kShade * (l[0] + l[1] + l[2]) / 3.0f};
}

float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Vec3f median(const std::vector<Vec3f>& rows) {
    Vec3f out;
    for (int k = 0; k < 3; ++k) {
        std::vector<float> one;
        one.reserve(rows.size());
        for (const Vec3f& row : rows)
            one.push_back(row[k]);
        out[k] = median(std::move(one));
    }
    return out;
}

/// Pieces of equal sign below a share of the area change sides.
void drop_islands(const geometry::TriangleMesh& mesh, std::vector<std::uint8_t>& cloth) {
    const auto around = geometry::vertex_adjacency(cloth.size(), mesh.triangles);
    std::vector<std::uint8_t> seen(cloth.size(), 0);
    const double least = kIsland * static_cast<double>(cloth.size());
    for (std::uint32_t seed = 0; seed < cloth.size(); ++seed) {
        if (seen[seed] != 0) continue;
        std::vector<std::uint32_t> piece = {seed};
        seen[seed] = 1;
        for (std::size_t at = 0; at < piece.size(); ++at)
            for (auto n = around.first[piece[at]]; n < around.first[piece[at] + 1]; ++n) {
                const std::uint32_t to = around.neighbours[n];
                if (seen[to] != 0 || cloth[to] != cloth[seed]) continue;
                seen[to] = 1;
                piece.push_back(to);
            }
        if (static_cast<double>(piece.size()) >= least) continue;
        for (const std::uint32_t v : piece)
            cloth[v] ^= 1;
    }
}

std::vector<float> smooth_seam(const geometry::TriangleMesh& mesh,
                               const std::vector<std::uint8_t>& cloth) {
    const auto around = geometry::vertex_adjacency(cloth.size(), mesh.triangles);
    std::vector<float> now(cloth.begin(), cloth.end()), next(now.size());
    for (int round = 0; round < kRounds; ++round) {
        for (std::size_t v = 0; v < now.size(); ++v) {
            float sum = now[v], count = 1.0f;
            for (auto n = around.first[v]; n < around.first[v + 1]; ++n)
                sum += now[around.neighbours[n]], count += 1.0f;
            next[v] = sum / count;
        }
        now.swap(next);
    }
    return now;
}

} // namespace

ClothCover find_cover(const CoverInput& input) {
    const geometry::TriangleMesh& scan = *input.scan;
    const geometry::NearestSurface skin(input.body->positions, input.body->triangles);
    ClothCover out;
    out.gaps.resize(scan.positions.size());
    std::vector<Vec3f> face;
    std::vector<std::uint8_t> on_face(scan.positions.size(), 0);
    for (std::size_t v = 0; v < scan.positions.size(); ++v) {
        const auto near = skin.nearest(scan.positions[v]);
        out.gaps[v] = near.signed_distance;
        if (input.colors.empty() || near.distance > kOnFace) continue;
        if (input.body_bare[input.body->triangles[near.triangle][0]] == 0) continue;
        face.push_back(tone_of(input.colors[v]));
        on_face[v] = 1;
    }
    out.by_color = face.size() >= kFewest;
    Vec3f tone = Vec3f::Zero();
    float reach = 0.0f;
    if (out.by_color) {
        tone = median(face);
        std::vector<float> off;
        off.reserve(face.size());
        for (const Vec3f& f : face)
            off.push_back((f - tone).norm());
        reach = std::clamp(3.0f * median(std::move(off)), kLeastReach, kMostReach);
        std::array<std::vector<float>, 3> light;
        for (std::size_t v = 0; v < scan.positions.size(); ++v)
            for (std::size_t k = 0; k < 3 && on_face[v] != 0; ++k)
                light[k].push_back(
                    imaging::linear_from_srgb(static_cast<float>(input.colors[v][k]) / 255.0f));
        for (std::size_t k = 0; k < 3; ++k)
            out.skin[k] = median(std::move(light[k]));
    }
    std::vector<std::uint8_t> cloth(scan.positions.size(), 0);
    for (std::size_t v = 0; v < cloth.size(); ++v) {
        const bool other = out.by_color && (tone_of(input.colors[v]) - tone).norm() > reach;
        cloth[v] = other || out.gaps[v] > kOffSkin ? 1 : 0;
    }
    drop_islands(scan, cloth);
    out.cloth = smooth_seam(scan, cloth);
    return out;
}

} // namespace toile::garment
