#include "simulated_sensor/scenario.h"

#include "core/json.h"
#include "imaging/srgb.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

namespace toile::simulated_sensor {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchema = 1;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar = 100.0; // metres
constexpr std::int64_t kMostFrames = 1'000'000;
constexpr std::size_t kMostOfAKind = 16; // people, cameras
constexpr std::size_t kMostCoefficients = 200;
constexpr double kFarthestShape = 100.0; // deviations

/// What helps to read one file: its folder for relative paths.
struct Reader {
    fs::path folder;

    [[nodiscard]] fs::path path(JsonObject& at, const std::string& key) const {
        return existing(at, key, at.text(key));
    }
    [[nodiscard]] fs::path existing(const JsonObject& at, const std::string& key,
                                    const std::string& text) const {
        if (text.empty()) throw at.error(key, "names no file");
        const fs::path path = fs::path(text).is_absolute() ? fs::path(text) : folder / text;
        std::error_code code;
        if (!fs::exists(path, code)) throw at.error(key, "there is no " + path.string());
        return path;
    }
};

Vec3f point_or(JsonObject& at, const std::string& key, const Vec3f& fallback) {
    if (!at.has(key)) return fallback;
    const auto n = at.numbers(key, 3);
    for (const double v : n)
        if (std::abs(v) > kFar) throw at.error(key, "lies more than 100 m away");
    return Vec3d(n[0], n[1], n[2]).cast<float>();
}

double degrees_or(JsonObject& at, const std::string& key, double fallback = 0.0) {
    return kDegree * at.number_or(key, -3600.0, 3600.0, fallback / kDegree);
}

bool switch_or(JsonObject& at, const std::string& key, bool fallback) {
    return at.has(key) ? at.boolean(key) : fallback;
}

/// "#rrggbb" (sRGB) as linear light.
Vec3f color_or(JsonObject& at, const std::string& key, const Vec3f& fallback) {
    if (!at.has(key)) return fallback;
    const std::string text = at.text(key);
    unsigned value = 0;
    const char* end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#' ||
        std::from_chars(text.data() + 1, end, value, 16).ptr != end)
        throw at.error(key, "'" + text + "' is no colour; write #rrggbb");
    Vec3f out;
    for (int k = 0; k < 3; ++k)
        out[k] =
            imaging::linear_from_srgb(static_cast<float>(value >> (16 - 8 * k) & 255u) / 255.0f);
    return out;
}

NoiseSettings read_noise(JsonObject noise, const NoiseSettings& before, CameraModel model) {
    NoiseSettings out = before;
    if (noise.has("preset")) {
        const std::string preset = noise.text("preset");
        if (preset == "none")
            out = no_noise();
        else if (preset == "usual")
            out = usual_noise(model);
        else if (preset == "full")
            out = full_noise(model);
        else
            throw noise.error("preset", "'" + preset + "' is none of none, usual, full");
    }
    out.axial = noise.number_or("axial", 0.0, 10.0, out.axial);
    out.lateral = noise.number_or("lateral", 0.0, 10.0, out.lateral);
    out.quantisation = switch_or(noise, "quantisation", out.quantisation);
    out.shadow = switch_or(noise, "shadow", out.shadow);
    out.ragged = switch_or(noise, "ragged", out.ragged);
    out.holes = noise.number_or("holes", 0.0, 0.9, out.holes);
    out.color = noise.number_or("color", 0.0, 10.0, out.color);
    out.correlated = switch_or(noise, "correlated", out.correlated);
    out.depth_scale = noise.number_or("depth_scale", 0.0, 0.1, out.depth_scale);
    out.extrinsic_rotation = kDegree * noise.number_or("extrinsic_rotation_deg", 0.0, 30.0,
                                                       out.extrinsic_rotation / kDegree);
    out.extrinsic_translation_m =
        noise.number_or("extrinsic_translation_m", 0.0, 1.0, out.extrinsic_translation_m);
    noise.finish();
    return out;
}

