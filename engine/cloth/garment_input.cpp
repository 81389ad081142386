#include "cloth/garment_input.h"

#include "core/error.h"

#include <algorithm>
#include <string>

namespace toile::cloth {

std::vector<float> attachments(const GarmentInput& input) {
    const std::size_t count = input.mesh.positions.size();
    if (input.attachment.empty()) {
        return std::vector<float>(count, 0.0f);
    }
    if (input.attachment.size() != count) {
        throw Error("garment: " + std::to_string(input.attachment.size()) + " attachments for " +
                    std::to_string(count) + " vertices");
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!(input.attachment[v] >= 0.0f && input.attachment[v] <= 1.0f)) {
            throw Error("garment: attachment of vertex " + std::to_string(v) + " is not in 0..1");
        }
    }
    return {input.attachment.begin(), input.attachment.end()};
}

std::vector<float> inverse_masses(std::span<const float> mass, std::span<const float> attachment) {
    constexpr float kHeld = 0.999f;
    std::vector<float> inverse(mass.size());
    for (std::size_t v = 0; v < mass.size(); ++v) {
        inverse[v] = attachment[v] >= kHeld ? 0.0f : 1.0f / mass[v];
    }
    return inverse;
}

ContactSettings contact_settings(const GarmentInput& input, float margin, float friction_scale) {
    // An outer layer keeps further out, so that it lies over the inner one.
    constexpr float kBetweenLayers = 0.002f;
    const float thickness = std::min(input.fabric.thickness, 0.01f);
    const float layers =
        static_cast<float>(std::min(input.layer, 8u)) * (thickness + kBetweenLayers);
    ContactSettings contact;
    contact.offset = 0.5f * thickness + margin + layers;
    contact.centre_offset = 0.5f * contact.offset + 0.5f * layers;
    contact.friction = input.fabric.friction * friction_scale;
    return contact;
}

} // namespace toile::cloth
