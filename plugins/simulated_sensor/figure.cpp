#include "simulated_sensor/figure.h"

#include "assets/files.h"
#include "assets/skins.h"
#include "body/body_model.h"
#include "body/motion.h"
#include "body/skinning.h"
#include "body/test_person.h"
#include "core/error.h"
#include "simulated_sensor/breath.h"
#include "simulated_sensor/color_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::simulated_sensor {
namespace {

namespace fs = std::filesystem;
using body::SurfaceRole;

const Vec3f kSkinTone(0.47f, 0.27f, 0.18f); // linear
const Vec3f kEyeTone(0.6f, 0.57f, 0.53f);
const Vec3f kLayerTone(0.16f, 0.17f, 0.19f); // of a painted base layer
const Vec3f kSuitTone(0.45f, 0.40f, 0.38f);
constexpr float kBelowNeck = 0.07f;   // metres: where it begins
constexpr float kBelowCrotch = 0.12f; // and where it ends

RigidTransform turn_about_y(double angle, const Vec3f& position) {
    return {Quatf(Eigen::AngleAxisf(static_cast<float>(angle), Vec3f::UnitY())), position};
}

/// A primitive welded to one vertex a place, with its texture.
struct WeldedSurface {
    FigureSurface figure;
    std::vector<std::uint32_t> welded; ///< vertex of each of the primitive's own
};

SurfaceLook look_of(const assets::Scene& scene, int material, Grain grain) {
    SurfaceLook look;
    look.grain = grain;
    if (material == assets::kNone) return look;
    const assets::Material& from = scene.materials[static_cast<std::size_t>(material)];
    look.albedo = from.base_color.head<3>();
    if (from.base_color_texture != assets::kNone)
        look.texture = std::make_shared<imaging::Image>(
            scene.textures[static_cast<std::size_t>(from.base_color_texture)].image);
    return look;
}

std::vector<Vec2f> corners_of(std::span<const Triangle> triangles, std::span<const Vec2f> coords) {
    std::vector<Vec2f> out;
    if (coords.empty()) return out;
    out.reserve(3 * triangles.size());
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t)
            out.push_back(coords[v]);
    return out;
}

WeldedSurface weld(const assets::Scene& scene, const assets::Primitive& primitive,
                   const std::string& name, Grain grain) {
    const std::vector<Vec2f> none(primitive.texcoords.empty() ? primitive.positions.size() : 0,
                                  Vec2f::Zero());
    geometry::SeamedLayout layout;
    geometry::TriangleMesh mesh =
        geometry::weld(primitive.positions, primitive.triangles,
                       primitive.texcoords.empty() ? none : primitive.texcoords, layout);
    WeldedSurface out;
    out.welded = layout.welded;
    out.figure.surface = {name, mesh.triangles,
                          corners_of(primitive.triangles, primitive.texcoords), mesh.positions,
                          look_of(scene, primitive.material, grain)};
    out.figure.positions = std::move(mesh.positions);
    return out;
}

/// The motion that a person's settings ask for; a single pose is a motion of one.
body::Motion motion_of(const PersonSettings& settings, const body::Skeleton& skeleton,
                       const body::BodyVolumes* volumes) {
    if (!settings.motion.empty()) return body::load_motion(settings.motion, skeleton, volumes);
    body::Motion motion;
    double time = 0.0;
    const auto add = [&](double at, const body::Pose& pose) {
        if (!motion.times.empty() && !(at > motion.times.back())) return;
        motion.times.push_back(at);
        motion.poses.push_back(pose);
    };
    for (const fs::path& file : settings.poses) {
        const body::Pose pose = body::load_pose(file, skeleton, volumes);
        if (!motion.times.empty()) time += std::max(settings.change_s, 1e-6);
        add(time, pose);
        time += settings.hold_s;
        add(time, pose);
    }
    if (motion.times.empty()) add(0.0, body::rest_pose(skeleton));
    return motion;
}

void place_all(std::span<const Vec3f> from, const RigidTransform& place, std::vector<Vec3f>& to) {
    std::transform(from.begin(), from.end(), to.begin(), [&](const Vec3f& p) { return place * p; });
}

