// One garment as it is put into a world of cloth, and what every solver reads from it.
#pragma once

#include "cloth/body_contacts.h"
#include "cloth/sheet.h"

namespace toile::cloth {

/// What never changes of a garment. Views are borrowed for the call.
struct GarmentInput {
    ClothMesh mesh; ///< positions: as bound to the body at rest
    Fabric fabric;
    std::span<const std::array<std::uint16_t, 4>> joints; ///< (nv)
    std::span<const std::array<float, 4>> weights;        ///< (nv)
    std::span<const float> attachment; ///< (nv) 0 free .. 1 held to its target; or empty
    unsigned layer = 0;                ///< 0 next to the skin
};

/// (nv) \throw Error when a value is not in 0..1 or the count does not match
[[nodiscard]] std::vector<float> attachments(const GarmentInput& input);

/// (nv) 1/kg; 0 where a vertex is held to its target.
[[nodiscard]] std::vector<float> inverse_masses(std::span<const float> mass,
                                                std::span<const float> attachment);

/// How far the garment keeps from the skin, by its layer and thickness; `margin` in metres.
[[nodiscard]] ContactSettings contact_settings(const GarmentInput& input, float margin,
                                               float friction_scale);

} // namespace toile::cloth
