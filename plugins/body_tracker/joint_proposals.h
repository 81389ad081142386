// Where joints may be, from labelled pixels: modes of each part's density, pushed into the body
// (Shotton et al. 2011, section 4).
#pragma once

#include "body_tracker/forest.h"
#include "body_tracker/parts_labels.h"

#include <array>

namespace toile::body_tracker {

inline constexpr std::size_t kProposalsPerPart = 3;

/// Metres, camera frame (looks along -Z, +Y up).
struct JointProposal {
    Vec3f position = Vec3f::Zero();
    float area_m2 = 0.0f;    ///< seen surface of the mode, each pixel by its probability
    float confidence = 0.0f; ///< in [0, 1): area / (area + half_area_m2)
};

/// Modes of one part, the largest first; unused ones have confidence 0.
using PartProposals = std::array<JointProposal, kProposalsPerPart>;

struct ProposalOptions {
    float radius_m = 0.08f;                      ///< of the window
    float half_area_m2 = 0.002f;                 ///< that gives confidence 0.5
    std::uint8_t least_share = 64;               ///< pixels less certain are left out
    std::array<float, kPartCount> push_back_m{}; ///< from surface to joint, along the ray
};

/// The usual options with the push-back that the forest has learned (0 where it has none).
[[nodiscard]] ProposalOptions proposal_options(const Forest& forest);

/// Place of the picture's centre (the focal length is the picture's).
struct ImageCentre {
    float x_px = 0.0f, y_px = 0.0f;
};

class JointProposer {
  public:
    explicit JointProposer(const ProposalOptions& options);

    /// Proposals of every part (kPartCount, PartLabel - 1). `labels` as label_pixels wrote them,
    /// classes being PartLabel - 1. A window is moved to the mean of what is in it, each pixel by
    /// its probability and the surface it covers (depth^2). Allocates nothing.
    [[nodiscard]] const std::array<PartProposals, kPartCount>&
    propose(const DepthView& view, const ImageCentre& centre, const LabelPicture& labels) noexcept;

  private:
    static constexpr std::size_t kPoints = 512; ///< of a part, evenly taken when there are more
    struct Point {
        Vec3f position;
        float area_m2;
    };
    struct PartPoints {
        std::size_t pixels = 0, seen = 0, count = 0;
        std::array<Point, kPoints> points;
    };
    [[nodiscard]] bool used(const LabelPicture& labels, std::size_t at) const noexcept;
    void collect(const DepthView& view, const ImageCentre& centre,
                 const LabelPicture& labels) noexcept;
    void find_modes(const PartPoints& part, float push_back_m, PartProposals& out) const noexcept;
    [[nodiscard]] JointProposal climb(const PartPoints& part, Vec3f at) const noexcept;

    ProposalOptions options_;
    std::vector<PartPoints> parts_; // (kPartCount)
    std::array<PartProposals, kPartCount> proposals_{};
};

} // namespace toile::body_tracker