CameraSettings read_camera(JsonObject& camera, JsonObject& root, std::size_t number) {
    const std::string name = camera.text_or("model", "kinect_v1");
    const auto model = camera_model_from_name(name);
    if (!model) throw camera.error("model", "'" + name + "' is neither kinect_v1 nor kinect_v2");
    CameraSettings out = camera_of(*model);
    out.name = camera.text_or("name", "camera" + std::to_string(number));
    if (out.name.empty() || out.name.size() > 64 ||
        out.name.find_first_not_of(
            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") !=
            std::string::npos)
        throw camera.error("name",
                           "must be 1 to 64 letters, digits, _ or -: a folder is called so");
    const std::string mount = camera.text_or("mount", "landscape");
    if (mount != "landscape" && mount != "upright")
        throw camera.error("mount", "'" + mount + "' is neither landscape nor upright");
    out.upright = mount == "upright";
    const Vec3f position = point_or(camera, "position", Vec3f(0.0f, 1.0f, 2.4f));
    const Vec3f target = point_or(camera, "look_at", Vec3f(0.0f, position.y(), 0.0f));
    try {
        out.world_from_camera =
            look_at(position.cast<double>(), target.cast<double>(), degrees_or(camera, "roll_deg"));
    } catch (const JsonError&) {
        throw;
    } catch (const Error& e) {
        throw camera.error("look_at", e.what());
    }
    out.nearest_m = camera.number_or("nearest_m", 0.1, 20.0, out.nearest_m);
    out.farthest_m = camera.number_or("farthest_m", 0.2, 60.0, out.farthest_m);
    if (!(out.nearest_m < out.farthest_m))
        throw camera.error("farthest_m", "must lie beyond nearest_m");
    if (root.has("noise")) out.noise = read_noise(root.object("noise"), out.noise, *model);
    if (camera.has("noise")) out.noise = read_noise(camera.object("noise"), out.noise, *model);
    camera.finish();
    return out;
}

void read_body(JsonObject body, const Reader& reader, PersonSettings& out) {
    constexpr std::array<std::pair<const char*, BodyKind>, 4> kinds = {
        {{"avatar", BodyKind::avatar},
         {"mesh", BodyKind::mesh},
         {"surfaces", BodyKind::surfaces},
         {"test_person", BodyKind::test_person}}};
    for (const auto& [key, kind] : kinds) {
        if (!body.has(key)) continue;
        if (out.kind != BodyKind::invalid) throw body.error(key, "stands beside another body");
        out.kind = kind;
        if (kind != BodyKind::avatar) {
            out.source = reader.path(body, key);
            continue;
        }
        const std::string id = body.text(key);
        std::error_code code;
        try {
            out.source = fs::is_directory(id, code) ? fs::path(id) : body::find_avatar(id);
        } catch (const Error& e) {
            throw body.error(key, e.what());
        }
    }
    if (out.kind == BodyKind::invalid)
        throw body.error("", "names no body: avatar, mesh, surfaces or test_person");
    if (body.has("shape")) {
        const auto count = body.any("shape").size();
        if (count > kMostCoefficients) throw body.error("shape", "has more than 200 coefficients");
        out.shape = body.numbers("shape", count);
        for (const double c : out.shape)
            if (std::abs(c) > kFarthestShape)
                throw body.error("shape", "has a value beyond 100 deviations");
        if (out.kind != BodyKind::avatar) throw body.error("shape", "belongs to an avatar");
    }
    body.finish();
}

void read_carried(JsonObject& person, const Reader& reader, PersonSettings& out) {
    if (!person.has("carries")) return;
    for (JsonObject& thing : person.objects("carries")) {
        CarriedSettings& made = out.carried.emplace_back();
        made.mesh = reader.path(thing, "mesh");
        const std::string joint = thing.text("joint");
        const auto found = body::joint_from_name(joint);
        if (!found) throw thing.error("joint", "'" + joint + "' is no joint, as leftHand is one");
        made.joint = *found;
        made.position = point_or(thing, "position", made.position);
        made.color = color_or(thing, "color", made.color);
        thing.finish();
    }
}

PersonSettings read_person(JsonObject& person, const Reader& reader) {
    PersonSettings out;
    read_body(person.object("body"), reader, out);
    const bool moves = out.kind == BodyKind::avatar || out.kind == BodyKind::test_person;
    if (person.has("motion")) out.motion = reader.path(person, "motion");
    if (person.has("poses"))
        for (const std::string& pose : person.texts("poses"))
            out.poses.push_back(reader.existing(person, "poses", pose));
    if (!moves && (!out.motion.empty() || !out.poses.empty()))
        throw person.error(out.motion.empty() ? "poses" : "motion",
                           "only an avatar or a test person can be posed");
    if (!out.motion.empty() && !out.poses.empty())
        throw person.error("poses", "stand beside a motion; write one of them");
    out.hold_s = person.number_or("hold_s", 0.0, 3600.0, out.hold_s);
    out.change_s = person.number_or("change_s", 0.0, 3600.0, out.change_s);
    out.turntable_s = person.number_or("turntable_s", 0.0, 3600.0, out.turntable_s);
    out.breath_m = person.number_or("breath_m", 0.0, 0.05, out.breath_m);
    if (!moves && out.breath_m > 0.0)
        throw person.error("breath_m", "only an avatar or a test person breathes");
    out.position = point_or(person, "position", out.position);
    out.turn = degrees_or(person, "turn_deg");
    if (person.has("hair")) {
        JsonObject hair = person.object("hair");
        out.hair = HairSettings{};
        out.hair->thickness_m = static_cast<float>(
            hair.number_or("thickness_m", 0.0, 0.1, static_cast<double>(out.hair->thickness_m)));
        out.hair->color = color_or(hair, "color", out.hair->color);
        hair.finish();
        if (!moves) throw person.error("hair", "needs an avatar or a test person");
    }
    if (person.has("skin")) out.skin = color_or(person, "skin", Vec3f::Ones());
    out.suit = switch_or(person, "suit", out.suit);
    if (out.suit && out.kind != BodyKind::test_person)
        throw person.error("suit", "only a test person has one");
    read_carried(person, reader, out);
    if (!moves && !out.carried.empty())
        throw person.error("carries", "needs an avatar or a test person");
    person.finish();
    return out;
}

SceneSettings read_scene(JsonObject scene, const Reader& reader) {
    SceneSettings out;
    out.floor = switch_or(scene, "floor", out.floor);
    out.floor_color = color_or(scene, "floor_color", out.floor_color);
    if (scene.has("walls"))
        for (JsonObject& wall : scene.objects("walls")) {
            WallSettings made;
            made.position = point_or(wall, "position", made.position);
            made.turn = degrees_or(wall, "turn_deg");
            made.width_m = wall.number_or("width_m", 0.1, kFar, made.width_m);
            made.height_m = wall.number_or("height_m", 0.1, kFar, made.height_m);
            made.color = color_or(wall, "color", made.color);
            wall.finish();
            out.walls.push_back(made);
        }
    if (scene.has("objects"))
        for (JsonObject& object : scene.objects("objects")) {
            ObjectSettings made;
            made.mesh = reader.path(object, "mesh");
            made.position = point_or(object, "position", made.position);
            made.turn = degrees_or(object, "turn_deg");
            made.color = color_or(object, "color", made.color);
            object.finish();
            out.objects.push_back(made);
        }
    if (scene.has("lamp")) {
        JsonObject lamp = scene.object("lamp");
        out.lighting.lamp_position = point_or(lamp, "position", out.lighting.lamp_position);
        const Vec3f color = color_or(lamp, "color", Vec3f(1.0f, 0.94f, 0.84f));
        out.lighting.lamp_color =
            static_cast<float>(lamp.number_or("strength", 0.0, 100.0, 5.0)) * color;
        lamp.finish();
    }
    if (scene.has("ambient"))
        out.lighting.ambient_color =
            static_cast<float>(scene.number("ambient", 0.0, 10.0)) * Vec3f(0.94f, 1.0f, 1.1f);
    scene.finish();
    return out;
}

} // namespace

