#include "body/track_file.h"

#include "body/motion_readers.h"
#include "core/json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

namespace toile::body {

namespace {

constexpr std::array<std::string_view, 5> kStates = {"", "detected", "tracked", "uncertain",
                                                     "lost"};

void append_number(std::string& out, double value) {
    if (!std::isfinite(value)) throw Error("track: a value is not finite");
    std::array<char, 64> text{};
    const auto [end, status] =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 6);
    if (status != std::errc()) throw Error("track: a value is too large");
    std::string_view digits(text.data(), static_cast<std::size_t>(end - text.data()));
    while (digits.ends_with('0'))
        digits.remove_suffix(1);
    if (digits.ends_with('.')) digits.remove_suffix(1);
    out += digits == "-0" ? std::string_view("0") : digits;
}

template <class Values>
void append_array(std::string& out, const Values& values, Eigen::Index count) {
    out += '[';
    for (Eigen::Index k = 0; k < count; ++k) {
        if (k > 0) out += ',';
        append_number(out, static_cast<double>(values[k]));
    }
    out += ']';
}

/// World transforms of one person's joints. Joints may be missing: they go with their parents.
void read_joints(JsonObject& entry, TrackedPerson& person) {
    JsonObject joints = entry.object("joints");
    for (std::size_t j = 0; j < kJointCount; ++j) {
        const std::string name(joint_name(static_cast<Joint>(j)));
        const auto parent = joint_parent(static_cast<Joint>(j));
        if (!joints.has(name)) {
            if (!parent) throw joints.error(name, "missing");
            person.joints[j] = person.joints[static_cast<std::size_t>(*parent)];
            continue;
        }
        JsonObject joint = joints.object(name);
        const auto p = joint.numbers("position", 3);
        const auto q = joint.numbers("rotation", 4);
        person.confidence[j] = static_cast<float>(joint.number_or("confidence", 0.0, 1.0, 1.0));
        joint.finish();
        const Quatf rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).cast<float>();
        if (std::abs(rotation.norm() - 1.0f) > 0.01f)
            throw joints.error(name, "rotation is not a unit quaternion");
        person.joints[j] = {rotation.normalized(), Vec3d(p[0], p[1], p[2]).cast<float>()};
    }
    joints.finish();
}

TrackedPerson read_person(JsonObject& entry) {
    TrackedPerson person;
    person.id = static_cast<std::uint32_t>(entry.integer("id", 1, UINT32_MAX));
    const std::string state = entry.text("state");
    const auto known = std::find(kStates.begin() + 1, kStates.end(), state);
    if (known == kStates.end())
        throw entry.error("state", "is '" + state + "', not a state of tracking");
    person.state = static_cast<TrackState>(known - kStates.begin());
    read_joints(entry, person);
    entry.finish();
    return person;
}

TrackFrame read_line(const std::string& line, const std::string& place) {
    const nlohmann::json json = parse_json(line, place);
    JsonObject entry(json, place);
    TrackFrame out;
    out.frame = static_cast<std::uint64_t>(entry.integer("frame", 0, std::int64_t{1} << 53));
    out.time_s = entry.number("time_s", -1e9, 1e9);
    for (JsonObject& person : entry.objects("people"))
        out.people.push_back(read_person(person));
    entry.finish();
    return out;
}

} // namespace

std::string_view track_state_name(TrackState state) {
    return kStates[static_cast<std::size_t>(state)];
}

std::string track_line(std::uint64_t frame, double time_s, std::span<const TrackedPerson> people) {
    std::string out = "{\"frame\":" + std::to_string(frame) + ",\"time_s\":";
    append_number(out, time_s);
    out += ",\"people\":[";
    for (const TrackedPerson& person : people) {
        if (&person != people.data()) out += ',';
        out += "{\"id\":" + std::to_string(person.id) + ",\"state\":\"";
        out += track_state_name(person.state);
        out += "\",\"joints\":{";
        for (std::size_t j = 0; j < kJointCount; ++j) {
            if (j > 0) out += ',';
            out += '"';
            out += joint_name(static_cast<Joint>(j));
            out += "\":{\"position\":";
            append_array(out, person.joints[j].translation, 3);
            out += ",\"rotation\":";
            append_array(out, person.joints[j].rotation.coeffs(), 4);
            out += ",\"confidence\":";
            append_number(out, static_cast<double>(person.confidence[j]));
            out += '}';
        }
        out += "}}";
    }
    out += "]}\n";
    return out;
}

std::vector<TrackFrame> read_track_frames(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw FileError(file.string(), "cannot be read");
    std::vector<TrackFrame> frames;
    for (std::string line; std::getline(in, line);) {
        const std::string place = file.string() + ": line " + std::to_string(frames.size() + 1);
        frames.push_back(read_line(line, place));
    }
    return frames;
}

Motion read_track(const std::filesystem::path& file, const Skeleton&) {
    Motion motion;
    motion.name = file.stem().string();
    double start = 0.0;
    std::uint32_t followed = 0;
    std::size_t number = 0;
    for (const TrackFrame& frame : read_track_frames(file)) {
        ++number;
        if (motion.times.empty()) start = frame.time_s;
        const double last = motion.times.empty() ? -1.0 : motion.times.back();
        Pose pose = motion.poses.empty() ? Pose() : motion.poses.back();
        bool found = !motion.poses.empty();
        for (const TrackedPerson& person : frame.people) {
            if (followed == 0) followed = person.id;
            if (person.id != followed || person.state == TrackState::lost) continue;
            pose = pose_from_world(person.joints);
            found = true;
        }
        if (!found) continue; // nobody yet
        if (frame.time_s - start <= last)
            throw JsonError(file.string() + ": line " + std::to_string(number),
                            "/time_s: is not after the line before");
        motion.times.push_back(frame.time_s - start);
        motion.poses.push_back(pose);
    }
    return motion;
}

} // namespace toile::body
