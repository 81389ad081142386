#include "imaging/capture_folder.h"

#include "core/bytes.h"
#include "core/json.h"
#include "imaging/rig_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>

namespace toile::imaging {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTimestampBytes = 64u << 20;
constexpr double kDefaultPeriod = 1.0 / 30.0;

void read_intrinsics(const fs::path& file, CaptureCamera& camera) {
    const nlohmann::json json = parse_json_file(file, 1u << 20);
    JsonObject root(json, file.string());
    Intrinsics& in = camera.intrinsics;
    in.width = static_cast<int>(root.integer("width", 1, 16384));
    in.height = static_cast<int>(root.integer("height", 1, 16384));
    const std::vector<double> m = root.numbers("intrinsic_matrix", 9);
    camera.depth_scale = root.number_or("depth_scale", 1e-3, 1e7, 1000.0);
    if (root.has("distortion")) {
        const std::vector<double> d = root.numbers("distortion", 8);
        std::copy(d.begin(), d.end(), in.distortion.begin());
    }
    root.finish();
    if (m[1] != 0.0 || m[2] != 0.0 || m[3] != 0.0 || m[5] != 0.0 || m[8] != 1.0)
        throw root.error("intrinsic_matrix", "must be fx 0 0 0 fy 0 cx cy 1 (column-major)");
    in.fx = m[0];
    in.fy = m[4];
    in.cx = m[6];
    in.cy = m[7];
    try {
        check_intrinsics(in);
    } catch (const Error& e) {
        throw root.error("intrinsic_matrix", e.what());
    }
}

Eigen::Isometry3d read_extrinsics(const fs::path& file) {
    const nlohmann::json json = parse_json_file(file, 1u << 20);
    JsonObject root(json, file.string());
    const Eigen::Isometry3d out = read_rigid_motion(root, "world_from_camera");
    root.finish();
    return out;
}

double parse_number(std::string_view text, const std::string& where) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) throw Error(where + ": a number is missing");
    text = text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw Error(where + ": '" + std::string(text.substr(0, 40)) + "' is not a finite number");
    return value;
}

std::map<std::uint32_t, double> read_timestamps(const fs::path& file) {
    const std::vector<std::uint8_t> bytes = read_bytes(file, kMaxTimestampBytes);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::map<std::uint32_t, double> times;
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        if (number == 1 && line.rfind("frame", 0) == 0) continue; // a heading
        const std::string where = file.string() + ": line " + std::to_string(number);
        const std::size_t comma = line.find(',');
        if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos)
            throw Error(where + ": expected 'frame,seconds'");
        const double frame = parse_number(line.substr(0, comma), where);
        const double time = parse_number(line.substr(comma + 1), where);
        if (frame != std::floor(frame) || frame < 0.0 || frame > 4e9)
            throw Error(where + ": the frame is not a whole number of at least 0");
        if (time <= last) throw Error(where + ": times do not rise");
        if (!times.emplace(static_cast<std::uint32_t>(frame), time).second)
            throw Error(where + ": the frame stands twice");
        last = time;
    }
    return times;
}

// Pictures of one kind by frame number; names must be digits with one of the extensions.
std::map<std::uint32_t, fs::path> list_pictures(const fs::path& folder,
                                                std::initializer_list<const char*> extensions) {
    std::map<std::uint32_t, fs::path> files;
    if (!fs::exists(folder)) return files;
    if (!fs::is_directory(folder)) throw FileError(folder.string(), "is not a folder");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const fs::path& file = entry.path();
        const std::string stem = file.stem().string();
        const std::string extension = file.extension().string();
        std::uint32_t number = 0;
        const auto [end, problem] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
        const bool known =
            std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
        if (!known || problem != std::errc() || end != stem.data() + stem.size() || stem.size() < 6)
            throw FileError(file.string(), "is not a frame (six digits and ." +
                                               std::string(*extensions.begin() + 1) + ")");
        if (!files.emplace(number, file).second)
            throw FileError(file.string(), "the frame stands there twice");
    }
    return files;
}

fs::path take(std::map<std::uint32_t, fs::path>& files, std::uint32_t number) {
    const auto it = files.find(number);
    if (it == files.end()) return {};
    fs::path file = it->second;
    files.erase(it);
    return file;
}

CaptureCamera open_camera(const fs::path& folder, std::string name) {
    CaptureCamera camera;
    camera.name = std::move(name);
    read_intrinsics(folder / "intrinsic.json", camera);
    if (fs::exists(folder / "extrinsic.json"))
        camera.world_from_camera = read_extrinsics(folder / "extrinsic.json");
    const bool timed = fs::exists(folder / "timestamps.csv");
    std::map<std::uint32_t, double> times;
    if (timed) times = read_timestamps(folder / "timestamps.csv");

    const auto depth = list_pictures(folder / "depth", {".png"});
    auto color = list_pictures(folder / "color", {".jpg", ".png", ".jpeg"});
    auto mask = list_pictures(folder / "mask", {".png"});
    if (depth.empty()) throw FileError((folder / "depth").string(), "holds no frames");
    for (const auto& [number, file] : depth) {
        CaptureFrame frame{number, number * kDefaultPeriod, file, take(color, number),
                           take(mask, number)};
        if (timed) {
            const auto time = times.find(number);
            if (time == times.end())
                throw FileError((folder / "timestamps.csv").string(),
                                "has no time for frame " + std::to_string(number));
            frame.time_s = time->second;
            times.erase(time);
        }
        if (!camera.frames.empty() && frame.time_s <= camera.frames.back().time_s)
            throw FileError((folder / "timestamps.csv").string(),
                            "times do not rise with the frames");
        camera.frames.push_back(std::move(frame));
    }
    if (!times.empty())
        throw FileError((folder / "depth").string(),
                        "has no picture for frame " + std::to_string(times.begin()->first));
    for (const auto* rest : {&color, &mask})
        if (!rest->empty())
            throw FileError(rest->begin()->second.string(), "has no depth picture beside it");
    return camera;
}

