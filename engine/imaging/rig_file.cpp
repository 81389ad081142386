#include "imaging/rig_file.h"

#include "core/bytes.h"

#include <Eigen/Geometry>

namespace toile::imaging {

Eigen::Isometry3d read_rigid_motion(JsonObject& object, const std::string& key) {
    const std::vector<double> numbers = object.numbers(key, 16);
    const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix4d>(numbers.data());
    const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
    const bool rigid = (R * R.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-4) &&
                       R.determinant() > 0.0 && m.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
    if (!rigid) throw object.error(key, "is not a rigid motion (16 numbers, column-major)");
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    out.translation() = m.topRightCorner<3, 1>();
    return out;
}

RigFile load_rig(const std::filesystem::path& file) {
    const nlohmann::json json = parse_json_file(file, 1u << 20);
    JsonObject root(json, file.string());
    (void)root.integer("schema", 1, 1);
    RigFile out;
    out.method = root.text("method");
    for (JsonObject& camera : root.objects("cameras")) {
        out.cameras.push_back(
            {camera.text("name"), read_rigid_motion(camera, "world_from_camera")});
        camera.finish();
    }
    if (root.has("report")) out.report = root.any("report");
    root.finish();
    if (out.cameras.empty()) throw root.error("cameras", "names no camera");
    return out;
}

void save_rig(const RigFile& rig, const std::filesystem::path& file) {
    nlohmann::ordered_json json = {{"schema", 1}, {"method", rig.method}};
    json["cameras"] = nlohmann::ordered_json::array();
    for (const RigCamera& camera : rig.cameras) {
        const Eigen::Matrix4d& m = camera.world_from_camera.matrix();
        json["cameras"].push_back(
            {{"name", camera.name},
             {"world_from_camera", std::vector<double>(m.data(), m.data() + 16)}});
    }
    json["report"] = rig.report.is_object() ? rig.report : nlohmann::ordered_json::object();
    write_text(file, json.dump(2) + "\n");
}

} // namespace toile::imaging
