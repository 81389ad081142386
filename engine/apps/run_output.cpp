#include "apps/run_output.h"

#include "body/track_file.h"
#include "core/error.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <unistd.h>

namespace toile::apps {

TrackFile::TrackFile(const std::string& folder) {
    if (!folder.empty()) open(std::filesystem::path(folder) / "track.jsonl");
}

TrackFile TrackFile::named(const std::filesystem::path& file) {
    TrackFile out;
    out.open(file);
    return out;
}

void TrackFile::open(const std::filesystem::path& file) {
    std::error_code code;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), code);
    file_ = file.string();
    out_.open(file_, std::ios::binary);
    if (!out_) throw FileError(file_, "the track cannot be written");
}

void TrackFile::add(const pipeline::BodyFrame& frame) {
    write(frames_, frame.timestamp_ns, std::span(&frame, 1));
}

void TrackFile::add(std::uint32_t sequence, std::int64_t timestamp_ns,
                    std::span<const pipeline::BodyFrame> people) {
    if (frames_ == 0) first_sequence_ = sequence;
    write(sequence - first_sequence_, timestamp_ns, people);
}

void TrackFile::write(std::uint64_t number, std::int64_t timestamp_ns,
                      std::span<const pipeline::BodyFrame> people) {
    if (frames_++ == 0) first_ns_ = timestamp_ns;
    last_ns_ = timestamp_ns;
    if (file_.empty()) return;
    std::vector<body::TrackedPerson> told;
    for (const pipeline::BodyFrame& frame : people) {
        body::TrackedPerson& person = told.emplace_back();
        person.id = frame.person_id;
        person.state = static_cast<body::TrackState>(frame.tracking);
        person.joints = pipeline::transforms_of(frame.joints);
        for (std::size_t i = 0; i < frame.joints.size(); ++i)
            person.confidence[i] = frame.joints[i].confidence;
    }
    out_ << body::track_line(number, 1e-9 * static_cast<double>(last_ns_ - first_ns_), told);
    out_.flush();
    if (!out_) throw FileError(file_, "the track cannot be written (is the disk full?)");
}

double TrackFile::frames_per_second() const {
    constexpr double kUsual = 30.0;
    if (frames_ < 2 || last_ns_ <= first_ns_) return kUsual;
    return 1e9 * static_cast<double>(frames_ - 1) / static_cast<double>(last_ns_ - first_ns_);
}

RunProgress::RunProgress() : terminal_(isatty(STDERR_FILENO) != 0) {}

RunProgress::~RunProgress() {
    if (terminal_ && frames_ > 0) std::fputs("\n", stderr);
}

void RunProgress::frame() {
    ++frames_;
    if (terminal_) std::fprintf(stderr, "\rframe %llu", static_cast<unsigned long long>(frames_));
}

void put_out_report(pipeline::RunReport report, FittingRoom& room, const std::string& file) {
    report.versions["toile"] = TOILE_VERSION;
    report.versions["body " + room.body().model().id] = room.body().model().version;
    for (const pipeline::WornGarment& garment : room.person().garments()) {
        const auto& manifest = garment.garment().package().manifest;
        report.versions["garment " + manifest.id] = manifest.version;
    }
    for (const host::Manifest& plugin : room.registry().manifests())
        report.versions["plugin " + plugin.id] = plugin.version;
    std::fputs(pipeline::report_table(report).c_str(), stdout);
    if (!file.empty()) pipeline::write_report(report, file);
}

} // namespace toile::apps