/// An avatar with shape coefficients, skinned by linear blending.
class AvatarFigure : public Figure {
  public:
    explicit AvatarFigure(const PersonSettings& settings)
        : Figure(settings), model_(body::load_body_model(settings.source)) {
        apply_shape();
        const auto volumes =
            body::measure_volumes(model_.skeleton, model_.rest.positions, model_.parts);
        motion_ = motion_of(settings, model_.skeleton, &volumes);
        skin_.emplace(model_.rest.positions, model_.rest.normals, model_.skin.joints,
                      model_.skin.weights);
        normals_.resize(model_.rest.positions.size());
        breath_ = Breath(settings.breath_m, model_.rest, model_.parts, model_.skeleton);

        const assets::Scene scene = assets::load_scene(model_.folder / (model_.id + ".glb"));
        SurfaceLook look = look_of(scene, scene.materials.empty() ? assets::kNone : 0, Grain::skin);
        if (settings.skin) look = {*settings.skin, nullptr, Grain::skin};
        surfaces_.push_back({{model_.id, model_.rest.triangles,
                              corners_of(model_.layout.triangles, model_.layout.texcoords),
                              model_.rest.positions, look},
                             model_.rest.positions,
                             SurfaceRole::body});
        if (!settings.hair) return;
        hair_.emplace(*settings.hair, model_.rest.positions, model_.rest.triangles, model_.parts);
        surfaces_.push_back({hair_->surface(), hair_->surface().rest, SurfaceRole::other});
    }

  private:
    void apply_shape() {
        if (settings_.shape.size() > model_.shape.size())
            throw Error("avatar '" + model_.id + "' has " + std::to_string(model_.shape.size()) +
                        " shape components, the scenario gives " +
                        std::to_string(settings_.shape.size()) + " coefficients");
        for (std::size_t c = 0; c < settings_.shape.size(); ++c) {
            const auto amount = static_cast<float>(settings_.shape[c]);
            for (std::size_t v = 0; v < model_.rest.positions.size(); ++v)
                model_.rest.positions[v] += amount * model_.shape[c].vertex_offsets[v];
            for (std::size_t j = 0; j < body::kJointCount; ++j)
                model_.skeleton.rest_positions[j] += amount * model_.shape[c].joint_offsets[j];
        }
        geometry::vertex_normals(model_.rest.positions, model_.rest.triangles, model_.rest.normals);
    }

    void pose_at(double time_s, const RigidTransform& place) override {
        body::JointTransforms world =
            body::forward_kinematics(model_.skeleton, body::sample(motion_, time_s));
        for (RigidTransform& joint : world)
            joint = place * joint;
        joints_ = world;
        FigureSurface& body = surfaces_.front();
        skin_->pose(body::skinning_transforms(model_.skeleton, world),
                    body::SkinningMethod::linear_blend, body::VectorRows(body.positions),
                    body::VectorRows(normals_));
        breath_.move(time_s, model_.rest.triangles, body.positions);
        if (!hair_) return;
        const auto posed = hair_->pose(body.positions, normals_);
        surfaces_[1].positions.assign(posed.begin(), posed.end());
    }

    body::BodyModel model_;
    body::Motion motion_;
    std::optional<body::SkinnedSurface> skin_;
    std::vector<Vec3f> normals_;
    Breath breath_;
    std::optional<HairCap> hair_;
};

/// Skin, and a base layer painted on trunk and thighs as avatars have one; `suit`: a printed one on
/// everything but head and neck.
std::vector<Vec3f> paint(const body::TestPerson& person, const Vec3f& skin, bool suit) {
    const float top = person.skeleton.rest(body::Joint::neck).y() - kBelowNeck;
    const float bottom = static_cast<float>(person.lengths.at("crotch_height")) - kBelowCrotch;
    std::vector<Vec3f> out(person.rest.positions.size(), skin);
    for (std::size_t v = 0; v < out.size(); ++v) {
        const body::Part part = person.parts[v];
        const float y = person.rest.positions[v].y();
        const bool trunk = part == body::Part::torso || part == body::Part::pelvis ||
                           part == body::Part::left_upper_leg ||
                           part == body::Part::right_upper_leg;
        if (trunk && y < top && y > bottom) out[v] = kLayerTone;
        if (suit && part != body::Part::head && part != body::Part::neck)
            out[v] = kSuitTone.cwiseProduct(grain_color(Grain::print, person.rest.positions[v]));
    }
    return out;
}

