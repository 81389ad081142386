#include "assets/files.h"
#include "body/test_person.h"
#include "core/bytes.h"
#include "core/json.h"

#include <algorithm>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchema = 1;
constexpr double kFar = 10.0; // metres

std::vector<double> numbers(const Vec3f& v) {
    return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}

Vec3f vector(const std::vector<double>& n) {
    return Vec3d(n[0], n[1], n[2]).cast<float>();
}

/// Surface and eyes on the rig; the eyes hang on the head's bone.
assets::Scene scene_of(const TestPerson& person) {
    assets::Scene scene;
    assets::Skin skin;
    skin.name = "rig";
    for (const TestPersonBone& bone : person.bones) {
        assets::Node node;
        node.name = bone.name;
        node.parent = bone.parent;
        node.translation =
            bone.parent < 0
                ? bone.head
                : Vec3f(bone.head - person.bones[static_cast<std::size_t>(bone.parent)].head);
        skin.joints.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back(node);
        Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
        inverse.topRightCorner<3, 1>() = -bone.head;
        skin.inverse_bind.push_back(inverse);
    }
    scene.skins.push_back(skin);

    assets::Primitive body;
    body.positions = person.rest.positions;
    body.normals = person.rest.normals;
    body.triangles = person.rest.triangles;
    for (const auto& row : person.weights) {
        std::array<std::uint16_t, 4> joints{};
        std::array<float, 4> weights{};
        for (std::size_t k = 0; k < std::min<std::size_t>(4, row.size()); ++k) {
            joints[k] = static_cast<std::uint16_t>(row[k].bone);
            weights[k] = row[k].weight;
        }
        body.joints.push_back(joints);
        body.weights.push_back(weights);
    }
    assets::Primitive eyes;
    eyes.positions = person.eyes.positions;
    eyes.triangles = person.eyes.triangles;
    const auto head = std::find_if(person.bones.begin(), person.bones.end(),
                                   [](const TestPersonBone& b) { return b.name == "head"; });
    eyes.joints.assign(eyes.positions.size(),
                       {static_cast<std::uint16_t>(head - person.bones.begin()), 0, 0, 0});
    eyes.weights.assign(eyes.positions.size(), {1.0f, 0.0f, 0.0f, 0.0f});
    for (auto& [name, primitive] : {std::pair{"body", &body}, {"eyes", &eyes}}) {
        assets::Node node;
        node.name = name;
        node.mesh = static_cast<int>(scene.meshes.size());
        node.skin = 0;
        scene.nodes.push_back(node);
        scene.meshes.push_back({name, {std::move(*primitive)}, {}});
    }
    return scene;
}

void read_scene(const fs::path& file, TestPerson& person) {
    assets::Scene scene = assets::load_scene(file);
    if (scene.meshes.size() != 2 || scene.skins.empty() || scene.meshes[0].primitives.size() != 1 ||
        scene.meshes[1].primitives.size() != 1 || scene.meshes[0].primitives[0].joints.empty())
        throw FileError(file.string(), "is no test person: a skinned body and eyes are expected");
    const assets::Skin& skin = scene.skins.front();
    for (std::size_t b = 0; b < skin.joints.size(); ++b) {
        const assets::Node& node = scene.nodes[static_cast<std::size_t>(skin.joints[b])];
        const auto parent = std::find(skin.joints.begin(), skin.joints.end(), node.parent);
        const bool root = parent == skin.joints.end();
        if (!root && parent - skin.joints.begin() >= static_cast<std::ptrdiff_t>(b))
            throw FileError(file.string(), "a bone stands before its parent");
        person.bones.push_back({node.name,
                                root ? -1 : static_cast<int>(parent - skin.joints.begin()),
                                Vec3f(-skin.inverse_bind[b].topRightCorner<3, 1>())});
    }
    assets::Primitive& body = scene.meshes[0].primitives[0];
    person.rest = {std::move(body.positions), std::move(body.normals), std::move(body.triangles)};
    const auto report = geometry::check_topology(person.rest.positions, person.rest.triangles);
    if (!report.closed()) throw FileError(file.string(), "its body is not a closed surface");
    for (std::size_t v = 0; v < body.joints.size(); ++v) {
        std::vector<BoneWeight> row;
        for (std::size_t k = 0; k < 4; ++k)
            if (body.weights[v][k] > 0.0f)
                row.push_back({static_cast<int>(body.joints[v][k]), body.weights[v][k]});
        person.weights.push_back(std::move(row));
    }
    person.eyes.positions = scene.meshes[1].primitives[0].positions;
    person.eyes.triangles = scene.meshes[1].primitives[0].triangles;
}

