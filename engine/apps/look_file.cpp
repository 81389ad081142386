#include "apps/look_file.h"

#include "assets/files.h"
#include "pipeline/body_frame.h"

namespace toile::apps {
namespace {

// Appends materials and textures of one scene to another; gives the offset of the materials.
int append_materials(assets::Scene& to, const assets::Scene& from) {
    const auto textures = static_cast<int>(to.textures.size());
    const auto materials = static_cast<int>(to.materials.size());
    to.textures.insert(to.textures.end(), from.textures.begin(), from.textures.end());
    for (assets::Material material : from.materials) {
        for (int* texture : {&material.base_color_texture, &material.normal_texture})
            if (*texture != assets::kNone) *texture += textures;
        to.materials.push_back(material);
    }
    return materials;
}

void append_mesh(assets::Scene& scene, const std::string& name,
                 std::vector<assets::Primitive> primitives) {
    assets::Node node;
    node.name = name;
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.nodes.push_back(node);
    assets::Mesh mesh;
    mesh.name = name;
    mesh.primitives = std::move(primitives);
    scene.meshes.push_back(std::move(mesh));
}

assets::Primitive posed_body(const pipeline::DressedPerson& person) {
    const body::BodyModel& model = person.body().model();
    assets::Primitive out;
    for (const std::uint32_t vertex : model.layout.welded) {
        out.positions.push_back(person.posed().positions[vertex]);
        out.normals.push_back(person.posed().normals[vertex]);
    }
    out.texcoords = model.layout.texcoords;
    out.triangles = model.layout.triangles;
    return out;
}

/// The body first, then the garments; one mesh each.
assets::Scene scene_of(const pipeline::DressedPerson& person) {
    const body::BodyModel& model = person.body().model();
    const assets::Scene appearance = assets::load_scene(model.appearance);
    assets::Scene scene;
    const int body_material = append_materials(scene, appearance);
    assets::Primitive body = posed_body(person);
    body.material = appearance.materials.empty() ? assets::kNone : body_material;
    append_mesh(scene, model.id, {std::move(body)});

    for (const pipeline::WornGarment& garment : person.garments()) {
        const int materials = append_materials(scene, garment.garment().size().render);
        std::vector<assets::Primitive> primitives;
        for (const auto& surface : garment.surfaces) {
            assets::Primitive primitive;
            primitive.positions = surface.positions;
            primitive.normals = surface.normals;
            primitive.texcoords = surface.primitive->texcoords;
            primitive.triangles = surface.primitive->triangles;
            if (surface.primitive->material != assets::kNone)
                primitive.material = surface.primitive->material + materials;
            primitives.push_back(std::move(primitive));
        }
        append_mesh(scene, garment.garment().package().manifest.id, std::move(primitives));
    }
    return scene;
}

std::vector<body::SurfaceRole> roles_of(const pipeline::DressedPerson& person) {
    std::vector<body::SurfaceRole> roles(1 + person.garments().size(), body::SurfaceRole::garment);
    roles.front() = body::SurfaceRole::body;
    return roles;
}

} // namespace

void save_look(const pipeline::DressedPerson& person, const std::filesystem::path& file) {
    assets::save_scene(scene_of(person), file);
}

void LookCache::add(const pipeline::DressedPerson& person, const pipeline::BodyFrame& frame) {
    if (folder_.empty()) return;
    if (!writer_) {
        writer_.emplace(folder_, scene_of(person), roles_of(person));
        first_ns_ = frame.timestamp_ns;
    }
    const auto& welded = person.body().model().layout.welded;
    body_.resize(welded.size());
    for (std::size_t v = 0; v < welded.size(); ++v)
        body_[v] = person.posed().positions[welded[v]];
    std::vector<std::span<const Vec3f>> positions = {body_};
    for (const pipeline::WornGarment& garment : person.garments())
        for (const auto& surface : garment.surfaces)
            positions.emplace_back(surface.positions);
    body::TrackedPerson tracked;
    tracked.id = frame.person_id;
    tracked.state = static_cast<body::TrackState>(frame.tracking);
    tracked.joints = pipeline::transforms_of(frame.joints);
    for (std::size_t j = 0; j < frame.joints.size(); ++j)
        tracked.confidence[j] = frame.joints[j].confidence;
    writer_->add(1e-9 * static_cast<double>(frame.timestamp_ns - first_ns_), std::span(&tracked, 1),
                 positions);
}

} // namespace toile::apps
