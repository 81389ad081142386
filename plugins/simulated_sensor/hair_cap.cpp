#include "simulated_sensor/hair_cap.h"

#include "core/error.h"

#include <algorithm>

namespace toile::simulated_sensor {
namespace {

/// Hair grows above a plane through the head's middle that rises towards the face.
const Vec3f kCrown = Vec3f(0.0f, 0.72f, -0.69f).normalized();
constexpr float kHairline =
    0.1f;                        // of the head's height: the plane stands this far above its middle
constexpr float kFullAt = 0.35f; // and the hair is at its thickest this far above the plane
constexpr float kLeast_m = 0.002f;

struct Head {
    Vec3f middle;
    float height;
};

Head find_head(std::span<const Vec3f> positions, std::span<const body::Part> parts) {
    Eigen::AlignedBox3f box;
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (parts[v] == body::Part::head) box.extend(positions[v]);
    if (box.isEmpty()) throw Error("hair: the body has no vertices labelled 'head'");
    return {box.center(), box.sizes().y()};
}

} // namespace

HairCap::HairCap(const HairSettings& settings, std::span<const Vec3f> positions,
                 std::span<const Triangle> triangles, std::span<const body::Part> parts) {
    const Head head = find_head(positions, parts);
    const auto above = [&](std::uint32_t v) { // share of the way to full thickness; <= 0: bare
        if (parts[v] != body::Part::head && parts[v] != body::Part::neck) return -1.0f;
        return (kCrown.dot(positions[v] - head.middle) / head.height - kHairline) / kFullAt;
    };
    std::vector<std::uint32_t> number(positions.size(), UINT32_MAX);
    for (const Triangle& t : triangles) {
        if (!std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return above(v) > 0.0f; }))
            continue;
        Triangle mine{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& n = number[t[k]];
            if (n == UINT32_MAX) {
                n = static_cast<std::uint32_t>(vertices_.size());
                vertices_.push_back(t[k]);
                const float share = std::min(1.0f, above(t[k]));
                thickness_.push_back(kLeast_m + share * (2.0f - share) * settings.thickness_m);
                surface_.rest.push_back(positions[t[k]]);
            }
            mine[k] = n;
        }
        surface_.triangles.push_back(mine);
    }
    if (vertices_.empty()) throw Error("hair: the body's head has no scalp");
    surface_.name = "hair";
    surface_.look = {settings.color, nullptr, Grain::hair};
    posed_.resize(vertices_.size());
}

std::span<const Vec3f> HairCap::pose(std::span<const Vec3f> positions,
                                     std::span<const Vec3f> normals) {
    for (std::size_t i = 0; i < vertices_.size(); ++i)
        posed_[i] = positions[vertices_[i]] + thickness_[i] * normals[vertices_[i]];
    return posed_;
}

} // namespace toile::simulated_sensor
