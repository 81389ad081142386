// The designs: each drafts its pattern for one body, with a first guess of the place of every
// point.
#pragma once

#include "garment/block_body.h"

namespace toile::garment::block {

struct TShirtOptions {
    double chest_ease_m = 0.09;    ///< girth beyond the fullest chest
    double hem_ease_m = 0.06;      ///< girth beyond the hips, if they are fuller than the chest
    double cap_share = 0.60;       ///< height of the sleeve cap, of the armhole's
    double armhole_drop_m = 0.028; ///< of the underarm point below the armpit
    double collar_m = 0.019;       ///< height of the rib band
    double neck_ease_m = 0.028;    ///< of the neck seam outside the neck, at the shoulder
    double sleeve_share = 0.64;    ///< of the upper arm that the sleeve covers
};
/// Panels front, back, sleeve_front, sleeve_back, collar_front, collar_back. The probe must
/// outlive the pattern. \throw Error
[[nodiscard]] Pattern draft_t_shirt(const BodyProbe& body, const TShirtOptions& options = {});

struct SkirtOptions {
    double band_m = 0.035;      ///< height of the waistband
    double band_ease_m = 0.008; ///< distance of the waistband from the skin
    double hip_ease_m = 0.06;   ///< least girth beyond the body below the waist
    double least_flare = 1.15;  ///< metres of girth per metre of length
    double below_knee_m = 0.02; ///< hem below the knee joint
};
/// An A-line skirt of six gores (front, back, and front_side, back_side on each side) with a band
/// (band_front ...): a cone with hip curves in all seams. \throw Error
[[nodiscard]] Pattern draft_skirt(const BodyProbe& body, const SkirtOptions& options = {});

} // namespace toile::garment::block
