#include "body/body_file.h"

#include "body/measurer.h"
#include "core/bytes.h"
#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toile::body {
namespace {

constexpr std::int64_t kSchema = 1;
constexpr std::size_t kMostBytes = 8u << 20;
constexpr double kDetailStep = 1e-5; // metres: what a file keeps of the detail
constexpr double kMostDetail = 20000.0;
constexpr std::size_t kMostCoefficients = 1000;
constexpr double kMostDeviations = 100.0; // of a coefficient; nobody is beyond 10
constexpr double kFarthest = 1000.0;      // metres: where the hips may be

std::vector<double> coefficients_of(JsonObject& object) {
    const nlohmann::json& list = object.any("coefficients");
    if (!list.is_array() || list.size() > kMostCoefficients)
        throw object.error("coefficients", "must be a list of at most 1000 numbers");
    auto out = object.numbers("coefficients", list.size());
    for (const double value : out)
        if (std::abs(value) > kMostDeviations)
            throw object.error("coefficients", "has a value beyond 100 deviations");
    return out;
}

std::vector<float> detail_in(JsonObject& object) {
    const nlohmann::json& list = object.any("detail");
    if (!list.is_array()) throw object.error("detail", "must be a list of whole numbers");
    std::vector<float> out;
    for (const auto& value : list) {
        const double steps = value.is_number_integer() ? value.get<double>() : kMostDetail + 1.0;
        if (std::abs(steps) > kMostDetail)
            throw object.error("detail", "must hold whole numbers within +-20000 (0.01 mm each)");
        out.push_back(static_cast<float>(kDetailStep * steps));
    }
    return out;
}

Pose pose_in(JsonObject pose) {
    Pose out;
    const auto place = pose.numbers("hips_position", 3);
    for (const double metres : place)
        if (std::abs(metres) > kFarthest) throw pose.error("hips_position", "is over 1000 m away");
    out.hips_position = Vec3d(place[0], place[1], place[2]).cast<float>();
    JsonObject rotations = pose.object("rotations");
    for (const auto& name : rotations.keys()) {
        const auto joint = joint_from_name(name);
        if (!joint) throw rotations.error(name, "is no joint");
        const auto q = rotations.numbers(name, 4);
        const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
        if (std::abs(rotation.norm() - 1.0) > 1e-3)
            throw rotations.error(name, "is not a unit quaternion (x y z w)");
        out.rotations[static_cast<std::size_t>(*joint)] = rotation.normalized().cast<float>();
    }
    rotations.finish();
    pose.finish();
    return out;
}

nlohmann::ordered_json pose_out(const Pose& pose) {
    nlohmann::ordered_json out;
    const Vec3f& p = pose.hips_position;
    out["hips_position"] = {p.x(), p.y(), p.z()};
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const Quatf& q = pose.rotations[j];
        out["rotations"][std::string(joint_name(static_cast<Joint>(j)))] = {q.x(), q.y(), q.z(),
                                                                            q.w()};
    }
    return out;
}

void check_version(const BodyFile& body, const BodyModel& model) {
    const auto major = [](const std::string& version) {
        return version.substr(0, version.find('.'));
    };
    if (major(model.version) != major(body.model_version))
        throw Error("the body was made with version " + body.model_version + " of '" + body.model +
                    "'; here is " + model.version + ", whose coefficients mean other bodies");
}

/// Moves a surface (nv) by its detail, and stands it on the floor again; no detail: nothing.
void shift_along_normals(std::span<const float> detail, std::span<const Vec3f> normals,
                         std::span<Vec3f> positions, Skeleton& skeleton) {
    if (detail.empty()) return;
    if (detail.size() != positions.size())
        throw Error("the body's detail is for " + std::to_string(detail.size()) +
                    " vertices; its model has " + std::to_string(positions.size()));
    float floor = std::numeric_limits<float>::max();
    for (std::size_t v = 0; v < positions.size(); ++v) {
        positions[v] += detail[v] * normals[v];
        floor = std::min(floor, positions[v].y());
    }
    for (Vec3f& p : positions)
        p.y() -= floor;
    for (Vec3f& p : skeleton.rest_positions)
        p.y() -= floor;
}

} // namespace

bool is_body_file(const std::filesystem::path& file) {
    return file.extension() == ".json";
}

