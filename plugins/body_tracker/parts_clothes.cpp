#include "body_tracker/parts_clothes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace toile::body_tracker {
namespace {

using body::Joint;

/// A sum of waves of 0.15 to 0.6 m, clipped to [0, 1].
class SmoothField {
  public:
    explicit SmoothField(std::uint64_t seed) {
        Random random(seed);
        for (Wave& wave : waves_) {
            Vec3f direction;
            for (float& value : direction)
                value = static_cast<float>(random.normal());
            const auto length = static_cast<float>(random.uniform(0.15, 0.6));
            wave.k = direction.normalized() * (2.0f * std::numbers::pi_v<float> / length);
            wave.phase = static_cast<float>(random.uniform(0.0, 2.0 * std::numbers::pi));
        }
    }
    [[nodiscard]] float at(const Vec3f& p) const {
        float sum = 0.0f;
        for (const Wave& wave : waves_)
            sum += std::sin(wave.k.dot(p) + wave.phase);
        return std::clamp(0.5f + 0.25f * sum, 0.0f, 1.0f);
    }

  private:
    struct Wave {
        Vec3f k;
        float phase;
    };
    std::array<Wave, 4> waves_;
};

enum class Cloth { none, top, bottom, head, neck };

Cloth cloth_of(PartLabel label, const Outfit& outfit) {
    switch (label) {
    case PartLabel::head:
        return Cloth::head;
    case PartLabel::neck:
        return Cloth::neck;
    case PartLabel::left_lower_arm:
    case PartLabel::right_lower_arm:
        return outfit.long_sleeves ? Cloth::top : Cloth::none;
    case PartLabel::left_pelvis:
    case PartLabel::right_pelvis:
    case PartLabel::left_thigh:
    case PartLabel::right_thigh:
        return Cloth::bottom;
    case PartLabel::left_shin:
    case PartLabel::right_shin:
        return outfit.long_legs ? Cloth::bottom : Cloth::none;
    case PartLabel::invalid:
    case PartLabel::left_hand:
    case PartLabel::right_hand:
    case PartLabel::left_foot:
    case PartLabel::right_foot:
        return Cloth::none;
    default:
        return Cloth::top;
    }
}

/// Hair grows on top and behind, not on the face.
float hair_share(const Vec3f& normal) {
    return std::clamp(0.3f + 0.8f * normal.y() - 0.7f * normal.z(), 0.0f, 1.0f);
}

void widen(const Outfit& outfit, const body::Skeleton& skeleton, const Vec3f& normal,
           Vec3f& position) {
    const Vec3f& hip = skeleton.rest(Joint::left_upper_leg);
    const float below = hip.y() - position.y();
    if (below < 0.0f || below > outfit.skirt_m) return;
    // Fades in over the first 10 cm; the legs' inner sides meet in the middle.
    const float share = std::min(below / 0.1f, 1.0f);
    const bool inner = normal.x() * position.x() < 0.0f;
    if (inner) position.x() *= 1.0f - 0.9f * share;
    const Vec3f outwards(inner ? 0.0f : position.x(), 0.0f, position.z() - hip.z());
    position += share * outfit.skirt_flare * below * outwards;
}

} // namespace

Outfit draw_outfit(Random& random) {
    Outfit out;
    // A square draws close clothes more often than wide ones.
    const auto loose = [&] {
        const double u = random.uniform();
        return static_cast<float>(0.05 * u * u);
    };
    if (random.uniform() < 0.85) out.top_m = loose();
    if (random.uniform() < 0.85) out.bottom_m = loose();
    out.long_sleeves = random.uniform() < 0.5;
    out.long_legs = random.uniform() < 0.7;
    if (random.uniform() < 0.15) {
        out.skirt_m = static_cast<float>(random.uniform(0.25, 0.85));
        out.skirt_flare = static_cast<float>(random.uniform(0.0, 1.2));
    }
    if (random.uniform() < 0.7) out.hair_m = static_cast<float>(random.uniform(0.005, 0.05));
    out.long_hair = out.hair_m > 0.0f && random.uniform() < 0.4;
    out.folds = random.next();
    return out;
}

void dress(const Outfit& outfit, const body::Skeleton& skeleton, std::span<const Vec3f> normals,
           std::span<const PartLabel> labels, std::span<Vec3f> positions) {
    const SmoothField field(outfit.folds);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3f& normal = normals[v];
        Vec3f& position = positions[v];
        switch (cloth_of(labels[v], outfit)) {
        case Cloth::top:
            position += outfit.top_m * field.at(position) * normal;
            break;
        case Cloth::bottom:
            position += outfit.bottom_m * field.at(position) * normal;
            break;
        case Cloth::head:
            position += outfit.hair_m * hair_share(normal) * normal;
            break;
        case Cloth::neck:
            if (outfit.long_hair) position += 1.5f * outfit.hair_m * hair_share(normal) * normal;
            break;
        case Cloth::none:
            break;
        }
        if (outfit.skirt_m > 0.0f &&
            (labels[v] == PartLabel::left_thigh || labels[v] == PartLabel::right_thigh ||
             labels[v] == PartLabel::left_shin || labels[v] == PartLabel::right_shin))
            widen(outfit, skeleton, normal, position);
    }
}

} // namespace toile::body_tracker
