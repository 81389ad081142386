#include "body/body_model.h"

#include "assets/files.h"
#include "body/body_file.h"
#include "core/json.h"
#include "core/paths.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace toile::body {
namespace {

namespace fs = std::filesystem;

constexpr float kWeightTolerance = 1e-4f; // a row's sum against 1
constexpr float kJointTolerance = 1e-4f;  // avatar.json against the nodes of the model, metres
constexpr std::int64_t kSchema = 1;
constexpr double kFarthest = 10.0; // metres: no body, and no step of a shape, is larger
constexpr const char* kTooFar = "is over 10 m away";

constexpr std::array<std::string_view, 13> kPartNames = {"invalid",
                                                         "head",
                                                         "torso",
                                                         "left_upper_arm",
                                                         "left_lower_arm",
                                                         "right_upper_arm",
                                                         "right_lower_arm",
                                                         "left_upper_leg",
                                                         "left_lower_leg",
                                                         "right_upper_leg",
                                                         "right_lower_leg",
                                                         "pelvis",
                                                         "neck"};

/// The surface of the model: exactly one skinned primitive.
struct ModelSurface {
    const assets::Primitive* primitive = nullptr;
    const assets::Skin* skin = nullptr;
};

ModelSurface find_surface(const assets::Scene& scene, const std::string& file) {
    ModelSurface out;
    for (const auto& node : scene.nodes) {
        if (node.mesh == assets::kNone) continue;
        const auto& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        if (out.primitive != nullptr || mesh.primitives.size() != 1)
            throw FileError(file, "has more than one surface; an avatar is one skinned primitive");
        if (node.skin == assets::kNone || mesh.primitives[0].joints.empty())
            throw FileError(file, "its surface has no skin");
        out.primitive = &mesh.primitives[0];
        out.skin = &scene.skins[static_cast<std::size_t>(node.skin)];
    }
    if (out.primitive == nullptr) throw FileError(file, "has no surface");
    return out;
}

/// Which of our joints each joint of the skin is; all 22 must be there once.
std::vector<Joint> map_joints(const assets::Scene& scene, const assets::Skin& skin,
                              const std::string& file) {
    std::vector<Joint> out;
    std::set<Joint> seen;
    for (const int node : skin.joints) {
        const auto& name = scene.nodes[static_cast<std::size_t>(node)].name;
        const auto joint = joint_from_name(name);
        if (!joint) throw FileError(file, "joint '" + name + "' is none of the 22 humanoid joints");
        if (!seen.insert(*joint).second) throw FileError(file, "joint '" + name + "' stands twice");
        out.push_back(*joint);
    }
    for (std::size_t j = 0; j < kJointCount; ++j)
        if (seen.count(static_cast<Joint>(j)) == 0)
            throw FileError(file, "joint '" + std::string(joint_name(static_cast<Joint>(j))) +
                                      "' is missing");
    return out;
}

/// Rest positions of the joints, from avatar.json; the nodes of the model must agree.
Skeleton read_skeleton(JsonObject joints, const assets::Scene& scene, const assets::Skin& skin,
                       const std::vector<Joint>& order) {
    Skeleton out;
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto p = joints.numbers(std::string(joint_name(static_cast<Joint>(j))), 3);
        for (const double x : p)
            if (std::abs(x) > kFarthest)
                throw joints.error(std::string(joint_name(static_cast<Joint>(j))), kTooFar);
        out.rest_positions[j] = Eigen::Vector3d(p[0], p[1], p[2]).cast<float>();
    }
    joints.finish();
    for (std::size_t i = 0; i < order.size(); ++i) {
        Vec3f world = Vec3f::Zero();
        for (int n = skin.joints[i]; n != assets::kNone;
             n = scene.nodes[static_cast<std::size_t>(n)].parent)
            world += scene.nodes[static_cast<std::size_t>(n)].translation;
        const std::string name(joint_name(order[i]));
        if (!((world - out.rest(order[i])).norm() < kJointTolerance))
            throw joints.error(name, "is not where the model has that joint");
    }
    return out;
}