Scenario load_scenario(const fs::path& file) {
    std::error_code code;
    if (!fs::is_regular_file(file, code)) throw FileError(file.string(), "no such scenario");
    const nlohmann::json json = parse_json_file(file);
    JsonObject root(json, file.string());
    const Reader reader{file.parent_path()};
    Scenario out;
    root.integer("schema", kSchema, kSchema);
    out.name = root.text_or("name", file.stem().string());
    out.seed = static_cast<std::uint64_t>(
        root.integer_or("seed", 0, std::numeric_limits<std::int64_t>::max(), 1));
    out.frames = static_cast<std::uint32_t>(root.integer_or("frames", 1, kMostFrames, 1));
    out.frames_per_second = root.number_or("frames_per_second", 0.01, 1000.0, 30.0);
    out.color = switch_or(root, "color", true);
    if (root.has("people"))
        for (JsonObject& person : root.objects("people"))
            out.people.push_back(read_person(person, reader));
    if (root.has("scene")) out.scene = read_scene(root.object("scene"), reader);
    std::set<std::string> names;
    for (JsonObject& camera : root.objects("cameras")) {
        out.cameras.push_back(read_camera(camera, root, out.cameras.size()));
        if (!names.insert(out.cameras.back().name).second)
            throw camera.error("name", "'" + out.cameras.back().name + "' stands twice");
    }
    if (out.cameras.empty()) throw root.error("cameras", "there is none");
    for (const auto& [key, count] :
         {std::pair{"cameras", out.cameras.size()}, {"people", out.people.size()}})
        if (count > kMostOfAKind) throw root.error(key, "more than 16 are too many");
    root.finish();
    return out;
}

} // namespace toile::simulated_sensor
