// Texture coordinates of our own for the template, and the base layer painted on it.
#pragma once

#include "body/avatar_anatomy.h"
#include "imaging/image.h"

namespace toile::body {

/// Charts of the template: head, trunk, arms, hands, legs and feet, each a front and a back that
/// meet along its sides. (nf) chart numbers, 0 to 19; every chart is a disc.
[[nodiscard]] std::vector<int> make_charts(const AvatarTemplate& avatar, const SkinWeights& skin);

/// Tones of one avatar, sRGB.
struct AvatarTones {
    std::array<std::uint8_t, 3> skin{}, layer{};
};

/// A square texture of `texels` a side: matte skin, and a fitted one-piece from the neckline to
/// mid-thigh with its hems, drawn from the template's shape so that edges are smooth. Charts bleed
/// into the gaps between them.
[[nodiscard]] imaging::Image paint_base_layer(const AvatarTemplate& avatar,
                                              const geometry::SeamedLayout& layout,
                                              const AvatarTones& tones, int texels);

/// Signed distance to the base layer's edge, about metres, positive inside; `p` on the template.
[[nodiscard]] float base_layer_depth(const Skeleton& skeleton, const Vec3f& p);

} // namespace toile::body
