#include "assets/bvh.h"

#include "core/bytes.h"
#include "core/log.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace toile::assets {
namespace {

using Channel = BvhJoint::Channel;

constexpr std::size_t kMaxFileBytes = 256u << 20;
constexpr std::size_t kMaxJoints = 4096;
constexpr int kMaxDepth = 256;

class BvhReader {
  public:
    BvhReader(std::string_view text, std::string file, double scale)
        : rest_(text), file_(std::move(file)), scale_(static_cast<float>(scale)) {}

    BvhMotion run() {
        expect("HIERARCHY");
        do {
            expect("ROOT");
            read_joint(-1, 0);
        } while (peek() == "ROOT");
        read_motion();
        return std::move(motion_);
    }

  private:
    [[nodiscard]] FileError fail(const std::string& what) const {
        return {file_, "line " + std::to_string(line_) + ": " + what};
    }

    void skip_space() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' ||
                                  rest_.front() == '\r' || rest_.front() == '\n')) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
    }

    std::string_view peek() {
        skip_space();
        return rest_.substr(0, std::min(rest_.find_first_of(" \t\r\n"), rest_.size()));
    }

    std::string_view next() {
        const std::string_view word = peek();
        if (word.empty()) throw fail("the file ends too early");
        rest_.remove_prefix(word.size());
        return word;
    }

    void expect(std::string_view wanted) {
        const std::string_view word = next();
        if (word != wanted)
            throw fail("expected '" + std::string(wanted) + "', found '" +
                       std::string(word.substr(0, 40)) + "'");
    }

    float number() {
        const std::string_view word = next();
        float value = 0.0f;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (problem != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
            throw fail("'" + std::string(word.substr(0, 40)) + "' is not a finite number");
        return value;
    }

    std::size_t count(std::size_t most, const char* what) {
        const std::string_view word = next();
        std::size_t value = 0;
        const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (problem != std::errc() || end != word.data() + word.size() || value > most)
            throw fail("'" + std::string(word.substr(0, 40)) + "' is not a count of " + what +
                       " from 0 to " + std::to_string(most));
        return value;
    }

    // The rest of the line: names may hold spaces.
    std::string name() {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view text = rest_.substr(0, end);
        const std::size_t brace = text.find('{'); // some writers keep it on the line
        if (brace != std::string_view::npos) text = text.substr(0, brace);
        rest_.remove_prefix(text.size());
        const std::size_t first = text.find_first_not_of(" \t\r");
        if (first == std::string_view::npos) throw fail("a joint needs a name");
        return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
    }

    Vec3f offset() {
        expect("OFFSET");
        Vec3f v;
        for (int k = 0; k < 3; ++k)
            v[k] = scale_ * number();
        return v;
    }

    Channel channel() {
        const std::string_view word = next();
        constexpr std::pair<std::string_view, Channel> kNames[] = {
            {"Xposition", Channel::x_position}, {"Yposition", Channel::y_position},
            {"Zposition", Channel::z_position}, {"Xrotation", Channel::x_rotation},
            {"Yrotation", Channel::y_rotation}, {"Zrotation", Channel::z_rotation}};
        for (const auto& [text, value] : kNames)
            if (word == text) return value;
        throw fail("unknown channel '" + std::string(word.substr(0, 40)) + "'");
    }

    // After ROOT or JOINT.
    void read_joint(int parent, int depth) {
        if (depth > kMaxDepth) throw fail("joints are nested too deep");
        if (motion_.joints.size() >= kMaxJoints) throw fail("too many joints");
        const std::size_t index = motion_.joints.size();
        BvhJoint joint;
        joint.name = name();
        for (const BvhJoint& other : motion_.joints)
            if (other.name == joint.name) throw fail("two joints are called '" + joint.name + "'");
        joint.parent = parent;
        expect("{");
        joint.offset = offset();
        joint.first_channel = motion_.channel_count;
        if (peek() == "CHANNELS") {
            expect("CHANNELS");
            joint.channels.resize(count(6, "channels"));
            for (Channel& c : joint.channels)
                c = channel();
            motion_.channel_count += joint.channels.size();
        }
        motion_.joints.push_back(joint);
        for (std::string_view word = next(); word != "}"; word = next()) {
            if (word == "JOINT") {
                read_joint(static_cast<int>(index), depth + 1);
            } else if (word == "End") {
                expect("Site");
                expect("{");
                motion_.joints[index].end = offset();
                expect("}");
            } else {
                throw fail("expected 'JOINT', 'End Site' or '}', found '" +
                           std::string(word.substr(0, 40)) + "'");
            }
        }
    }

    void read_motion() {
        expect("MOTION");
        expect("Frames:");
        motion_.frame_count = count(std::size_t{1} << 40, "frames");
        expect("Frame");
        expect("Time:");
        motion_.frame_time_s = static_cast<double>(number());
        if (!(motion_.frame_time_s > 0.0)) throw fail("the frame time must be positive");
        // A value takes at least two bytes, so a larger claim cannot be met.
        if (motion_.channel_count == 0) throw fail("no joint has channels");
        if (motion_.frame_count > (rest_.size() + 1) / 2 / motion_.channel_count)
            throw fail("claims " + std::to_string(motion_.frame_count) +
                       " frames, more than the file can hold");
        motion_.values.reserve(motion_.frame_count * motion_.channel_count);
        constexpr float kRadians = static_cast<float>(std::numbers::pi / 180.0);
        for (std::size_t frame = 0; frame < motion_.frame_count; ++frame)
            for (const BvhJoint& joint : motion_.joints)
                for (const Channel c : joint.channels)
                    motion_.values.push_back(number() *
                                             (c >= Channel::x_rotation ? kRadians : scale_));
        check_rest();
    }

    // Some recorders count one frame too few: whole frames more are left out, anything else is
    // damage.
    void check_rest() {
        std::size_t more = 0;
        for (; !peek().empty(); ++more)
            (void)number();
        if (more % motion_.channel_count != 0)
            throw fail("more values than " + std::to_string(motion_.frame_count) + " frames of " +
                       std::to_string(motion_.channel_count) + " channels");
        if (more > 0)
            log::warning(file_ + ": " + std::to_string(more / motion_.channel_count) +
                         " frame(s) beyond the " + std::to_string(motion_.frame_count) +
                         " it announces are left out");
    }

    std::string_view rest_;
    std::string file_;
    float scale_;
    std::size_t line_ = 1;
    BvhMotion motion_;
};

} // namespace

