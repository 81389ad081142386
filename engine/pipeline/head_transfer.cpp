#include "pipeline/head_transfer.h"

#include "core/error.h"
#include "geometry/cut.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::pipeline {
namespace {

constexpr float kReach = 0.25f;  // metres about the neck's axis: a head is within
constexpr float kBlend = 0.06f;  // metres above the cut over which the rim goes over
constexpr float kStrip = 0.004f; // metres between the two rims
constexpr float kMostWiden = 1.8f;
constexpr std::size_t kAngles = 90;

using geometry::CutMesh;

struct Piece {
    CutMesh cut;
    std::vector<assets::Rgba8> colors;
    std::vector<std::uint32_t> rim; ///< vertices around the neck
    Vec3f middle = Vec3f::Zero();   ///< of the rim
};

Vec3f middle_of(const std::vector<Vec3f>& positions, const std::vector<std::uint32_t>& ring) {
    Vec3f sum = Vec3f::Zero();
    float length = 0.0f;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3f& a = positions[ring[i]];
        const Vec3f& b = positions[ring[(i + 1) % ring.size()]];
        sum += (b - a).norm() * 0.5f * (a + b);
        length += (b - a).norm();
    }
    return sum / std::max(length, 1e-9f);
}

void close(const std::vector<std::uint32_t>& ring, Piece& out) {
    for (std::size_t i = 2; i < ring.size(); ++i)
        out.cut.mesh.triangles.push_back({ring[0], ring[i - 1], ring[i]});
}

/// What lies above (sign 1) or below (-1) the level through the neck; away from it, all or none.
Piece piece_of(const Necked& of, float sign, float height, const char* whose) {
    const auto& mesh = of.surface->mesh;
    std::vector<float> field;
    field.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) {
        const float above = p.y() - height;
        const float away = Vec2f(p.x() - of.neck.x(), p.z() - of.neck.z()).norm() - kReach;
        field.push_back(sign * std::min(above, -away));
    }
    Piece out;
    out.cut = geometry::cut_where(mesh, field);
    for (const auto& from : out.cut.from) {
        assets::Rgba8 color = {200, 200, 200, 255};
        for (std::size_t k = 0; k < 4 && !of.surface->colors.empty(); ++k) {
            const float a = of.surface->colors[from.a][k], b = of.surface->colors[from.b][k];
            color[k] = static_cast<std::uint8_t>(std::lround(a + from.share * (b - a)));
        }
        out.colors.push_back(color);
    }
    for (const auto& ring : geometry::rims(out.cut.mesh)) {
        const Vec3f middle = middle_of(out.cut.mesh.positions, ring);
        const bool level = std::abs(middle.y() - height) < 0.01f;
        const bool near = Vec2f(middle.x() - of.neck.x(), middle.z() - of.neck.z()).norm() < 0.1f;
        if (out.rim.empty() && level && near && ring.size() >= 8) {
            out.rim = ring;
            out.middle = middle;
        } else if (level) {
            close(ring, out); // a throat within the neck, a fold of a collar
        }
    }
    if (!out.rim.empty()) return out;
    throw Error(std::string("no neck was found to cut ") + whose + "'s scan at");
}

/// How far a rim reaches in each direction about its middle.
class RimRadius {
  public:
    RimRadius(const std::vector<Vec3f>& positions, const Piece& piece) {
        std::vector<float> sums(kAngles, 0.0f), counts(kAngles, 0.0f);
        for (std::size_t i = 0; i < piece.rim.size(); ++i)
            for (int step = 0; step < 8;
                 ++step) { // along the sides, so that no direction is missed
                const float t = static_cast<float>(step) / 8.0f;
                const Vec3f p = (1.0f - t) * positions[piece.rim[i]] +
                                t * positions[piece.rim[(i + 1) % piece.rim.size()]] - piece.middle;
                const std::size_t at = slot(p);
                sums[at] += Vec2f(p.x(), p.z()).norm();
                counts[at] += 1.0f;
            }
        for (std::size_t i = 0; i < kAngles; ++i)
            radii_.push_back(counts[i] > 0.0f ? sums[i] / counts[i] : 0.0f);
        for (std::size_t i = 0; i < kAngles; ++i)
            for (std::size_t k = 1; radii_[i] <= 0.0f && k < kAngles; ++k)
                radii_[i] = std::max(radii_[(i + k) % kAngles], 0.0f);
    }
    [[nodiscard]] float at(const Vec3f& from_middle) const {
        const float turn = place(from_middle);
        const auto low = static_cast<std::size_t>(turn) % kAngles;
        const float share = turn - std::floor(turn);
        return (1.0f - share) * radii_[low] + share * radii_[(low + 1) % kAngles];
    }

  private:
    static float place(const Vec3f& p) {
        const float turn = std::atan2(p.x(), p.z()) / (2.0f * std::numbers::pi_v<float>);
        return (turn + 1.0f) * static_cast<float>(kAngles);
    }
    static std::size_t slot(const Vec3f& p) {
        return static_cast<std::size_t>(std::lround(place(p))) % kAngles;
    }
    std::vector<float> radii_;
};

/// Draws the head's rim to the body's; `head` already stands where it belongs.
void match_rims(const Piece& body, Piece& head, std::vector<Vec3f>& positions) {
    const RimRadius wanted(body.cut.mesh.positions, body), has(positions, head);
    for (Vec3f& p : positions) {
        const float up = (p.y() - head.middle.y()) / kBlend;
        if (up >= 1.0f) continue;
        const float share = 1.0f - up * up * (3.0f - 2.0f * up);
        const Vec3f from(p.x() - head.middle.x(), 0.0f, p.z() - head.middle.z());
        const float factor = std::clamp(wanted.at(from) / std::max(has.at(from), 0.01f),
                                        1.0f / kMostWiden, kMostWiden);
        p += share * (factor - 1.0f) * from;
    }
}

} // namespace

assets::ColoredMesh transfer_head(const Necked& body, const Necked& head) {
    const Piece below = piece_of(body, -1.0f, body.neck.y(), "the mannequin");
    Piece above = piece_of(head, 1.0f, head.neck.y() + kStrip, "the customer");
    // P3 eq. 9: X = X_m - (O1 - O2).
    const Vec3f shift = below.middle + Vec3f(0.0f, kStrip, 0.0f) - above.middle;
    for (Vec3f& p : above.cut.mesh.positions)
        p += shift;
    above.middle += shift;
    match_rims(below, above, above.cut.mesh.positions);
    assets::ColoredMesh out;
    out.mesh.positions = below.cut.mesh.positions;
    out.mesh.triangles = below.cut.mesh.triangles;
    out.colors = below.colors;
    const auto base = static_cast<std::uint32_t>(out.mesh.positions.size());
    out.mesh.positions.insert(out.mesh.positions.end(), above.cut.mesh.positions.begin(),
                              above.cut.mesh.positions.end());
    out.colors.insert(out.colors.end(), above.colors.begin(), above.colors.end());
    for (const Triangle& t : above.cut.mesh.triangles)
        out.mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    std::vector<std::uint32_t> upper = above.rim;
    for (std::uint32_t& v : upper)
        v += base;
    const auto seam = geometry::sew_rims(out.mesh.positions, below.rim, upper, below.middle);
    out.mesh.triangles.insert(out.mesh.triangles.end(), seam.begin(), seam.end());
    out.mesh.normals.resize(out.mesh.positions.size());
    geometry::vertex_normals(out.mesh.positions, out.mesh.triangles, out.mesh.normals);
    return out;
}

} // namespace toile::pipeline