template <typename Picture>
void check_size(const Picture& picture, const Intrinsics& in, const fs::path& file) {
    if (picture.width != in.width || picture.height != in.height)
        throw FileError(file.string(), "is " + std::to_string(picture.width) + " x " +
                                           std::to_string(picture.height) + " pixels, the camera " +
                                           std::to_string(in.width) + " x " +
                                           std::to_string(in.height));
}

void make_folder(const fs::path& folder) {
    std::error_code problem;
    fs::create_directories(folder, problem);
    if (problem) throw FileError(folder.string(), "cannot be made: " + problem.message());
}

} // namespace

DepthImage CaptureCamera::load_depth(std::size_t frame) const {
    DepthImage depth = imaging::load_depth(frames.at(frame).depth, depth_scale);
    check_size(depth, intrinsics, frames[frame].depth);
    return depth;
}

std::optional<Image> CaptureCamera::load_color(std::size_t frame) const {
    if (frames.at(frame).color.empty()) return std::nullopt;
    Image image = load_image(frames[frame].color);
    check_size(image, intrinsics, frames[frame].color);
    return image;
}

std::optional<Image> CaptureCamera::load_mask(std::size_t frame) const {
    if (frames.at(frame).mask.empty()) return std::nullopt;
    Image image = load_image(frames[frame].mask);
    check_size(image, intrinsics, frames[frame].mask);
    return image;
}

Capture open_capture(const fs::path& folder) {
    if (!fs::is_directory(folder)) throw FileError(folder.string(), "no such capture folder");
    Capture capture{folder, {}};
    if (fs::exists(folder / "intrinsic.json")) {
        capture.cameras.push_back(open_camera(folder, ""));
        return capture;
    }
    std::vector<fs::path> below;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_directory() && fs::exists(entry.path() / "intrinsic.json"))
            below.push_back(entry.path());
    if (below.empty())
        throw FileError(folder.string(),
                        "not a capture folder (no intrinsic.json in it or in a folder below)");
    std::sort(below.begin(), below.end());
    for (const fs::path& camera : below)
        capture.cameras.push_back(open_camera(camera, camera.filename().string()));
    return capture;
}

CaptureWriter::CaptureWriter(fs::path folder, const Intrinsics& intrinsics,
                             const std::optional<Eigen::Isometry3d>& world_from_camera,
                             double depth_scale)
    : folder_(std::move(folder)), intrinsics_(intrinsics), depth_scale_(depth_scale) {
    check_intrinsics(intrinsics);
    if (fs::exists(folder_ / "intrinsic.json"))
        throw FileError(folder_.string(), "already holds a capture; choose another folder");
    make_folder(folder_ / "depth");
    nlohmann::json json;
    json["width"] = intrinsics.width;
    json["height"] = intrinsics.height;
    json["intrinsic_matrix"] = {intrinsics.fx, 0, 0, 0, intrinsics.fy, 0, intrinsics.cx,
                                intrinsics.cy, 1};
    json["depth_scale"] = depth_scale;
    if (intrinsics.distorted()) json["distortion"] = intrinsics.distortion;
    write_text(folder_ / "intrinsic.json", json.dump(2) + "\n");
    if (world_from_camera) {
        const Eigen::Matrix4d m = world_from_camera->matrix();
        nlohmann::json extrinsic;
        extrinsic["world_from_camera"] = std::vector<double>(m.data(), m.data() + 16);
        write_text(folder_ / "extrinsic.json", extrinsic.dump(2) + "\n");
    }
}

void CaptureWriter::add(double time_s, const DepthImage& depth, const Image* color,
                        const Image* mask) {
    if (!std::isfinite(time_s) || (count_ > 0 && time_s <= last_time_s_))
        throw FileError(folder_.string(), "frame " + std::to_string(count_) +
                                              ": its time does not come after the one before");
    std::string name = std::to_string(count_);
    name.insert(0, name.size() < 6 ? 6 - name.size() : 0, '0');
    check_size(depth, intrinsics_, folder_ / "depth" / (name + ".png"));
    save_depth(depth, folder_ / "depth" / (name + ".png"), depth_scale_);
    if (color != nullptr) {
        make_folder(folder_ / "color");
        check_size(*color, intrinsics_, folder_ / "color" / (name + ".jpg"));
        save_image(*color, folder_ / "color" / (name + ".jpg"));
    }
    if (mask != nullptr) {
        make_folder(folder_ / "mask");
        check_size(*mask, intrinsics_, folder_ / "mask" / (name + ".png"));
        save_image(*mask, folder_ / "mask" / (name + ".png"));
    }
    char seconds[32];
    const auto end = std::to_chars(seconds, seconds + sizeof seconds, time_s).ptr;
    std::ofstream stream(folder_ / "timestamps.csv", std::ios::app);
    stream << count_ << ',' << std::string_view(seconds, static_cast<std::size_t>(end - seconds))
           << '\n';
    stream.close();
    if (!stream) throw FileError((folder_ / "timestamps.csv").string(), "cannot be written");
    last_time_s_ = time_s;
    ++count_;
}

} // namespace toile::imaging
