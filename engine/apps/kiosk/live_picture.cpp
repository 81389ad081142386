#include "apps/kiosk/live_picture.h"

#include "imaging/srgb.h"
#include "render/views.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::apps::kiosk {
namespace {

constexpr float kSameSurface_m = 0.04f; // the body lies so near to what is seen
constexpr std::size_t kEveryVertex = 5;
constexpr double kLightTime_s = 0.8;
constexpr float kTolerance_m = 0.055f;
constexpr float kHandInCloth_m = 0.03f; // cloth may be drawn so far before a hand that lies on it
constexpr int kReach = 3;               // pixels between a forearm's vertices, nearly

RigidTransform rigid(const Eigen::Isometry3d& place) {
    return {Quatf(place.linear().cast<float>()).normalized(), place.translation().cast<float>()};
}

} // namespace

LivePicture::LivePicture(render::Context& context)
    : renderer_(context, {640, 480, render::Quality::fast}) {}

void LivePicture::warm_up() {
    const imaging::Image grey{2, 2, std::vector<std::uint8_t>(16, 128)};
    const imaging::DepthImage far_away{2, 2, std::vector<float>(4, 9.0f)};
    const std::array<Vec3f, 3> corners = {Vec3f(-1, -1, -2), Vec3f(1, -1, -2), Vec3f(0, 1, -2)};
    const std::array<Vec2f, 3> texcoords = {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1)};
    const std::array<Triangle, 1> triangle = {Triangle{0, 1, 2}};
    render::Material material;
    material.base_color_texture = renderer_.add_texture(grey, false);
    material.normal_texture = renderer_.add_texture(grey, true);
    const render::TextureId depth = renderer_.add_depth(far_away);
    render::Instance cloth;
    cloth.mesh = renderer_.add_mesh({triangle, {}, texcoords, {}, corners, {}});
    cloth.material = renderer_.add_material(material);
    render::Instance body = cloth;
    body.material = renderer_.add_material({});
    body.draw = render::Instance::Draw::receiver;
    render::Scene scene;
    scene.instances = {cloth, body};
    scene.background.kind = render::Background::Kind::camera;
    scene.background.picture = material.base_color_texture;
    scene.background.depth = depth;
    scene.background.noise = 0.01f;
    renderer_.draw(scene);
    renderer_.remove_mesh(cloth.mesh);
    renderer_.remove_material(cloth.material);
    renderer_.remove_material(body.material);
    for (const render::TextureId texture :
         {material.base_color_texture, material.normal_texture, depth})
        renderer_.remove_texture(texture);
}

void LivePicture::set_camera(const pipeline::SensorFrame& frame,
                             const pipeline::SensorStream& stream) {
    const bool same = frame.depth.width == width_ && frame.depth.height == height_ &&
                      has_color_ == !frame.color.empty();
    camera_ = stream.depth;
    if (stream.world_from_camera) place_ = *stream.world_from_camera;
    sequence_ = frame.sequence;
    if (!same) {
        renderer_.remove_texture(picture_);
        renderer_.remove_texture(depth_);
        width_ = frame.depth.width;
        height_ = frame.depth.height;
        has_color_ = !frame.color.empty();
        picture_ = has_color_ ? renderer_.add_texture(frame.color, false) : render::TextureId::none;
        depth_ = renderer_.add_depth(frame.depth);
        return;
    }
    if (has_color_) (void)renderer_.update_texture(picture_, frame.color);
    (void)renderer_.update_depth(depth_, frame.depth);
}

void LivePicture::erase() {
    renderer_.remove_texture(picture_);
    renderer_.remove_texture(depth_);
    picture_ = depth_ = render::TextureId::none;
    width_ = height_ = 0;
    scene_.instances.clear();
    light_ = {};
    std::fill(hiding_.metres.begin(), hiding_.metres.end(), 0.0f);
    // What was drawn last is drawn over.
    render::Scene nothing;
    nothing.background.kind = render::Background::Kind::color;
    renderer_.draw(nothing);
}

void LivePicture::hide_by(const pipeline::SensorFrame& frame, std::span<const Wearer> wearers) {
    if (frame.depth.width != width_ || frame.depth.height != height_) return;
    hiding_.width = width_;
    hiding_.height = height_;
    hiding_.metres.assign(frame.depth.metres.begin(), frame.depth.metres.end());
    for (const Wearer& wearer : wearers) {
        const auto& posed = wearer.person->posed();
        const TrackedSkin skin{posed.positions, posed.normals, wearer.person->body().model().parts};
        trunk_.fill(skin, camera_, place_, width_, height_);
        lift_bare_parts(skin, *wearer.bare, camera_, place_, frame.depth, trunk_,
                        kTolerance_m + kHandInCloth_m, kReach, hiding_);
    }
    (void)renderer_.update_depth(depth_, hiding_);
}

std::optional<Vec2f> LivePicture::pixel_of(const Vec3f& world) const {
    const auto pixel = imaging::project(camera_, place_.inverse() * world.cast<double>());
    if (!pixel) return std::nullopt;
    return pixel->cast<float>();
}

