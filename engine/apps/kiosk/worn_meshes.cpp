#include "apps/kiosk/worn_meshes.h"

#include "core/error.h"
#include "render/import.h"

#include <map>

namespace toile::apps::kiosk {
namespace {

// Materials of a scene, with the textures that they use.
struct Uploaded {
    std::vector<render::MaterialId> materials;
    std::vector<render::TextureId> textures;
};

Uploaded upload(render::Renderer& renderer, const assets::Scene& scene) {
    Uploaded out;
    std::map<int, render::TextureId> known;
    const auto texture = [&](int index, bool linear) {
        if (index == assets::kNone) return render::TextureId::none;
        const auto found = known.find(index);
        if (found != known.end()) return found->second;
        const render::TextureId id =
            renderer.add_texture(scene.textures.at(static_cast<std::size_t>(index)).image, linear);
        out.textures.push_back(id);
        known.emplace(index, id);
        return id;
    };
    for (const assets::Material& m : scene.materials) {
        render::Material made;
        made.base_color = m.base_color;
        made.base_color_texture = texture(m.base_color_texture, false);
        made.normal_texture = texture(m.normal_texture, true);
        made.normal_scale = m.normal_scale;
        made.roughness = m.roughness;
        made.sheen_color = m.sheen_color;
        made.sheen_roughness = m.sheen_roughness;
        made.double_sided = m.double_sided;
        out.materials.push_back(renderer.add_material(made));
    }
    return out;
}

int material_index(const assets::Scene& scene, const assets::Primitive& primitive,
                   const garment::Variant* variant) {
    if (variant != nullptr)
        for (std::size_t i = 0; i < scene.variants.size(); ++i)
            if (scene.variants[i] == variant->material_variant &&
                i < primitive.variant_materials.size() &&
                primitive.variant_materials[i] != assets::kNone)
                return primitive.variant_materials[i];
    return primitive.material;
}

void check(render::Status status) {
    if (status != render::Status::ok)
        throw Error(std::string("a surface cannot be drawn: ") + render::text(status));
}

} // namespace

WornMeshes::WornMeshes(render::Renderer& renderer, const pipeline::DressedPerson& person,
                       std::size_t colour, std::span<const std::uint32_t> bare)
    : renderer_(renderer), person_(person) {
    try {
        add_body(bare);
        for (const pipeline::WornGarment& garment : person_.garments())
            add_garment(garment, colour);
    } catch (...) {
        release();
        throw;
    }
}

WornMeshes::~WornMeshes() {
    release();
}

void WornMeshes::release() {
    const auto drop = [&](render::MeshId mesh) {
        if (mesh != render::MeshId::none) renderer_.remove_mesh(mesh);
    };
    drop(body_);
    drop(receiver_);
    for (const Surface& surface : surfaces_)
        drop(surface.mesh);
    for (const render::MaterialId material : materials_)
        renderer_.remove_material(material);
    for (const render::TextureId texture : textures_)
        renderer_.remove_texture(texture);
}

void WornMeshes::add_body(std::span<const std::uint32_t> bare) {
    const body::BodyModel& model = person_.body().model();
    render::MeshDescription description;
    description.triangles = model.layout.triangles;
    description.source = model.layout.welded;
    description.texcoords = model.layout.texcoords;
    description.positions = person_.posed().positions;
    description.normals = person_.posed().normals;
    body_ = renderer_.add_mesh(description);
    std::vector<bool> left_out(model.rest.positions.size());
    for (const std::uint32_t v : bare)
        left_out[v] = true;
    std::vector<Triangle> kept;
    for (std::size_t i = 0; i < model.layout.triangles.size(); ++i) {
        const Triangle& t = model.rest.triangles[i];
        if (!(left_out[t[0]] && left_out[t[1]] && left_out[t[2]]))
            kept.push_back(model.layout.triangles[i]);
    }
    description.triangles = kept;
    receiver_ = renderer_.add_mesh(description);
    picture_ = renderer_.add_material(render::mannequin_material());
    avatar_ = renderer_.add_material(render::mannequin_material());
    materials_.insert(materials_.end(), {picture_, avatar_});
}

void WornMeshes::add_garment(const pipeline::WornGarment& garment, std::size_t colour) {
    const garment::Manifest& manifest = garment.garment().package().manifest;
    const garment::Variant* variant =
        colour < manifest.variants.size() ? &manifest.variants[colour] : nullptr;
    assets::Scene scene = garment.garment().size().render;
    if (variant != nullptr && variant->base_color)
        for (assets::Material& material : scene.materials)
            material.base_color.head<3>() =
                material.base_color.head<3>().cwiseProduct(*variant->base_color);
    const Uploaded uploaded = upload(renderer_, scene);
    materials_.insert(materials_.end(), uploaded.materials.begin(), uploaded.materials.end());
    textures_.insert(textures_.end(), uploaded.textures.begin(), uploaded.textures.end());
    for (std::size_t s = 0; s < garment.surfaces.size(); ++s) {
        const std::vector<Triangle> drawn = garment.drawn_triangles(s);
        surfaces_.emplace_back();
        if (drawn.empty()) continue;
        render::MeshDescription description;
        description.triangles = drawn;
        description.texcoords = garment.surfaces[s].primitive->texcoords;
        description.positions = garment.surfaces[s].positions;
        description.normals = garment.surfaces[s].normals;
        surfaces_.back().mesh = renderer_.add_mesh(description);
        const int index = material_index(scene, *garment.surfaces[s].primitive, variant);
        if (index == assets::kNone) {
            materials_.push_back(
                renderer_.add_material(render::cloth_material(Vec3f::Constant(0.5f))));
            surfaces_.back().material = materials_.back();
        } else {
            surfaces_.back().material = uploaded.materials.at(static_cast<std::size_t>(index));
        }
    }
}

void WornMeshes::update() {
    for (const render::MeshId mesh : {body_, receiver_})
        check(renderer_.update_mesh(mesh, person_.posed().positions, person_.posed().normals));
    std::size_t next = 0;
    for (const pipeline::WornGarment& garment : person_.garments())
        for (const auto& surface : garment.surfaces) {
            const render::MeshId mesh = surfaces_[next++].mesh;
            if (mesh != render::MeshId::none)
                check(renderer_.update_mesh(mesh, surface.positions, surface.normals));
        }
}

void WornMeshes::add_to(render::Scene& scene, BodyDrawn body) const {
    render::Instance instance;
    const bool seen = body == BodyDrawn::avatar;
    instance.mesh = seen ? body_ : receiver_;
    instance.material = seen ? avatar_ : picture_;
    instance.draw = seen ? render::Instance::Draw::visible : render::Instance::Draw::receiver;
    instance.casts_shadow = seen; // the picture has the body's own shadows already
    scene.instances.push_back(instance);
    for (const Surface& surface : surfaces_) {
        if (surface.mesh == render::MeshId::none) continue;
        render::Instance cloth;
        cloth.mesh = surface.mesh;
        cloth.material = surface.material;
        scene.instances.push_back(cloth);
    }
}

} // namespace toile::apps::kiosk