BodyFile load_body_file(const std::filesystem::path& file) {
    const nlohmann::json json = parse_json_file(file, kMostBytes);
    JsonObject object(json, file.string());
    object.integer("schema", kSchema, kSchema);
    BodyFile out;
    out.model = object.text("model");
    out.model_version = object.text("model_version");
    out.made_by = object.text("made_by");
    if (object.has("sex")) {
        const std::string sex = object.text("sex");
        if (sex != "female" && sex != "male")
            throw object.error("sex", "must be \"female\" or \"male\"");
        out.sex = sex == "female" ? Sex::female : Sex::male;
    }
    out.coefficients = coefficients_of(object);
    if (object.has("detail")) out.detail = detail_in(object);
    if (object.has("pose")) out.pose = pose_in(object.object("pose"));
    if (object.has("measurements")) {
        JsonObject measurements = object.object("measurements");
        for (const auto& name : measurements.keys()) {
            JsonObject row = measurements.object(name);
            BodyFile::Length& length = out.measurements[name];
            length.value_m = row.number("value", 0.0, 10.0);
            length.confidence = row.number("confidence", 0.0, 1.0);
            row.finish();
        }
        measurements.finish();
    }
    if (object.has("fit")) out.fit = object.any("fit");
    object.finish();
    return out;
}

void save_body_file(const BodyFile& body, const std::filesystem::path& file) {
    nlohmann::ordered_json json;
    json["schema"] = kSchema;
    json["model"] = body.model;
    json["model_version"] = body.model_version;
    json["made_by"] = body.made_by;
    if (body.sex) json["sex"] = sex_name(*body.sex);
    json["coefficients"] = body.coefficients;
    if (body.pose) json["pose"] = pose_out(*body.pose);
    for (const auto& [name, length] : body.measurements)
        json["measurements"][name] = {{"value", length.value_m}, {"confidence", length.confidence}};
    if (!body.fit.is_null()) json["fit"] = body.fit;
    if (!body.detail.empty()) {
        std::vector<std::int64_t> steps;
        steps.reserve(body.detail.size());
        for (const float d : body.detail)
            steps.push_back(std::llround(static_cast<double>(d) / kDetailStep));
        json["detail"] = steps;
    }
    // One line a key: the long lists are not for reading.
    std::string text = "{";
    for (const auto& [key, value] : json.items())
        text += std::string(text.size() > 1 ? "," : "") + "\n  " +
                nlohmann::ordered_json(key).dump() + ": " +
                (key == "detail" || key == "coefficients" ? value.dump() : value.dump(2));
    write_text(file, text + "\n}\n");
}

BodyShape shape_of(const BodyFile& body, const BodySpace& space) {
    BodyShape out = space.shape(body.coefficients);
    shift_along_normals(body.detail, space.model().rest.normals, out.positions, out.skeleton);
    return out;
}

BodyModel model_of(const BodyFile& body) {
    const std::filesystem::path folder = find_avatar(body.model);
    const bool has_space = std::filesystem::exists(folder / "space.json");
    BodyModel out;
    if (has_space) {
        const BodySpace space = BodySpace::load(folder);
        check_version(body, space.model());
        BodyShape shape = shape_of(body, space);
        out = space.body(body.coefficients);
        out.rest.positions = std::move(shape.positions);
        out.skeleton = shape.skeleton;
    } else {
        out = load_body_model(folder);
        check_version(body, out);
        if (!body.coefficients.empty())
            throw Error("the body has " + std::to_string(body.coefficients.size()) +
                        " shape coefficients; '" + body.model + "' is one body and takes none");
        shift_along_normals(body.detail, out.rest.normals, out.rest.positions, out.skeleton);
    }
    geometry::vertex_normals(out.rest.positions, out.rest.triangles, out.rest.normals);
    out.measurements = as_map(Measurer(out).measure(out.rest.positions, out.skeleton));
    return out;
}

BodyModel load_body(const std::filesystem::path& file) {
    const BodyFile body = load_body_file(file);
    try {
        return model_of(body);
    } catch (const JsonError&) {
        throw; // of the model's own files
    } catch (const Error& e) {
        throw FileError(file.string(), e.what());
    }
}

std::vector<float> detail_of(const BodySpace& space, std::span<const double> coefficients,
                             std::span<const Vec3f> rest, const Skeleton& skeleton) {
    const BodyShape plain = space.shape(coefficients);
    const auto& normals = space.model().rest.normals;
    if (rest.size() != plain.positions.size())
        throw Error("a surface of " + std::to_string(rest.size()) +
                    " vertices is not on the topology of '" + space.model().id + "'");
    // The joints tell how much deeper one stands than the other.
    const Vec3f lifted = skeleton.rest(Joint::hips) - plain.skeleton.rest(Joint::hips);
    std::vector<float> out;
    for (std::size_t v = 0; v < rest.size(); ++v)
        out.push_back(normals[v].dot(rest[v] - plain.positions[v] - lifted));
    return out;
}

} // namespace toile::body
