#include "imaging/oni_writer.h"

#include "core/error.h"

#include <bit>
#include <cmath>
#include <cstring>

// The layout was learned from OpenNI2's player (Source/Drivers/OniFile of its 2.2): a header, then
// records with a header of their own. Little-endian, nothing is aligned.

namespace toile::imaging {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t kRecordMagic = 0x0052494e; // "NIR"
constexpr std::uint32_t kRecordHeader = 28;        // bytes
constexpr int kMostWidth = 1600, kMostHeight = 1200;
constexpr double kMicroseconds = 1e6;
constexpr float kMillimetres = 1000.0f;

enum Kind : std::uint32_t { // NOLINT(performance-enum-size): as it stands in the file
    integer_property = 0x03,
    general_property = 0x06,
    data_begin = 0x08,
    state_ready = 0x09,
    new_data = 0x0a,
    end = 0x0b,
    node_added = 0x0d,
    seek_table = 0x0e,
};

constexpr std::array<const char*, 2> kNames{"Depth", "Image"};
constexpr std::array<std::uint32_t, 2> kNodeTypes{2, 3};
constexpr std::uint32_t kUncompressed = 'N' | 'O' << 8 | 'N' << 16 | 'E' << 24;
constexpr std::array<std::uint64_t, 2> kPixelFormats{100, 200}; // depth in millimetres, RGB

} // namespace

/// Fields one after another.
class OniWriter::Bytes {
  public:
    template <class T>
    Bytes& add(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
        return *this;
    }
    Bytes& add_text(const char* text) {
        const auto length = static_cast<std::uint32_t>(std::strlen(text) + 1);
        add(length);
        bytes_.insert(bytes_.end(), text, text + length);
        return *this;
    }
    Bytes& add_all(const Bytes& other) {
        bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
        return *this;
    }
    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }
    [[nodiscard]] const char* data() const { return reinterpret_cast<const char*>(bytes_.data()); }

    /// A record's header and fields. `undo`: where the node's record before it stands.
    static Bytes record(Kind kind, std::uint32_t node, const Bytes& fields,
                        std::uint32_t payload = 0, std::uint64_t undo = 0) {
        Bytes out;
        out.add(kRecordMagic).add(static_cast<std::uint32_t>(kind)).add(node);
        out.add(kRecordHeader + fields.size()).add(payload).add(undo);
        out.add_all(fields);
        return out;
    }
    static Bytes header(std::uint64_t last_us, std::uint32_t last_node) {
        Bytes out;
        for (const char c : {'N', 'I', '1', '0'})
            out.add(c);
        out.add(std::uint8_t{1}).add(std::uint8_t{0}).add(std::uint16_t{1}).add(std::uint32_t{0});
        out.add(last_us).add(last_node);
        return out;
    }
    static Bytes introduction(std::uint32_t node, std::uint32_t frames, std::uint64_t first_us,
                              std::uint64_t last_us, std::uint64_t table) {
        Bytes fields;
        fields.add_text(kNames[node]).add(kNodeTypes[node]).add(kUncompressed);
        fields.add(frames).add(first_us).add(last_us).add(table);
        return record(node_added, node, fields);
    }
    static Bytes property(std::uint32_t node, const char* name, std::uint64_t value) {
        Bytes fields;
        fields.add_text(name).add(std::uint32_t{sizeof(value)}).add(value);
        return record(integer_property, node, fields);
    }
    static Bytes property(std::uint32_t node, const char* name, const Bytes& value) {
        Bytes fields;
        fields.add_text(name).add(value.size()).add_all(value);
        return record(general_property, node, fields);
    }

  private:
    std::vector<std::uint8_t> bytes_;
};

OniWriter::OniWriter(std::filesystem::path file, const Intrinsics& intrinsics, bool color,
                     double frames_per_second)
    : file_(std::move(file)), intrinsics_(intrinsics), color_(color) {
    check_intrinsics(intrinsics);
    if (intrinsics.width > kMostWidth || intrinsics.height > kMostHeight)
        throw FileError(file_.string(), "OpenNI plays pictures of at most 1600 x 1200");
    if (std::filesystem::exists(file_))
        throw FileError(file_.string(), "is there already; name another file or remove it");
    if (file_.has_parent_path()) {
        std::error_code ignored; // opening the file tells
        std::filesystem::create_directories(file_.parent_path(), ignored);
    }
    out_.open(file_, std::ios::binary | std::ios::trunc);
    put(Bytes::header(0, node_count() - 1));
    for (std::uint32_t node = 0; node < node_count(); ++node)
        begin_node(node, frames_per_second);
    for (std::uint32_t node = 0; node < node_count(); ++node) {
        Bytes fields;
        fields.add(std::uint32_t{0}).add(std::uint64_t{0});
        put(Bytes::record(data_begin, node, fields));
    }
}

OniWriter::~OniWriter() {
    try {
        finish();
    } catch (const Error&) { // NOLINT(bugprone-empty-catch): who wants to know calls finish
    }
}