SkinWeights read_weights(const assets::Primitive& primitive, const std::vector<Joint>& order,
                         const geometry::SeamedLayout& layout, std::size_t vertex_count,
                         const std::string& file) {
    SkinWeights out;
    out.joints.resize(vertex_count);
    out.weights.resize(vertex_count);
    for (std::size_t r = 0; r < primitive.positions.size(); ++r) {
        auto& joints = out.joints[layout.welded[r]];
        auto& weights = out.weights[layout.welded[r]];
        float sum = 0.0f;
        for (std::size_t k = 0; k < 4; ++k) {
            const bool used = primitive.weights[r][k] > 0.0f;
            joints[k] =
                used ? static_cast<std::uint16_t>(order[primitive.joints[r][k]]) : std::uint16_t{0};
            weights[k] = used ? primitive.weights[r][k] : 0.0f;
            sum += weights[k];
        }
        if (!(std::abs(sum - 1.0f) <= kWeightTolerance))
            throw FileError(file, "the weights of vertex " + std::to_string(r) + " sum to " +
                                      std::to_string(sum) + ", not 1");
    }
    return out;
}

/// Runs of equal labels over the vertices of the model file.
std::vector<Part> read_parts(std::vector<JsonObject> runs, const JsonObject& avatar,
                             const geometry::SeamedLayout& layout, std::size_t vertex_count) {
    std::vector<Part> out(vertex_count, Part::invalid);
    std::size_t r = 0;
    for (auto& run : runs) {
        const auto part = part_from_label(run.text("part"));
        if (!part) throw run.error("part", "is none of the 12 body parts");
        auto count = run.integer("count", 1, static_cast<std::int64_t>(layout.welded.size()));
        run.finish();
        for (; count > 0 && r < layout.welded.size(); --count)
            out[layout.welded[r++]] = *part;
        if (count > 0) throw avatar.error("parts", "label more vertices than the model has");
    }
    if (r < layout.welded.size()) throw avatar.error("parts", "leave vertices without a label");
    return out;
}

std::vector<ShapeComponent> read_shape(JsonObject& avatar, const assets::Primitive& primitive,
                                       const geometry::SeamedLayout& layout,
                                       std::size_t vertex_count) {
    std::vector<ShapeComponent> out;
    if (avatar.has("shape"))
        for (auto& entry : avatar.objects("shape")) {
            ShapeComponent component;
            component.name = entry.text("name");
            const auto joints = entry.numbers("joint_offsets", 3 * kJointCount);
            entry.finish();
            for (const double offset : joints)
                if (std::abs(offset) > kFarthest) throw entry.error("joint_offsets", kTooFar);
            for (std::size_t j = 0; j < kJointCount; ++j)
                component.joint_offsets[j] =
                    Eigen::Vector3d(joints[3 * j], joints[3 * j + 1], joints[3 * j + 2])
                        .cast<float>();
            out.push_back(std::move(component));
        }
    if (out.size() != primitive.morphs.size())
        throw avatar.error("shape", "names " + std::to_string(out.size()) +
                                        " components, the model has " +
                                        std::to_string(primitive.morphs.size()));
    for (std::size_t c = 0; c < out.size(); ++c) {
        out[c].vertex_offsets.resize(vertex_count);
        for (std::size_t r = 0; r < layout.welded.size(); ++r)
            out[c].vertex_offsets[layout.welded[r]] = primitive.morphs[c].positions[r];
    }
    return out;
}

/// \throw FileError for a point or an offset over 10 m from the origin
void check_size(std::span<const Vec3f> points, const std::string& what, const std::string& file) {
    for (const Vec3f& p : points)
        if (!(p.cwiseAbs().maxCoeff() <= static_cast<float>(kFarthest)))
            throw FileError(file, what + " " + kTooFar);
}

