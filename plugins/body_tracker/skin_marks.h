// Places on somebody's arms that are known by how they look: where the colour picture shows them
// again tells how arms have rolled, which depth hardly does (P5 3.2.1). Each vertex of the tracked
// body there may be one.
//
// P5 matches ORB features. At 2.7 m an upper arm is 18 pixels wide, less than ORB's patch of 31;
// so here a look is 9 x 9 samples laid on the skin, turned and bent with it, and compared by
// correlation, which no change of light within the patch's size alters.
#pragma once

#include "body_tracker/grey_picture.h"
#include "body_tracker/registration.h"

namespace toile::body_tracker {

struct MarkOptions {
    float weight = 1.0f;         ///< of a mark against the depth terms; 0: no marks
    float deviation_m = 0.010f;  ///< of where a mark is seen again, across the line of sight
    float information = 0.3f;    ///< how much of a sighting each adds: neighbours go together
    float robust_m = 0.03f;      ///< scale of Geman and McClure's weight
    float least_likeness = 0.5f; ///< correlation with the look that is kept, 0 to 1
    float forget_s = 10.0f;      ///< over which a mark gives way to where depth has it, elbow bent
    std::size_t most_sought = 160; ///< in a frame
};

/// Work space is taken once; nothing allocates afterwards. Not for several threads at once.
class SkinMarks {
  public:
    /// Samples of one look: so many on each side, 6 mm apart on the skin.
    static constexpr int kSide = 9;
    static constexpr int kSamples = kSide * kSide;

    SkinMarks(const TrackedBody& body, const MarkOptions& options);

    /// Forgets everything: somebody else is followed now.
    void reset() noexcept;

    /// Looks for the marks around where a pose has them. Without a picture nothing is found.
    void find(const SeenPerson& seen, const body::Pose& pose) noexcept;
    /// Of the last `find`, until the next.
    [[nodiscard]] std::span<const SkinPull> pulls() const noexcept { return pulls_; }

    /// After the frame's pose is known: marks found give way a little, new ones are taken, those
    /// not found for long are dropped.
    void learn(const SeenPerson& seen, const body::Pose& pose, float dt) noexcept;

    /// Marks sought and found in the last frame, by the joint that leads them.
    struct Counts {
        std::array<std::uint16_t, body::kJointCount> known{}, sought{}, found{};
    };
    [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

  private:
    struct Mark {
        std::uint32_t vertex = 0;
        std::uint8_t joint = 0, child = 0; ///< its bone
        bool known = false, found = false;
        int missed = 0;               ///< times in a row
        Vec3f offset = Vec3f::Zero(); ///< from the vertex, in the frame of the skin there, metres
        std::array<float, kSamples> look{}; ///< sum 0, sum of squares 1
    };
    /// Where the samples of a look lie in the picture: middle + u a + v b + v^2 c.
    struct Frame {
        Vec3f at, normal; ///< camera frame
        Vec2f middle, a, b, c;
        float facing = 0.0f;
    };
    struct Peak {
        Vec2f shift = Vec2f::Zero(); ///< pixels
        float likeness = 0.0f;
        Eigen::Matrix2f sharpness = Eigen::Matrix2f::Zero(); ///< of the likeness around, per px^2
    };
    [[nodiscard]] bool frame_of(const SeenPerson& seen, const Mark& mark,
                                Frame& out) const noexcept;
    [[nodiscard]] bool place_samples(const GreyPicture& picture, const Frame& frame,
                                     int margin) noexcept;
    [[nodiscard]] float sample(const GreyPicture& picture, int dx, int dy,
                               std::array<float, kSamples>& out) const noexcept;
    [[nodiscard]] Peak search(const GreyPicture& picture, const Mark& mark) noexcept;
    void pull(const GreyPicture& picture, const Mark& mark, const Frame& frame,
              const Peak& peak) noexcept;

    const TrackedBody& body_;
    MarkOptions options_;
    PosedBody posed_;
    std::vector<Mark> marks_;
    std::vector<SkinPull> pulls_;
    std::vector<std::size_t> pulled_;           ///< mark of each pull
    std::array<std::int32_t, kSamples> base_{}; ///< of each sample: its pixel, and weights of four
    std::array<std::array<float, 4>, kSamples> corner_{};
    Counts counts_;
    std::uint32_t turn_ = 0; ///< which marks are left out when there are too many
};

} // namespace toile::body_tracker
