#include "evaluation/pcl_forest.h"

#include "core/error.h"

#include <algorithm>
#include <bzlib.h>
#include <charconv>
#include <cmath>
#include <memory>
#include <string>

namespace toile::evaluation {
namespace {

using body::Part;

constexpr std::size_t kMostBytes = 128u << 20;
/// PCL scales offsets by 1000 / depth in pictures whose focal length is 525 (tree.h,
/// label_common.h).
constexpr float kScale = 1000.0f / 525.0f;

std::string unpack(const std::filesystem::path& file) {
    const auto close = [](BZFILE* open) { BZ2_bzclose(open); };
    const std::unique_ptr<BZFILE, decltype(close)> in(BZ2_bzopen(file.c_str(), "rb"), close);
    if (in == nullptr) throw FileError(file.string(), "cannot be read");
    std::string out;
    std::vector<char> buffer(1u << 20);
    for (;;) {
        const int got = BZ2_bzread(in.get(), buffer.data(), static_cast<int>(buffer.size()));
        if (got < 0) throw FileError(file.string(), "is no bzip2 file, or damaged");
        if (got == 0) return out;
        out.append(buffer.data(), static_cast<std::size_t>(got));
        if (out.size() > kMostBytes) throw FileError(file.string(), "is too large");
    }
}

class Numbers {
  public:
    Numbers(const std::string& text, std::string name) : text_(text), name_(std::move(name)) {}

    template <class Integer>
    Integer next() {
        at_ = std::min(text_.find_first_not_of(" \r\n\t", at_), text_.size());
        Integer out{};
        const auto [end, code] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), out);
        if (code != std::errc{})
            throw FileError(name_, "byte " + std::to_string(at_) + ": no such number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return out;
    }

  private:
    const std::string& text_;
    std::string name_;
    std::size_t at_ = 0;
};

} // namespace

PclTree::PclTree(const std::filesystem::path& file) {
    const std::string text = unpack(file);
    Numbers numbers(text, file.string());
    depth_ = numbers.next<int>();
    if (depth_ < 1 || depth_ > 24) throw FileError(file.string(), "has no depth of 1 to 24");
    nodes_.resize((std::size_t{1} << depth_) - 1);
    for (Node& node : nodes_)
        for (std::int16_t* value : {&node.du1, &node.dv1, &node.du2, &node.dv2, &node.threshold})
            *value = numbers.next<std::int16_t>();
    leaves_.resize(nodes_.size() + 1);
    for (std::uint8_t& leaf : leaves_) {
        leaf = numbers.next<std::uint8_t>();
        if (leaf >= kPclLabels) throw FileError(file.string(), "has a label beyond 24");
    }
}

std::uint8_t PclTree::label(const std::uint16_t* mm, int width, int height, float focal_px, int x,
                            int y) const noexcept {
    const float scale = kScale * focal_px / static_cast<float>(mm[y * width + x]);
    const auto depth_at = [&](int du, int dv) -> int {
        const auto u = static_cast<int>(
            std::floor(static_cast<float>(x) + static_cast<float>(du) * scale + 0.5f));
        const auto v = static_cast<int>(
            std::floor(static_cast<float>(y) + static_cast<float>(dv) * scale + 0.5f));
        return mm[std::clamp(v, 0, height - 1) * width + std::clamp(u, 0, width - 1)];
    };
    std::size_t at = 0;
    for (int level = 0; level < depth_; ++level) {
        const Node& node = nodes_[at];
        const int delta = depth_at(node.du1, node.dv1) - depth_at(node.du2, node.dv2);
        at = 2 * at + (delta > node.threshold ? 2 : 1);
    }
    return leaves_[at - nodes_.size()];
}

std::array<Part, 2> pcl_parts(std::uint8_t label) {
    // Lfoot Lleg Lknee Lthigh, the same right, Rhips Lhips Neck, Rarm Relbow Rforearm Rhand, the
    // same left, four of the face, Rchest Lchest. Hips reach up over what is the torso's here.
    static constexpr std::array<std::array<Part, 2>, kPclLabels> kParts = {{
        {Part::left_lower_leg},
        {Part::left_lower_leg},
        {Part::left_lower_leg, Part::left_upper_leg},
        {Part::left_upper_leg},
        {Part::right_lower_leg},
        {Part::right_lower_leg},
        {Part::right_lower_leg, Part::right_upper_leg},
        {Part::right_upper_leg},
        {Part::pelvis, Part::torso},
        {Part::pelvis, Part::torso},
        {Part::neck},
        {Part::right_upper_arm},
        {Part::right_upper_arm, Part::right_lower_arm},
        {Part::right_lower_arm},
        {Part::right_lower_arm},
        {Part::left_upper_arm},
        {Part::left_upper_arm, Part::left_lower_arm},
        {Part::left_lower_arm},
        {Part::left_lower_arm},
        {Part::head},
        {Part::head},
        {Part::head},
        {Part::head},
        {Part::torso},
        {Part::torso},
    }};
    return kParts[std::min<std::size_t>(label, kPclLabels - 1)];
}

} // namespace toile::evaluation