void check_surface(const geometry::TriangleMesh& mesh, const std::string& file) {
    check_size(mesh.positions, "a vertex", file);
    const auto report = geometry::check_topology(mesh.positions, mesh.triangles);
    if (!report.closed() || report.components != 1)
        throw FileError(file, "its surface is not closed and in one piece: " +
                                  (report.text().empty()
                                       ? std::to_string(report.boundary_edges) + " border edges, " +
                                             std::to_string(report.components) + " pieces"
                                       : report.text()));
}

} // namespace

std::string_view part_label(Part part) {
    return kPartNames.at(static_cast<std::size_t>(part));
}

std::optional<Part> part_from_label(std::string_view name) {
    for (std::size_t p = 1; p < kPartNames.size(); ++p)
        if (kPartNames[p] == name) return static_cast<Part>(p);
    return std::nullopt;
}

BodyModel load_body_model(const fs::path& folder) {
    const fs::path json_file = folder / "avatar.json";
    std::error_code code;
    if (const fs::path body = folder / "body.json";
        !fs::exists(json_file, code) && fs::exists(body, code)) {
        BodyModel out = load_body(body);
        out.id = fs::absolute(folder).lexically_normal().filename().string();
        return out;
    }
    const nlohmann::json json = parse_json_file(json_file);
    JsonObject avatar(json, json_file.string());
    BodyModel out;
    out.folder = folder;
    avatar.integer("schema", kSchema, kSchema);
    out.id = avatar.text("id");
    out.version = avatar.text("version");
    out.name = avatar.text("name");
    avatar.text("licence");
    const fs::path model_file = folder / avatar.file_name("model");
    out.appearance = model_file;
    const std::string model = model_file.string();

    const assets::Scene scene = assets::load_scene(model_file);
    const auto [primitive, skin] = find_surface(scene, model);
    out.rest = geometry::weld(primitive->positions, primitive->triangles, primitive->texcoords,
                              out.layout);
    check_surface(out.rest, model);
    const std::size_t vertex_count = out.rest.positions.size();
    out.rest.normals.resize(vertex_count);
    geometry::vertex_normals(out.rest.positions, out.rest.triangles, out.rest.normals);

    const auto order = map_joints(scene, *skin, model);
    out.skeleton = read_skeleton(avatar.object("joints"), scene, *skin, order);
    out.skin = read_weights(*primitive, order, out.layout, vertex_count, model);
    out.parts = read_parts(avatar.objects("parts"), avatar, out.layout, vertex_count);
    JsonObject landmarks = avatar.object("landmarks");
    for (const auto& name : landmarks.keys()) {
        const auto last = static_cast<std::int64_t>(out.layout.welded.size()) - 1;
        const auto vertex = static_cast<std::size_t>(landmarks.integer(name, 0, last));
        out.landmarks[name] = out.layout.welded[vertex];
    }
    JsonObject measurements = avatar.object("measurements");
    for (const auto& name : measurements.keys())
        out.measurements[name] = measurements.number(name, 0.0, kFarthest);
    out.shape = read_shape(avatar, *primitive, out.layout, vertex_count);
    for (const ShapeComponent& component : out.shape)
        check_size(component.vertex_offsets, "an offset of '" + component.name + "'", model);
    avatar.finish();
    return out;
}

namespace {

bool is_avatar(const fs::path& folder) {
    std::error_code code; // of a name that is too long for a file there is none
    return fs::exists(folder / "avatar.json", code) || fs::exists(folder / "body.json", code);
}

} // namespace

fs::path find_avatar(const std::string& id) {
    for (const auto& root : data_folders("avatars"))
        if (is_avatar(root / id)) return root / id;
    std::string known;
    for (const auto& other : list_avatars())
        known += (known.empty() ? "" : ", ") + other;
    throw Error("no avatar '" + id + "'; known: " + (known.empty() ? "none" : known));
}

std::vector<std::string> list_avatars() {
    std::set<std::string> ids;
    for (const auto& root : data_folders("avatars"))
        for (const auto& entry : fs::directory_iterator(root))
            if (is_avatar(entry.path())) ids.insert(entry.path().filename().string());
    return {ids.begin(), ids.end()};
}

} // namespace toile::body