/// A person made outside of the body space.
class TestPersonFigure : public Figure {
  public:
    explicit TestPersonFigure(const PersonSettings& settings)
        : Figure(settings), person_(body::load_test_person(settings.source)), poser_(person_) {
        motion_ = motion_of(settings, person_.skeleton, nullptr);
        breath_ = Breath(settings.breath_m, person_.rest, person_.parts, person_.skeleton);
        surfaces_.push_back({{person_.id,
                              person_.rest.triangles,
                              {},
                              person_.rest.positions,
                              {Vec3f::Ones(), nullptr, Grain::skin},
                              paint(person_, settings.skin.value_or(kSkinTone), settings.suit)},
                             person_.rest.positions,
                             SurfaceRole::body});
        surfaces_.push_back({{"eyes",
                              person_.eyes.triangles,
                              {},
                              person_.eyes.positions,
                              {kEyeTone, nullptr, Grain::plain}},
                             person_.eyes.positions,
                             SurfaceRole::other});
        if (!settings.hair) return;
        normals_.resize(person_.rest.positions.size());
        hair_.emplace(*settings.hair, person_.rest.positions, person_.rest.triangles,
                      person_.parts);
        surfaces_.push_back({hair_->surface(), hair_->surface().rest, SurfaceRole::other});
    }

  private:
    void pose_at(double time_s, const RigidTransform& place) override {
        poser_.pose(body::sample(motion_, time_s), place);
        joints_ = poser_.joints();
        surfaces_[0].positions.assign(poser_.positions().begin(), poser_.positions().end());
        breath_.move(time_s, person_.rest.triangles, surfaces_[0].positions);
        surfaces_[1].positions.assign(poser_.eyes().begin(), poser_.eyes().end());
        if (!hair_) return;
        geometry::vertex_normals(surfaces_[0].positions, person_.rest.triangles, normals_);
        const auto posed = hair_->pose(surfaces_[0].positions, normals_);
        surfaces_[2].positions.assign(posed.begin(), posed.end());
    }

    body::TestPerson person_;
    body::TestPersonPoser poser_;
    body::Motion motion_;
    Breath breath_;
    std::vector<Vec3f> normals_;
    std::optional<HairCap> hair_;
};

/// A rigid mesh.
class MeshFigure : public Figure {
  public:
    explicit MeshFigure(const PersonSettings& settings) : Figure(settings) {
        surfaces_ = load_surfaces(settings.source);
        for (FigureSurface& surface : surfaces_) {
            surface.role = SurfaceRole::body;
            surface.surface.look.grain = Grain::skin;
            if (settings.skin) surface.surface.look = {*settings.skin, nullptr, Grain::skin};
        }
    }

  private:
    void pose_at(double, const RigidTransform& place) override {
        for (FigureSurface& surface : surfaces_)
            place_all(surface.surface.rest, place, surface.positions);
    }
};

/// A dressed person from a surface cache: the frame that was last at each time.
class CachedFigure : public Figure {
  public:
    explicit CachedFigure(const PersonSettings& settings)
        : Figure(settings), cache_(body::open_surface_cache(settings.source)) {
        for (const body::CachedSurface& cached : cache_.surfaces) {
            const bool body = cached.role == SurfaceRole::body;
            const auto& primitive = cache_.scene.meshes[cached.mesh].primitives[cached.primitive];
            WeldedSurface made =
                weld(cache_.scene, primitive, cached.name, body ? Grain::skin : Grain::cloth);
            made.figure.role = cached.role;
            if (body && settings.skin)
                made.figure.surface.look = {*settings.skin, nullptr, Grain::skin};
            surfaces_.push_back(std::move(made.figure));
            welded_.push_back(std::move(made.welded));
        }
    }

