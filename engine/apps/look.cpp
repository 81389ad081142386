#include "apps/look.h"

#include "assets/files.h"
#include "core/error.h"
#include "render/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace toile::apps {
namespace {

constexpr double kFollowTime_s = 0.8;

// Parts that no visible triangle may belong to, because garments say so.
std::set<body::Part> masked_parts(const pipeline::DressedPerson& person) {
    std::set<body::Part> out;
    for (const pipeline::WornGarment& garment : person.garments())
        for (const body::Part part : garment.garment().package().manifest.body_mask)
            out.insert(part);
    return out;
}

// The material that a colourway gives to a primitive.
int material_index(const assets::Scene& scene, const assets::Primitive& primitive,
                   const std::string& material_variant) {
    for (std::size_t i = 0; i < scene.variants.size(); ++i)
        if (scene.variants[i] == material_variant && i < primitive.variant_materials.size() &&
            primitive.variant_materials[i] != assets::kNone)
            return primitive.variant_materials[i];
    return primitive.material;
}

const garment::Variant* find_variant(const garment::Manifest& manifest, const std::string& name) {
    for (const garment::Variant& variant : manifest.variants)
        if (variant.name == name) return &variant;
    return name.empty() && !manifest.variants.empty() ? &manifest.variants.front() : nullptr;
}

} // namespace

Look::Look(render::Context& context, const render::RendererOptions& options,
           const pipeline::DressedPerson& person, const std::string& variant, FitMapKind map)
    : person_(person), renderer_(context, options) {
    bool worn = variant.empty();
    for (const pipeline::WornGarment& garment : person_.garments()) {
        const auto& variants = garment.garment().package().manifest.variants;
        worn = worn || std::any_of(variants.begin(), variants.end(),
                                   [&](const auto& v) { return v.name == variant; });
    }
    if (!worn) throw UsageError("no garment has a colourway named '" + variant + "'");
    if (map != FitMapKind::none) map_ = std::make_unique<FitMap>(person, map);
    add_body();
    const render::MaterialId colours = map_ ? map_->material(renderer_) : render::MaterialId::none;
    for (std::size_t i = 0; i < person_.garments().size(); ++i) {
        if (map_)
            add_mapped(person_.garments()[i], i, colours);
        else
            add_garment(person_.garments()[i], variant);
    }
}

void Look::add_body() {
    const body::BodyModel& model = person_.body().model();
    const assets::Scene appearance = assets::load_scene(model.appearance);
    const auto materials = render::add_materials(renderer_, appearance);

    const std::set<body::Part> masked = masked_parts(person_);
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < model.layout.triangles.size(); ++i) {
        const Triangle& welded = model.rest.triangles[i];
        const bool hidden =
            !masked.empty() && std::all_of(welded.begin(), welded.end(), [&](std::uint32_t v) {
                return masked.contains(model.parts[v]);
            });
        if (!hidden) triangles.push_back(model.layout.triangles[i]);
    }
    render::MeshDescription description;
    description.triangles = triangles;
    description.source = model.layout.welded;
    description.texcoords = model.layout.texcoords;
    description.positions = person_.posed().positions;
    description.normals = person_.posed().normals;
    body_ = renderer_.add_mesh(description);

    render::Instance instance;
    instance.mesh = body_;
    instance.material = materials.empty() || map_
                            ? renderer_.add_material(render::mannequin_material())
                            : materials.front();
    scene_.instances.push_back(instance);
}

void Look::add_garment(const pipeline::WornGarment& garment, const std::string& variant) {
    const garment::GarmentPackage& package = garment.garment().package();
    const garment::Variant* colourway = find_variant(package.manifest, variant);
    assets::Scene scene = garment.garment().size().render;
    if (colourway != nullptr && colourway->base_color)
        for (assets::Material& material : scene.materials)
            material.base_color.head<3>() =
                material.base_color.head<3>().cwiseProduct(*colourway->base_color);
    const auto materials = render::add_materials(renderer_, scene);

    for (std::size_t s = 0; s < garment.surfaces.size(); ++s) {
        const auto& surface = garment.surfaces[s];
        add_surface(garment, s, surface.primitive->texcoords, [&] {
            const int index =
                material_index(scene, *surface.primitive,
                               colourway != nullptr ? colourway->material_variant : std::string());
            return index == assets::kNone
                       ? renderer_.add_material(render::cloth_material(Vec3f::Constant(0.5f)))
                       : materials.at(static_cast<std::size_t>(index));
        });
    }
}

