#include "apps/dressed_picture.h"

#include "apps/contact_sheet.h"
#include "render/import.h"
#include "render/views.h"

namespace toile::apps {
namespace {

constexpr int kWidth = 400, kHeight = 720;

} // namespace

void save_dressed_picture(const pipeline::MannequinDressing& dressed,
                          const std::filesystem::path& file) {
    const std::unique_ptr<render::Context> context = render::make_offscreen_context();
    render::RendererOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.quality = render::Quality::high;
    render::Renderer renderer(*context, options);
    std::vector<std::vector<render::Instance>> shown;
    std::vector<render::Box> boxes;
    Vec3f half = Vec3f::Zero(); // of the largest: all are drawn to one scale
    for (const assets::ColoredMesh* mesh : {&dressed.mannequin, &dressed.customer, &dressed.look}) {
        const auto added = render::add_scene(renderer, assets::scene_of(*mesh, "scan"),
                                             render::mannequin_material());
        shown.push_back(added.instances);
        boxes.push_back(added.bounds);
        half = half.cwiseMax(0.5f * (added.bounds.high - added.bounds.low));
    }
    std::vector<imaging::Image> pictures;
    for (const render::View& view : render::views_from_names("front,left"))
        for (std::size_t i = 0; i < shown.size(); ++i) {
            render::Scene scene;
            const Vec3f middle = 0.5f * (boxes[i].low + boxes[i].high);
            scene.instances = shown[i];
            for (render::Instance& instance : scene.instances)
                instance.world_from_mesh.translation =
                    Vec3f(-middle.x(), -boxes[i].low.y(), -middle.z());
            const Vec3f low(-half.x(), 0.0f, -half.z()), high(half.x(), 2.0f * half.y(), half.z());
            scene.camera = render::frame_view(view, low, high, kWidth, kHeight);
            scene.lighting = render::studio_lighting(scene.camera);
            renderer.draw(scene);
            pictures.push_back(renderer.read());
        }
    imaging::save_image(side_by_side(pictures), file);
}

} // namespace toile::apps
