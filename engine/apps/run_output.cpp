#include "apps/run_output.h"

#include "body/track_file.h"
#include "core/error.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <unistd.h>

namespace toile::apps {

TrackFile::TrackFile(const std::string& folder) {
    if (folder.empty()) return;
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    file_ = (std::filesystem::path(folder) / "track.jsonl").string();
    out_.open(file_, std::ios::binary);
    if (!out_) throw FileError(file_, "the track cannot be written");
}

void TrackFile::add(const pipeline::BodyFrame& frame) {
    if (frames_ == 0) first_ns_ = frame.timestamp_ns;
    last_ns_ = frame.timestamp_ns;
    const std::uint64_t index = frames_++;
    if (file_.empty()) return;
    body::TrackedPerson person;
    person.id = frame.person_id;
    person.state = static_cast<body::TrackState>(frame.tracking);
    person.joints = pipeline::transforms_of(frame.joints);
    for (std::size_t i = 0; i < frame.joints.size(); ++i)
        person.confidence[i] = frame.joints[i].confidence;
    out_ << body::track_line(index, 1e-9 * static_cast<double>(last_ns_ - first_ns_),
                             std::span(&person, 1));
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