nlohmann::ordered_json json_of(const TestPerson& person) {
    nlohmann::ordered_json json;
    json["schema"] = kSchema;
    json["id"] = person.id;
    json["sex"] = person.woman ? "female" : "male";
    json["displacement_m"] = person.displacement_m;
    json["volume_m3"] = person.volume_m3;
    json["bmi"] = person.bmi;
    json["recipe"] = person.recipe;
    for (std::size_t j = 0; j < kJointCount; ++j)
        json["joints"][std::string(joint_name(static_cast<Joint>(j)))] =
            numbers(person.skeleton.rest_positions[j]);
    json["landmarks"] = person.landmarks;
    for (const GirthPlane& plane : person.girths)
        json["girths"].push_back({{"name", plane.name},
                                  {"joint", std::string(joint_name(plane.joint))},
                                  {"point", numbers(plane.point)},
                                  {"normal", numbers(plane.normal)},
                                  {"girth_m", plane.girth}});
    json["lengths"] = person.lengths;
    // Runs of equal labels over the vertices, as in avatar.json.
    for (std::size_t v = 0; v < person.parts.size();) {
        std::size_t end = v;
        while (end < person.parts.size() && person.parts[end] == person.parts[v])
            ++end;
        json["parts"].push_back(
            {{"part", std::string(part_label(person.parts[v]))}, {"count", end - v}});
        v = end;
    }
    return json;
}

std::vector<Part> read_parts(JsonObject& root, std::size_t vertices) {
    std::vector<Part> out;
    for (JsonObject& run : root.objects("parts")) {
        const auto part = part_from_label(run.text("part"));
        if (!part) throw run.error("part", "is none of the 12 body parts");
        const auto count = run.integer("count", 1, static_cast<std::int64_t>(vertices));
        out.insert(out.end(), static_cast<std::size_t>(count), *part);
        run.finish();
    }
    if (out.size() != vertices)
        throw root.error("parts", "label " + std::to_string(out.size()) +
                                      " vertices, the body has " + std::to_string(vertices));
    return out;
}

GirthPlane read_girth(JsonObject& entry) {
    GirthPlane out;
    out.name = entry.text("name");
    const std::string name = entry.text("joint");
    const auto joint = joint_from_name(name);
    if (!joint) throw entry.error("joint", "'" + name + "' is none of the 22 joints");
    out.joint = *joint;
    out.point = vector(entry.numbers("point", 3));
    out.normal = vector(entry.numbers("normal", 3));
    out.girth = entry.number("girth_m", 0.0, kFar);
    entry.finish();
    if (std::abs(out.normal.norm() - 1.0f) > 1e-3f)
        throw entry.error("normal", "is not of unit length");
    return out;
}

} // namespace

void save_test_person(const TestPerson& person, const fs::path& folder) {
    std::error_code problem;
    fs::create_directories(folder, problem);
    if (problem) throw FileError(folder.string(), "cannot be made: " + problem.message());
    assets::save_scene(scene_of(person), folder / "person.glb");
    write_text(folder / "person.json", json_of(person).dump(2) + "\n");
}

TestPerson load_test_person(const fs::path& folder) {
    const fs::path file = folder / "person.json";
    const nlohmann::json json = parse_json_file(file);
    JsonObject root(json, file.string());
    TestPerson person;
    root.integer("schema", kSchema, kSchema);
    person.id = root.text("id");
    const std::string sex = root.text("sex");
    if (sex != "female" && sex != "male") throw root.error("sex", "must be 'female' or 'male'");
    person.woman = sex == "female";
    person.displacement_m = root.number("displacement_m", 0.0, 1.0);
    person.volume_m3 = root.number("volume_m3", 0.0, kFar);
    person.bmi = root.number("bmi", 0.0, 1e3);
    JsonObject recipe = root.object("recipe");
    for (const std::string& name : recipe.keys())
        person.recipe[name] = recipe.number(name, -kFar, kFar);
    JsonObject joints = root.object("joints");
    for (std::size_t j = 0; j < kJointCount; ++j)
        person.skeleton.rest_positions[j] =
            vector(joints.numbers(std::string(joint_name(static_cast<Joint>(j))), 3));
    joints.finish();
    read_scene(folder / "person.glb", person);
    const auto vertices = person.rest.positions.size();
    JsonObject landmarks = root.object("landmarks");
    for (const std::string& name : landmarks.keys())
        person.landmarks[name] = static_cast<std::uint32_t>(
            landmarks.integer(name, 0, static_cast<std::int64_t>(vertices) - 1));
    for (JsonObject& entry : root.objects("girths"))
        person.girths.push_back(read_girth(entry));
    JsonObject lengths = root.object("lengths");
    for (const char* needed : {"stature", "crotch_height"})
        (void)lengths.number(needed, 0.0, kFar);
    for (const std::string& name : lengths.keys())
        person.lengths[name] = lengths.number(name, 0.0, kFar);
    person.parts = read_parts(root, vertices);
    root.finish();
    return person;
}

} // namespace toile::body