// Nothing where all of it is hidden.
void Look::add_surface(const pipeline::WornGarment& garment, const std::size_t s,
                       const std::span<const Vec2f> texcoords,
                       const std::function<render::MaterialId()>& material) {
    const std::vector<Triangle> drawn = garment.drawn_triangles(s);
    if (drawn.empty()) {
        surfaces_.push_back(render::MeshId::none);
        return;
    }
    render::MeshDescription description;
    description.triangles = drawn;
    description.texcoords = texcoords;
    description.positions = garment.surfaces[s].positions;
    description.normals = garment.surfaces[s].normals;
    surfaces_.push_back(renderer_.add_mesh(description));
    render::Instance instance;
    instance.mesh = surfaces_.back();
    instance.material = material();
    scene_.instances.push_back(instance);
}

void Look::add_mapped(const pipeline::WornGarment& garment, std::size_t index,
                      render::MaterialId material) {
    for (std::size_t s = 0; s < garment.surfaces.size(); ++s)
        add_surface(garment, s, map_->texcoords(index, s), [material] { return material; });
}

void Look::spoil(Spoil how) {
    for (render::Instance& instance : scene_.instances) {
        const bool is_body = instance.mesh == body_;
        if (how == Spoil::shadows) instance.casts_shadow = false;
        if (how == Spoil::shift && !is_body)
            instance.world_from_mesh.translation += Vec3f(0.01f, 0.0f, 0.0f);
        if (how == Spoil::body && is_body) instance.draw = render::Instance::Draw::hidden;
    }
}

void Look::update() {
    const auto check = [](render::Status status) {
        if (status != render::Status::ok)
            throw Error(std::string("a surface cannot be drawn: ") + render::text(status));
    };
    check(renderer_.update_mesh(body_, person_.posed().positions, person_.posed().normals));
    std::size_t next = 0;
    for (const pipeline::WornGarment& garment : person_.garments())
        for (const auto& surface : garment.surfaces) {
            const render::MeshId mesh = surfaces_[next++];
            if (mesh != render::MeshId::none)
                check(renderer_.update_mesh(mesh, surface.positions, surface.normals));
        }
    if (map_) update_map();
}

void Look::update_map() {
    map_->update();
    std::size_t next = 0;
    for (std::size_t i = 0; i < person_.garments().size(); ++i)
        for (std::size_t s = 0; s < person_.garments()[i].surfaces.size(); ++s) {
            const render::MeshId mesh = surfaces_[next++];
            if (mesh == render::MeshId::none) continue;
            const auto status = renderer_.update_texcoords(mesh, map_->texcoords(i, s));
            if (status != render::Status::ok)
                throw Error(std::string("a fit map cannot be drawn: ") + render::text(status));
        }
}

void Look::draw(const render::View& view, const render::Box& box) {
    scene_.camera =
        render::frame_view(view, box.low, box.high, renderer_.width(), renderer_.height());
    scene_.lighting = render::studio_lighting(scene_.camera);
    renderer_.draw(scene_);
}

render::Box bounds_now(const pipeline::DressedPerson& person) {
    render::Box box;
    for (const Vec3f& p : person.posed().positions)
        box.add(p);
    for (const pipeline::WornGarment& garment : person.garments())
        for (const Vec3f& p : garment.positions)
            box.add(p);
    box.low.y() = std::min(box.low.y(), 0.0f);
    return box;
}

Spoil spoil_from_name(const std::string& name) {
    if (name.empty()) return Spoil::none;
    if (name == "shift") return Spoil::shift;
    if (name == "shadows") return Spoil::shadows;
    if (name == "body") return Spoil::body;
    if (name == "occlusion") return Spoil::occlusion;
    throw UsageError("--spoil " + name + ": no such way; shift, shadows, body or occlusion");
}

StageBox::StageBox(const pipeline::DressedPerson& person) {
    render::Box rest;
    for (const Vec3f& p : person.body().model().rest.positions)
        rest.add(p);
    stature_ = rest.high.y() - rest.low.y();
    centre_ = Vec3f::Zero();
    follow(person, 1e3);
}

void StageBox::follow(const pipeline::DressedPerson& person, double dt_s) {
    const auto& hips = person.posed().joints[0].position;
    const Vec3f goal(hips[0], 0.0f, hips[2]);
    centre_ += static_cast<float>(1.0 - std::exp(-dt_s / kFollowTime_s)) * (goal - centre_);
    const Vec3f half(0.43f * stature_, 0.0f, 0.35f * stature_);
    box_.low = centre_ - half;
    box_.high = centre_ + half + Vec3f(0.0f, 1.1f * stature_, 0.0f);
}

} // namespace toile::apps
