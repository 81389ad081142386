#include "apps/fit_map.h"

#include "apps/fit_scale.h"
#include "core/error.h"

#include <algorithm>

namespace toile::apps {
namespace {

// The scale's colours stand in the middle of the texture, its ends' around them: no filter brings
// one end's colour to the other.
constexpr int kTexels = 64;
constexpr float kFrom = 0.25f, kSpan = 0.5f; // of the texture's width

imaging::Image ramp(const FitScale& scale) {
    imaging::Image out;
    out.width = kTexels;
    out.height = 4;
    for (int row = 0; row < out.height; ++row)
        for (int i = 0; i < kTexels; ++i) {
            const float u = (static_cast<float>(i) + 0.5f) / kTexels;
            const Color color = scale.color((u - kFrom) / kSpan);
            out.pixels.insert(out.pixels.end(), {color[0], color[1], color[2], 255});
        }
    return out;
}

} // namespace

FitMapKind fit_map_from_name(const std::string& name) {
    if (name.empty()) return FitMapKind::none;
    if (name == "ease") return FitMapKind::ease;
    if (name == "strain") return FitMapKind::strain;
    throw UsageError("--fit-map '" + name + "': there are ease and strain");
}

FitMap::FitMap(const pipeline::DressedPerson& person, FitMapKind kind)
    : person_(person), kind_(kind) {
    const auto& body = person.body().model().rest;
    for (const pipeline::WornGarment& worn : person.garments()) {
        const garment::GarmentSize& size = worn.garment().size();
        const std::size_t count = worn.positions.size();
        garments_.push_back({{body.triangles, body.positions.size(), count},
                             {worn.triangles(), size.material_coords, count},
                             std::vector<float>(count),
                             {},
                             {}});
        Mapped& mapped = garments_.back();
        mapped.gap.find({person.posed().positions, person.posed().normals}, worn.positions);
        for (const auto& surface : worn.surfaces) {
            mapped.texcoords.emplace_back(surface.positions.size(), Vec2f::Zero());
            mapped.values.resize(std::max(mapped.values.size(), surface.positions.size()));
        }
    }
    update();
}

void FitMap::measure(Mapped& mapped, const pipeline::WornGarment& worn) const noexcept {
    const float per_unit = 1.0f / FitScale::of(kind_).most;
    if (kind_ == FitMapKind::ease) {
        mapped.gap.follow({person_.posed().positions, person_.posed().normals}, worn.positions);
        std::transform(mapped.gap.gaps().begin(), mapped.gap.gaps().end(),
                       mapped.simulation.begin(), [=](float gap) { return gap * per_unit; });
        return;
    }
    mapped.strain.measure(worn.positions);
    std::transform(mapped.strain.warp().begin(), mapped.strain.warp().end(),
                   mapped.strain.weft().begin(), mapped.simulation.begin(),
                   [=](float warp, float weft) { return std::max(warp, weft) * per_unit; });
}

void FitMap::update() noexcept {
    std::size_t next = 0;
    for (const pipeline::WornGarment& worn : person_.garments()) {
        Mapped& mapped = garments_[next++];
        measure(mapped, worn);
        for (std::size_t s = 0; s < mapped.texcoords.size(); ++s) {
            std::vector<Vec2f>& texcoords = mapped.texcoords[s];
            worn.on_surface(s, mapped.simulation, std::span(mapped.values).first(texcoords.size()));
            for (std::size_t v = 0; v < texcoords.size(); ++v)
                texcoords[v] = {kFrom + kSpan * std::clamp(mapped.values[v], 0.0f, 1.0f), 0.5f};
        }
    }
}

render::MaterialId FitMap::material(render::Renderer& renderer) const {
    render::Material out;
    out.base_color_texture = renderer.add_texture(ramp(FitScale::of(kind_)), false);
    out.roughness = 1.0f;
    out.double_sided = true;
    return renderer.add_material(out);
}

} // namespace toile::apps