void LivePicture::add_lit_places(const pipeline::DressedPerson& person,
                                 const pipeline::SensorFrame& frame,
                                 std::vector<LitPlace>& out) const {
    if (frame.color.empty()) return;
    const Eigen::Isometry3d camera_from_world = place_.inverse();
    const Vec3f eye = place_.translation().cast<float>();
    const auto& posed = person.posed();
    const auto& parts = person.body().model().parts;
    for (std::size_t v = 0; v < posed.positions.size(); v += kEveryVertex) {
        const Vec3f& normal = posed.normals[v];
        if (normal.dot((eye - posed.positions[v]).normalized()) < 0.25f) continue;
        const auto seen =
            seen_pixel(camera_, camera_from_world, posed.positions[v], width_, height_);
        if (!seen) continue;
        const std::size_t i = static_cast<std::size_t>(seen->y) * width_ + seen->x;
        if (!(std::abs(frame.depth.metres[i] - seen->metres) < kSameSurface_m)) continue;
        LitPlace place;
        place.normal = normal;
        place.group = v < parts.size() ? static_cast<std::uint8_t>(parts[v]) : 0;
        for (int k = 0; k < 3; ++k)
            place.color[k] = imaging::linear_from_srgb(
                static_cast<float>(frame.color.pixels[4 * i + k]) / 255.0f);
        out.push_back(place);
    }
}

void LivePicture::follow_light(const pipeline::SensorFrame& frame, std::span<const LitPlace> places,
                               double dt_s) {
    if (frame.color.empty()) return;
    tone_ = picture_tone(frame.color);
    const PictureLight seen = estimate_light(places, tone_, light_);
    light_ = blended(light_, seen, static_cast<float>(1.0 - std::exp(-dt_s / kLightTime_s)));
}

void LivePicture::draw_mirror(std::span<WornMeshes* const> worn, float scale) {
    const int width =
        std::max(16, static_cast<int>(std::lround(scale * static_cast<float>(width_))));
    const int height =
        std::max(16, static_cast<int>(std::lround(scale * static_cast<float>(height_))));
    if (renderer_.width() != width || renderer_.height() != height) renderer_.resize(width, height);
    scene_.instances.clear();
    scene_.camera = render::camera_from_intrinsics(rigid(place_), camera_.fx, camera_.fy,
                                                   camera_.cx, camera_.cy, width_, height_);
    for (const WornMeshes* one : worn)
        one->add_to(scene_, has_color_ ? BodyDrawn::picture : BodyDrawn::avatar);
    scene_.background = {};
    if (has_color_) {
        scene_.background.kind = render::Background::Kind::camera;
        scene_.background.picture = picture_;
        scene_.background.depth = depth_;
        scene_.background.depth_tolerance = kTolerance_m;
        // A smaller picture is averaged over more of the camera's pixels.
        scene_.background.noise = tone_.noise * std::min(scale, 1.0f);
        scene_.background.noise_seed = sequence_;
        scene_.lighting = lighting_of(light_);
    } else {
        scene_.lighting = render::studio_lighting(scene_.camera);
    }
    spoil_scene();
    renderer_.draw(scene_);
}

void LivePicture::spoil_scene() {
    if (spoil_ == Spoil::occlusion) scene_.background.depth = render::TextureId::none;
    for (render::Instance& instance : scene_.instances) {
        if (spoil_ == Spoil::shadows) instance.casts_shadow = false;
        if (spoil_ == Spoil::shift && instance.draw == render::Instance::Draw::visible)
            instance.world_from_mesh.translation += Vec3f(0.01f, 0.0f, 0.0f);
    }
}

imaging::Image LivePicture::cloth_mask(std::span<WornMeshes* const> worn) {
    imaging::Image black{width_, height_, {}};
    black.pixels.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4,
                        0);
    const render::TextureId nothing = renderer_.add_texture(black, false);
    draw_mirror(worn, 1.0f);
    for (render::Instance& instance : scene_.instances)
        if (instance.draw == render::Instance::Draw::receiver)
            instance.draw = render::Instance::Draw::occluder;
    scene_.background.picture = nothing;
    scene_.background.noise = 0.0f;
    scene_.lighting.sky = scene_.lighting.ground = Vec3f::Constant(100.0f);
    renderer_.draw(scene_);
    renderer_.remove_texture(nothing);
    return renderer_.read();
}

void LivePicture::draw_studio(const WornMeshes& worn, float azimuth_deg, const render::Box& box,
                              int width, int height) {
    if (renderer_.width() != width || renderer_.height() != height) renderer_.resize(width, height);
    scene_.instances.clear();
    worn.add_to(scene_, BodyDrawn::avatar);
    scene_.background = {};
    scene_.camera =
        render::frame_view({"turned", azimuth_deg, 4.0f}, box.low, box.high, width, height);
    scene_.lighting = render::studio_lighting(scene_.camera);
    renderer_.draw(scene_);
}

} // namespace toile::apps::kiosk
