#include "apps/kiosk/config.h"

#include "apps/kiosk/whole_file.h"
#include "core/json.h"

namespace toile::apps::kiosk {
namespace {

constexpr int kLeastSide = 240;
constexpr int kMostSide = 8192;

std::filesystem::path beside(const std::filesystem::path& file, const std::string& path) {
    const std::filesystem::path named(path);
    return named.empty() || named.is_absolute() ? named : file.parent_path() / named;
}

bool boolean_or(JsonObject& json, const std::string& key, bool fallback) {
    return json.has(key) ? json.boolean(key) : fallback;
}

void read_mirror(JsonObject json, MirrorSettings& out) {
    out.scale = json.number_or("scale", 1.0, 4.0, out.scale);
    out.offset_x = json.number_or("offset_x", -0.5, 0.5, out.offset_x);
    out.offset_y = json.number_or("offset_y", -0.5, 0.5, out.offset_y);
    json.finish();
}

void read_camera(JsonObject json, CameraSettings& out) {
    out.height_m = json.number_or("height_m", 0.1, 4.0, out.height_m);
    out.tilt_deg = json.number_or("tilt_deg", -60.0, 60.0, out.tilt_deg);
    json.finish();
}

void read_times(JsonObject& json, KioskConfig& out) {
    out.dwell_s = json.number_or("dwell_s", 0.3, 10.0, out.dwell_s);
    out.away_s = json.number_or("away_s", 0.5, 60.0, out.away_s);
    out.patience_s = json.number_or("patience_s", 5.0, 600.0, out.patience_s);
    out.stall_s = json.number_or("stall_s", 0.5, 120.0, out.stall_s);
    out.operator_line_s = json.number_or("operator_line_s", 1.0, 3600.0, out.operator_line_s);
}

} // namespace

KioskConfig load_config(const std::filesystem::path& file) {
    const nlohmann::json parsed = parse_json_file(file);
    JsonObject json(parsed, file.string());
    KioskConfig out;
    (void)json.integer("schema", 1, 1);
    out.source = json.text_or("source", out.source);
    if (json.has("garments")) out.garments = json.texts("garments");
    out.garments_folder = beside(file, json.text_or("garments_folder", ""));
    out.language = json.text_or("language", out.language);
    out.width = static_cast<int>(json.integer_or("width", kLeastSide, kMostSide, out.width));
    out.height = static_cast<int>(json.integer_or("height", kLeastSide, kMostSide, out.height));
    out.fullscreen = boolean_or(json, "fullscreen", out.fullscreen);
    out.hide_cursor = boolean_or(json, "hide_cursor", out.hide_cursor);
    out.people = static_cast<std::uint32_t>(json.integer_or("people", 1, 2, out.people));
    out.measure = boolean_or(json, "measure", out.measure);
    read_times(json, out);
    if (json.has("mirror")) read_mirror(json.object("mirror"), out.mirror);
    if (json.has("camera")) read_camera(json.object("camera"), out.camera);
    out.metrics = beside(file, json.text_or("metrics", ""));
    out.snapshots = beside(file, json.text_or("snapshots", ""));
    out.watchdog = boolean_or(json, "watchdog", out.watchdog);
    json.finish();
    return out;
}

void save_setup(const std::filesystem::path& file, const MirrorSettings& mirror,
                const CameraSettings& camera) {
    nlohmann::json json = parse_json_file(file);
    json["mirror"] = {
        {"scale", mirror.scale}, {"offset_x", mirror.offset_x}, {"offset_y", mirror.offset_y}};
    json["camera"] = {{"height_m", camera.height_m}, {"tilt_deg", camera.tilt_deg}};
    write_whole(file, json.dump(4) + "\n");
}

} // namespace toile::apps::kiosk