Quatf BvhMotion::rotation(std::size_t frame, std::size_t joint) const {
    const BvhJoint& j = joints[joint];
    Quatf q = Quatf::Identity();
    for (std::size_t k = 0; k < j.channels.size(); ++k) {
        if (j.channels[k] < Channel::x_rotation) continue;
        const int axis = static_cast<int>(j.channels[k]) - static_cast<int>(Channel::x_rotation);
        const float angle = values[frame * channel_count + j.first_channel + k];
        q = q * Quatf(Eigen::AngleAxisf(angle, Vec3f::Unit(axis)));
    }
    return q;
}

Vec3f BvhMotion::translation(std::size_t frame, std::size_t joint) const {
    const BvhJoint& j = joints[joint];
    Vec3f t = j.offset;
    for (std::size_t k = 0; k < j.channels.size(); ++k) {
        if (j.channels[k] >= Channel::x_rotation) continue;
        const int axis = static_cast<int>(j.channels[k]) - static_cast<int>(Channel::x_position);
        t[axis] = values[frame * channel_count + j.first_channel + k];
    }
    return t;
}

BvhMotion load_bvh(const std::filesystem::path& file, double metres_per_unit) {
    if (!(metres_per_unit > 0.0 && std::isfinite(metres_per_unit)))
        throw FileError(file.string(), "the scale must be positive");
    const std::vector<std::uint8_t> bytes = read_bytes(file, kMaxFileBytes);
    return BvhReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(),
                     metres_per_unit)
        .run();
}

} // namespace toile::assets