  private:
    void pose_at(double time_s, const RigidTransform& place) override {
        const auto after =
            std::upper_bound(cache_.frames.begin(), cache_.frames.end(),
                             time_s + cache_.frames.front().time_s + 1e-6,
                             [](double t, const body::TrackFrame& f) { return t < f.time_s; });
        const auto frame = static_cast<std::size_t>(
            std::max<std::ptrdiff_t>(0, after - cache_.frames.begin() - 1));
        if (frame != loaded_) cache_.load(frame, positions_);
        loaded_ = frame;
        for (std::size_t s = 0; s < surfaces_.size(); ++s)
            for (std::size_t v = 0; v < welded_[s].size(); ++v)
                surfaces_[s].positions[welded_[s][v]] = place * positions_[s][v];
        joints_.reset();
        if (cache_.frames[frame].people.empty()) return;
        joints_ = cache_.frames[frame].people.front().joints;
        for (RigidTransform& joint : *joints_)
            joint = place * joint;
    }

    body::SurfaceCache cache_;
    std::vector<std::vector<std::uint32_t>> welded_;
    std::vector<std::vector<Vec3f>> positions_;
    std::size_t loaded_ = SIZE_MAX;
};

} // namespace

void Figure::pose(double time_s) {
    const double spin =
        settings_.turntable_s > 0.0 ? 2.0 * std::numbers::pi * time_s / settings_.turntable_s : 0.0;
    pose_at(time_s, turn_about_y(settings_.turn + spin, settings_.position));
    for (const Carried& thing : carried_)
        if (joints_)
            place_all(surfaces_[thing.surface].surface.rest,
                      (*joints_)[static_cast<std::size_t>(thing.joint)],
                      surfaces_[thing.surface].positions);
}

void Figure::take_up(const std::vector<CarriedSettings>& things) {
    for (const CarriedSettings& thing : things)
        for (FigureSurface& surface : load_surfaces(thing.mesh)) {
            for (Vec3f& p : surface.surface.rest)
                p += thing.position; // in the joint's frame, which is the person's at rest
            if (!surface.surface.look.texture)
                surface.surface.look = {thing.color, nullptr, Grain::cloth};
            surface.role = SurfaceRole::other;
            carried_.push_back({surfaces_.size(), thing.joint});
            surfaces_.push_back(std::move(surface));
        }
}

std::unique_ptr<Figure> make_figure(const PersonSettings& settings) {
    std::unique_ptr<Figure> out;
    switch (settings.kind) {
    case BodyKind::avatar:
        out = std::make_unique<AvatarFigure>(settings);
        break;
    case BodyKind::mesh:
        out = std::make_unique<MeshFigure>(settings);
        break;
    case BodyKind::surfaces:
        out = std::make_unique<CachedFigure>(settings);
        break;
    case BodyKind::test_person:
        out = std::make_unique<TestPersonFigure>(settings);
        break;
    default:
        throw Error("a person of the scenario has no body");
    }
    out->take_up(settings.carried);
    return out;
}

std::vector<FigureSurface> load_surfaces(const fs::path& mesh) {
    const assets::Scene scene = assets::load_scene(mesh);
    const auto world = assets::node_transforms(scene);
    std::vector<FigureSurface> out;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        const assets::Node& node = scene.nodes[n];
        if (node.mesh == assets::kNone) continue;
        const assets::Mesh& from = scene.meshes[static_cast<std::size_t>(node.mesh)];
        for (const assets::Primitive& primitive : from.primitives) {
            if (primitive.triangles.empty()) continue;
            WeldedSurface made = weld(scene, primitive, from.name, Grain::plain);
            const bool skinned = node.skin != assets::kNone && !primitive.joints.empty();
            const auto posed =
                skinned ? assets::skinned_positions(
                              primitive, scene.skins[static_cast<std::size_t>(node.skin)], world)
                        : primitive.positions;
            for (std::size_t v = 0; v < posed.size(); ++v) {
                const Vec3f p = skinned
                                    ? posed[v]
                                    : Vec3f((world[n] * posed[v].homogeneous()).template head<3>());
                made.figure.positions[made.welded[v]] = p;
            }
            made.figure.surface.rest = made.figure.positions;
            out.push_back(std::move(made.figure));
        }
    }
    if (out.empty()) throw FileError(mesh.string(), "holds no triangles");
    return out;
}

} // namespace toile::simulated_sensor
