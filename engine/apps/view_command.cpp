// `toile view`: pictures of any 3D files, drawn as a try-on would be.
#include "apps/commands.h"
#include "apps/contact_sheet.h"
#include "assets/files.h"
#include "core/error.h"
#include "render/import.h"
#include "render/views.h"

#include <memory>

namespace toile::apps {
namespace {

struct ViewOptions {
    std::vector<std::string> files;
    std::string out;
    std::string views = "front";
    std::string size = "480x640";
    std::string quality = "high";
    bool two_sided = false;
};

// Linear colours that tell apart the files of one picture; the first is a mannequin's.
const std::vector<Vec3f> kCloths = {Vec3f(0.105f, 0.165f, 0.290f), Vec3f(0.420f, 0.090f, 0.075f),
                                    Vec3f(0.130f, 0.235f, 0.160f), Vec3f(0.560f, 0.420f, 0.180f)};

void view(const ViewOptions& o) {
    const auto [width, height] = size_from_text(o.size);
    const std::vector<render::View> views = render::views_from_names(o.views);
    const std::unique_ptr<render::Context> context = render::make_offscreen_context();
    render::RendererOptions options;
    options.width = width;
    options.height = height;
    options.quality = o.quality == "high" ? render::Quality::high : render::Quality::fast;
    render::Renderer renderer(*context, options);
    render::Scene scene;
    render::Box box;
    for (std::size_t i = 0; i < o.files.size(); ++i) {
        render::Material plain = i == 0 ? render::mannequin_material()
                                        : render::cloth_material(kCloths[(i - 1) % kCloths.size()]);
        plain.double_sided |= o.two_sided;
        const assets::Scene file = assets::load_scene(o.files[i]);
        const render::ImportedScene added = render::add_scene(renderer, file, plain);
        scene.instances.insert(scene.instances.end(), added.instances.begin(),
                               added.instances.end());
        box.add(added.bounds.low);
        box.add(added.bounds.high);
    }
    // Files whose origin is not the floor are stood on it.
    if (std::abs(box.low.y()) > 0.02f) {
        const float lift = -box.low.y();
        for (render::Instance& instance : scene.instances) {
            instance.world_from_mesh.translation.y() = lift;
        }
        box.low.y() += lift;
        box.high.y() += lift;
    }
    std::vector<imaging::Image> pictures;
    for (const render::View& v : views) {
        scene.camera = render::frame_view(v, box.low, box.high, width, height);
        scene.lighting = render::studio_lighting(scene.camera);
        renderer.draw(scene);
        pictures.push_back(renderer.read());
    }
    imaging::save_image(side_by_side(pictures), o.out);
}

} // namespace

void add_view_commands(CLI::App& app, const GlobalOptions&) {
    auto options = std::make_shared<ViewOptions>();
    CLI::App* const command = app.add_subcommand("view", "Draw 3D files as pictures side by side");
    command->add_option("files", options->files, "3D files (.glb, .gltf, .obj, .ply, .fbx)")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "Picture to write (.png, .jpg)")
        ->required()
        ->type_name("FILE");
    command->add_option("--views", options->views, "Views, comma-separated")->capture_default_str();
    command->add_option("--size", options->size, "Size of each view, pixels")
        ->type_name("WxH")
        ->capture_default_str();
    command->add_option("--quality", options->quality, "fast or high")
        ->check(CLI::IsMember({"fast", "high"}))
        ->capture_default_str();
    command->add_flag("--two-sided", options->two_sided, "Draw both sides of plain surfaces");
    command->footer("Example: toile view avatars/mannequin/mannequin.glb --views front,back,left "
                    "--out mannequin.png");
    command->callback([options] { view(*options); });
}

} // namespace toile::apps