void OniWriter::put(const Bytes& bytes) {
    out_.write(bytes.data(), bytes.size());
    if (!out_) throw FileError(file_.string(), "cannot be written");
}

/// What the player needs to know of a stream before its first frame.
void OniWriter::begin_node(std::uint32_t node, double frames_per_second) {
    node_record_[node] = static_cast<std::uint64_t>(out_.tellp());
    put(Bytes::introduction(node, 0, 0, 0, 0));
    const Eigen::Vector2d view = intrinsics_.field_of_view();
    const auto fps = static_cast<std::uint32_t>(std::lround(std::max(1.0, frames_per_second)));
    Bytes mode, uncropped, angles;
    mode.add(static_cast<std::uint32_t>(intrinsics_.width));
    mode.add(static_cast<std::uint32_t>(intrinsics_.height)).add(fps);
    uncropped.add(std::uint32_t{0}).add(std::uint64_t{0}); // disabled; place and size
    angles.add(view.x()).add(view.y());
    put(Bytes::property(node, "xnMapOutputMode", mode));
    put(Bytes::property(node, "oniPixelFormat", kPixelFormats[node]));
    put(Bytes::property(node, "xnCropping", uncropped));
    put(Bytes::property(node, "xnFOV", angles));
    put(Bytes::property(node, "xnMirror", std::uint64_t{0}));
    if (node == 0) put(Bytes::property(node, "xnDeviceMaxDepth", std::uint64_t{65535}));
    put(Bytes::record(state_ready, node, {}));
}

void OniWriter::add_data(std::uint32_t node, std::uint64_t time_us,
                         std::span<const std::uint8_t> payload) {
    const auto place = static_cast<std::uint64_t>(out_.tellp());
    Bytes fields;
    fields.add(time_us).add(count_);
    put(Bytes::record(new_data, node, fields, static_cast<std::uint32_t>(payload.size()),
                      last_record_[node]));
    out_.write(reinterpret_cast<const char*>(payload.data()),
               static_cast<std::streamsize>(payload.size()));
    if (!out_) throw FileError(file_.string(), "cannot be written; is the disk full?");
    last_record_[node] = place;
    index_[node].push_back({time_us, place});
}

void OniWriter::add(double time_s, const DepthImage& depth, const Image* color) {
    const auto fits = [&](const auto& picture) {
        return picture.width == intrinsics_.width && picture.height == intrinsics_.height;
    };
    if (!open_) throw FileError(file_.string(), "is finished");
    if (!fits(depth) || (color_ && (color == nullptr || !fits(*color) || color->empty())))
        throw FileError(file_.string(), "a picture is missing or not of the camera's size");
    if (count_ == 0) begin_s_ = time_s;
    // From 1: the player leaves out what has neither time nor number.
    const auto time_us =
        static_cast<std::uint64_t>(std::llround(kMicroseconds * (time_s - begin_s_)));
    if (time_s < begin_s_ || time_us < last_us_)
        throw FileError(file_.string(), "frames are not in the order of their times");
    ++count_;
    last_us_ = time_us;
    payload_.clear();
    for (const float metres : depth.metres) {
        const float units = std::isfinite(metres) ? std::round(kMillimetres * metres) : 0.0f;
        const auto value =
            static_cast<std::uint16_t>(units >= 1.0f && units <= 65535.0f ? units : 0.0f);
        payload_.push_back(static_cast<std::uint8_t>(value & 0xff));
        payload_.push_back(static_cast<std::uint8_t>(value >> 8));
    }
    add_data(0, time_us, payload_);
    if (!color_) return;
    payload_.clear();
    for (std::size_t i = 0; i + 3 < color->pixels.size(); i += 4)
        payload_.insert(payload_.end(), color->pixels.begin() + static_cast<std::ptrdiff_t>(i),
                        color->pixels.begin() + static_cast<std::ptrdiff_t>(i + 3));
    add_data(1, time_us, payload_);
}

void OniWriter::finish() {
    if (!open_) return;
    open_ = false;
    std::array<std::uint64_t, 2> tables{};
    for (std::uint32_t node = 0; node < node_count(); ++node) {
        tables[node] = static_cast<std::uint64_t>(out_.tellp());
        Bytes entries;
        entries.add(std::uint64_t{0})
            .add(std::uint32_t{0})
            .add(std::uint64_t{0}); // before the first
        for (const auto& [time_us, place] : index_[node])
            entries.add(time_us).add(std::uint32_t{1}).add(place);
        put(Bytes::record(seek_table, node, {}, entries.size()));
        put(entries);
    }
    put(Bytes::record(end, node_count() - 1, {}));
    out_.seekp(0);
    put(Bytes::header(last_us_, node_count() - 1));
    for (std::uint32_t node = 0; node < node_count(); ++node) {
        out_.seekp(static_cast<std::streamoff>(node_record_[node]));
        put(Bytes::introduction(node, count_, 0, last_us_, tables[node]));
    }
    out_.close();
    if (out_.fail()) throw FileError(file_.string(), "cannot be written; is the disk full?");
}

} // namespace toile::imaging
