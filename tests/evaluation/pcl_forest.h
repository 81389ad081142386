// The trained body-part forests of PCL's gpu/people, to be compared with.
#pragma once

#include "body/body_model.h"
#include "body_tracker/parts_labels.h"

#include <array>
#include <filesystem>
#include <vector>

namespace toile::evaluation {

/// PCL's 25 labels.
inline constexpr std::size_t kPclLabels = 25;

/// One tree: depth 20, a full binary tree; a walk as PCL's does it (multi_tree.cu).
class PclTree {
  public:
    /// Text, packed by bzip2. \throw FileError
    explicit PclTree(const std::filesystem::path& file);

    /// Label of a pixel. `mm` (width * height); what is not the person must be the largest short,
    /// as for PCL's trees; places off the picture are those of its edge.
    [[nodiscard]] std::uint8_t label(const std::uint16_t* mm, int width, int height, float focal_px,
                                     int x, int y) const noexcept;

  private:
    struct Node {
        std::int16_t du1, dv1, du2, dv2, threshold;
    };
    int depth_ = 0;
    std::vector<Node> nodes_;          // (2^depth - 1), children of n are 2n + 1 and 2n + 2
    std::vector<std::uint8_t> leaves_; // (2^depth)
};

/// P4's parts that a label of PCL's may stand for: two where it lies across a joint, both count.
[[nodiscard]] std::array<body::Part, 2> pcl_parts(std::uint8_t label);

} // namespace toile::evaluation
