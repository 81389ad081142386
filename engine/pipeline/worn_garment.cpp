#include "pipeline/worn_garment.h"

#include "core/error.h"

#include <algorithm>

namespace toile::pipeline {

WornGarment::WornGarment(std::shared_ptr<const host::Plugin> plugin, host::Services& services,
                         const BoundaryBody& body, std::shared_ptr<const BoundaryGarment> garment,
                         const toile_limits& limits, host::Job& job)
    : garment_(std::move(garment)), instance_(std::move(plugin), services),
      table_(instance_.table<toile_garment>()), guard_(instance_, limits),
      embedding_(garment_->size()), scratch_(embedding_.make_scratch()) {
    instance_.activate(limits);
    bind(body, job);
    for (const auto& part : embedding_.parts()) {
        Surface surface;
        surface.primitive = &garment_->size().render.meshes[part.mesh].primitives[part.primitive];
        surface.positions = surface.primitive->positions;
        surface.normals.assign(surface.positions.size(), Vec3f::UnitY());
        surfaces.push_back(std::move(surface));
    }
    update_surfaces();
}

void WornGarment::bind(const BoundaryBody& body, host::Job& job) {
    const std::size_t count = garment_->size().simulation.positions.size();
    bound.assign(count, Vec3f::Zero());
    weights_.joints.assign(count, {});
    weights_.weights.assign(count, {});
    attachment_.assign(count, 0.0f);
    auto binding = host::sized<toile_garment_binding>();
    binding.positions = host::view_mut(bound);
    binding.joint_indices = host::view_mut(weights_.joints);
    binding.joint_weights = host::view_mut(weights_.weights);
    binding.attachment = host::view_mut(attachment_);
    instance_.call("bind", [&](toile_instance* instance) {
        return table_.bind(instance, &body.abi(), &garment_->abi(), job.handle(), &binding);
    });
    if (!host::view_finite(host::view_of(bound)))
        throw Error(instance_.id() + ": bind gave positions that are not finite for garment " +
                    garment_->package().manifest.id);
    fallback_ = std::make_unique<body::SkinnedSurface>(bound, std::span<const Vec3f>(),
                                                       weights_.joints, weights_.weights);
    targets = positions = shown = bound;
    normals.assign(count, Vec3f::UnitY());
    shown_normals_ = normals;
    geometry::vertex_normals(positions, triangles(), normals);
}

toile_cloth_garment WornGarment::cloth_description() const {
    auto out = host::sized<toile_cloth_garment>();
    out.layer = garment_->abi().layer;
    out.rest = garment_->abi().simulation;
    out.rest.positions = host::view_of(bound);
    out.rest.normals = host::view_of(normals);
    out.joint_indices = host::view_of(weights_.joints);
    out.joint_weights = host::view_of(weights_.weights);
    out.attachment = host::view_of(attachment_);
    out.fabric = garment_->abi().fabric;
    return out;
}

void WornGarment::update_targets(const toile_body_state& state,
                                 const body::JointTransforms& skinning) noexcept {
    const toile_view_mut out = host::view_mut(targets);
    const bool done =
        guard_.run([&](toile_instance* instance) { return table_.targets(instance, &state, out); },
                   [&] { return host::view_finite(out); });
    if (done) return;
    fallback_->pose(skinning, body::SkinningMethod::linear_blend,
                    body::VectorRows(std::span(targets)), {});
}

bool WornGarment::see_through() const {
    const assets::Scene& scene = garment_->size().render;
    const auto clear = [](const assets::Texture& texture) {
        const auto& pixels = texture.image.pixels;
        for (std::size_t i = 3; i < pixels.size(); i += 4)
            if (pixels[i] < 255) return true;
        return false;
    };
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const assets::Material& m) { return m.base_color.w() < 1.0f; }) ||
           std::any_of(scene.textures.begin(), scene.textures.end(), clear);
}

void WornGarment::begin_showing() noexcept {
    std::copy(positions.begin(), positions.end(), shown.begin());
}

void WornGarment::update_surfaces() noexcept {
    geometry::vertex_normals(shown, triangles(), shown_normals_);
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        embedding_.evaluate(i, shown, shown_normals_, scratch_, surfaces[i].positions,
                            surfaces[i].normals);
}

} // namespace toile::pipeline
