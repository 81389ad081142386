#include "apps/tape_scene.h"

#include "apps/tape_cord.h"
#include "render/import.h"

#include <algorithm>
#include <cmath>

namespace toile::apps {
namespace {

constexpr float kStep = 0.005f;    // metres between points that are looked at
constexpr float kClear = 0.006f;   // metres: so far off the tape nothing hides it
constexpr double kThrough = 0.5;   // how much of a hidden tape shines through the body
constexpr int kOtherThanWhite = 8; // sRGB steps

float linear(std::uint8_t srgb) {
    return std::pow(static_cast<float>(srgb) / 255.0f, 2.2f);
}

render::Instance add(render::Renderer& renderer, const geometry::TriangleMesh& mesh,
                     const render::Material& material) {
    render::MeshDescription description;
    description.triangles = mesh.triangles;
    description.positions = mesh.positions;
    description.normals = mesh.normals;
    render::Instance out;
    out.mesh = renderer.add_mesh(description);
    out.material = renderer.add_material(material);
    return out;
}

render::RendererOptions renderer_options(int width, int height) {
    render::RendererOptions out;
    out.width = width;
    out.height = height;
    out.quality = render::Quality::high;
    return out;
}

render::Background white() {
    render::Background out;
    out.kind = render::Background::Kind::color;
    out.color = Vec3f::Ones();
    return out;
}

/// Lays what of `over` differs from its top left pixel over `picture`.
void shine_through(imaging::Image& picture, const imaging::Image& over) {
    for (std::size_t at = 0; at < picture.pixels.size(); at += 4) {
        int difference = 0;
        for (std::size_t c = 0; c < 3; ++c)
            difference = std::max(difference, std::abs(over.pixels[at + c] - over.pixels[c]));
        if (difference < kOtherThanWhite) continue;
        for (std::size_t c = 0; c < 3; ++c)
            picture.pixels[at + c] = static_cast<std::uint8_t>(
                std::lround((1.0 - kThrough) * picture.pixels[at + c] +
                            kThrough * static_cast<double>(over.pixels[at + c])));
    }
}

} // namespace

TapeScene::TapeScene(const body::BodyModel& model, int width, int height, Backdrop backdrop)
    : context_(render::make_offscreen_context()),
      renderer_(*context_, renderer_options(width, height)),
      surface_(model.rest.positions, model.rest.triangles),
      backdrop_(backdrop == Backdrop::studio ? render::Background() : white()),
      floor_(backdrop == Backdrop::studio) {
    scene_.instances.push_back(add(renderer_, model.rest, render::mannequin_material()));
    for (const Vec3f& p : model.rest.positions)
        bounds_.add(p);
}

void TapeScene::lay(std::span<const geometry::Loop> tapes, const Color& color, float radius_m) {
    render::Material material = render::mannequin_material();
    material.base_color = Vec4f(linear(color[0]), linear(color[1]), linear(color[2]), 1.0f);
    for (const geometry::Loop& tape : tapes) {
        const geometry::TriangleMesh mesh = cord(tape, radius_m);
        if (!mesh.triangles.empty()) scene_.instances.push_back(add(renderer_, mesh, material));
    }
}

void TapeScene::take_off() {
    for (std::size_t i = 1; i < scene_.instances.size(); ++i)
        renderer_.remove_mesh(scene_.instances[i].mesh);
    scene_.instances.resize(1);
}

imaging::Image TapeScene::draw(const render::Camera& camera) {
    scene_.camera = camera;
    scene_.lighting = render::studio_lighting(camera);
    scene_.background = backdrop_;
    scene_.floor = floor_;
    renderer_.draw(scene_);
    imaging::Image picture = renderer_.read();

    render::Instance& body = scene_.instances.front();
    body.draw = render::Instance::Draw::hidden;
    scene_.background = white();
    scene_.floor = false;
    renderer_.draw(scene_);
    body.draw = render::Instance::Draw::visible;
    shine_through(picture, renderer_.read());
    return picture;
}

std::vector<SeenPoint> TapeScene::seen(const geometry::Loop& tape,
                                       const render::Camera& camera) const {
    std::vector<SeenPoint> out;
    const RigidTransform camera_from_world = camera.world_from_camera.inverse();
    const auto look_at = [&](const Vec3f& p) {
        const Vec3f c = camera_from_world * p;
        const float x = c.x() / -c.z(), y = c.y() / -c.z();
        const Vec3f towards = (camera.world_from_camera.translation - p).normalized();
        out.push_back({{(x - camera.left) / (camera.right - camera.left) *
                            static_cast<float>(renderer_.width()),
                        (camera.top - y) / (camera.top - camera.bottom) *
                            static_cast<float>(renderer_.height())},
                       !surface_.blocked(p, towards, kClear)});
    };
    const std::size_t n = tape.points.size();
    for (std::size_t i = 0; i + (tape.closed ? 0 : 1) < n; ++i) {
        const Vec3f& from = tape.points[i];
        const Vec3f& to = tape.points[(i + 1) % n];
        const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kStep)));
        for (int k = 0; k < steps; ++k)
            look_at(from + (to - from) * (static_cast<float>(k) / static_cast<float>(steps)));
    }
    if (!tape.closed && n > 0) look_at(tape.points.back());
    return out;
}

} // namespace toile::apps
