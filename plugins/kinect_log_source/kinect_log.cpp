#include "kinect_log_source/kinect_log.h"

#include "body/skeleton_tables.h"
#include "core/error.h"

#include <charconv>
#include <cmath>
#include <fstream>

namespace toile::kinect_log_source {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{512} << 20;
constexpr float kFarthest = 50.0f;

/// Reads one line's fields and says where it was when something is wrong.
class LineReader {
  public:
    LineReader(std::string_view line, std::size_t number, const std::string& file)
        : rest_(line), number_(number), file_(file) {}

    [[nodiscard]] FileError error(const std::string& what) const {
        return {file_, "line " + std::to_string(number_) + ": " + what};
    }

    template <class T>
    T number(const std::string& what) {
        const std::size_t comma = rest_.find(',');
        const std::string_view field = rest_.substr(0, comma);
        rest_ = comma == std::string_view::npos ? std::string_view() : rest_.substr(comma + 1);
        T value{};
        const auto [end, status] =
            std::from_chars(field.data(), field.data() + field.size(), value);
        if (status != std::errc() || end != field.data() + field.size()) {
            throw error(what + " is '" + std::string(field.substr(0, 40)) + "', not a number");
        }
        return value;
    }

  private:
    std::string_view rest_;
    std::size_t number_;
    const std::string& file_;
};

std::size_t count_fields(std::string_view line) {
    std::size_t count = 1;
    for (const char c : line)
        count += c == ',';
    return line.ends_with(',') ? count - 1 : count;
}

LoggedFrame read_frame(std::string_view line, std::size_t number, std::size_t joint_count,
                       const std::string& file) {
    const auto& table = joint_count == 20 ? body::kinect_v1_table() : body::kinect_v2_table();
    LineReader reader(line, number, file);
    LoggedFrame frame;
    frame.time_100ns = reader.number<std::int64_t>("the time");
    for (std::size_t j = 0; j < joint_count; ++j) {
        const std::string joint(table.joints[j]);
        for (Eigen::Index k = 0; k < 3; ++k) {
            const std::string what = joint + "." + "xyz"[k];
            const auto value = reader.number<float>(what);
            if (!std::isfinite(value)) throw reader.error(what + " is not finite");
            if (std::abs(value) > kFarthest)
                throw reader.error(what + " is " + std::to_string(value) +
                                   ", farther than 50 m: are the units metres?");
            frame.joints[j].position[k] = value;
        }
        const int state = reader.number<int>(joint + "'s tracking state");
        if (state < 0 || state > 2)
            throw reader.error(joint + "'s tracking state is " + std::to_string(state) +
                               ", must be 0, 1 or 2");
        frame.joints[j].state = static_cast<std::uint8_t>(state);
    }
    return frame;
}

} // namespace

KinectLog parse_kinect_log(std::string_view text, const std::string& name) {
    KinectLog log;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++number;
        const LineReader reader(line, number, name);
        if (line.find_first_not_of(" \t") == std::string_view::npos)
            throw reader.error("blank; every line must be a frame");
        const std::size_t fields = count_fields(line);
        const std::size_t joints = fields == 81 ? 20 : fields == 101 ? 25 : 0;
        if (joints == 0)
            throw reader.error(std::to_string(fields) +
                               " fields; a frame has 101 (25 joints) or 81 (20 joints)");
        if (log.joint_count != 0 && joints != log.joint_count)
            throw reader.error(std::to_string(joints) + " joints, where the lines before have " +
                               std::to_string(log.joint_count));
        log.joint_count = joints;
        log.frames.push_back(read_frame(line, number, joints, name));
        const std::size_t n = log.frames.size();
        if (n > 1 && log.frames[n - 1].time_100ns <= log.frames[n - 2].time_100ns)
            throw reader.error("the time " + std::to_string(log.frames[n - 1].time_100ns) +
                               " is not after the line before");
    }
    if (log.frames.empty()) throw FileError(name, "is empty; a body log has a line per frame");
    return log;
}

KinectLog load_kinect_log(const std::filesystem::path& file) {
    std::error_code status;
    if (std::filesystem::is_directory(file, status))
        throw FileError(file.string(), "is a folder, not a body log");
    const auto bytes = std::filesystem::file_size(file, status);
    if (status) throw FileError(file.string(), "cannot be read: " + status.message());
    if (bytes > kMaxBytes) throw FileError(file.string(), "is larger than 512 MB");
    std::string text(bytes, '\0');
    std::ifstream in(file, std::ios::binary);
    if (!in.read(text.data(), static_cast<std::streamsize>(bytes)))
        throw FileError(file.string(), "cannot be read");
    return parse_kinect_log(text, file.string());
}

} // namespace toile::kinect_log_source
