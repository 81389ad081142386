// A decision forest over depth differences: what class does a pixel belong to (Shotton et al.
// 2011).
//
// Depths are whole millimetres; offsets are millimetres in the plane of the asked pixel, so that a
// forest serves any camera and distance. Whole numbers throughout: the same answer everywhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace toile::body_tracker {

inline constexpr int kMaxClasses = 32;
inline constexpr int kMaxTrees = 16;
/// Depth of whatever is not the person, or not in the picture, millimetres.
inline constexpr int kFar_mm = 10000;

/// Borrowed depth picture, rows from the top; 0 = not the person.
struct DepthView {
    int width = 0;
    int height = 0;
    float focal_px = 0.0f;             ///< of both axes
    const std::uint16_t* mm = nullptr; ///< (width * height)
};

/// Difference of the depths at two places beside a pixel.
struct DepthFeature {
    std::int16_t ax = 0, ay = 0; ///< millimetres, x right, y down
    std::int16_t bx = 0, by = 0;
};

/// Value of a feature at a pixel of the person, in [-65535, 65535].
[[nodiscard]] int feature_value(const DepthFeature& feature, const DepthView& view, int x,
                                int y) noexcept;

/// Goes to `child` when the feature is below the threshold, else to `child` + 1.
struct ForestNode {
    DepthFeature feature;
    std::int16_t threshold = 0;
    std::int16_t reserved = 0;
    std::int32_t child =
        0; ///< node, always behind this one; below 0: leaf ~child; 0: not grown yet
};

struct ForestTree {
    std::vector<ForestNode> nodes;    ///< the first is the root
    std::vector<std::uint8_t> leaves; ///< (leaves * classes) share of each class, 255 = all
};

struct Forest {
    int class_count = 0;
    /// Learned with it, (classes) or empty: from the middle of a class's surface into the body,
    /// millimetres along the ray.
    std::vector<std::int16_t> push_back_mm;
    std::vector<ForestTree> trees;
};

/// Adds up the leaves that a pixel of the person reaches: sums (classes).
void classify(const Forest& forest, const DepthView& view, int x, int y,
              std::span<std::uint16_t> sums) noexcept;

/// Labels every `step`-th pixel of every `step`-th row: (ceil(width / step) * ceil(height / step)),
/// 0 where nobody is, else 1 + the likeliest class (the lowest of equals); `shares` its
/// probability, 255 = certain. Allocates nothing; rows of one picture may be shared out among
/// threads by `first_row` and `last_row` (in labelled rows, clipped).
struct LabelPicture {
    int step = 1;
    std::span<std::uint8_t> labels;
    std::span<std::uint8_t> shares;
};
void label_pixels(const Forest& forest, const DepthView& view, const LabelPicture& out,
                  int first_row, int last_row) noexcept;

/// Layout in README.md. \throw FileError when it cannot be written
void save_forest(const Forest& forest, const std::filesystem::path& file);
/// \throw FileError naming what is wrong with it
[[nodiscard]] Forest load_forest(const std::filesystem::path& file);

/// The file's bytes, and back; `allow_growing` lets nodes pass that are not grown yet. \throw
/// FileError with `name` for the file
[[nodiscard]] std::vector<std::uint8_t> encode_forest(const Forest& forest);
[[nodiscard]] Forest decode_forest(std::span<const std::uint8_t> bytes, const std::string& name,
                                   bool allow_growing = false);

} // namespace toile::body_tracker
