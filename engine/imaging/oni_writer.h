// Recordings that OpenNI plays (.oni): depth and colour of one camera.
#pragma once

#include "imaging/camera.h"

#include <filesystem>
#include <fstream>

namespace toile::imaging {

/// Writes a .oni file, version 1.0.1, that OpenNI2's player (OniFile) opens: depth in millimetres,
/// colour as RGB, neither compressed. The format keeps the fields of view and no more of a camera:
/// the principal point comes back in the middle, without distortion.
class OniWriter {
  public:
    /// \throw Error: the file is there already, cannot be written, or the pictures are larger than
    /// the player takes (1600 x 1200)
    OniWriter(std::filesystem::path file, const Intrinsics& intrinsics, bool color,
              double frames_per_second);
    OniWriter(const OniWriter&) = delete;
    OniWriter& operator=(const OniWriter&) = delete;
    /// Finishes what was begun, so that a run that broke off can be played up to there.
    ~OniWriter();

    /// Times must not fall. `color`: of the depth's size where the file has colour. \throw Error
    void add(double time_s, const DepthImage& depth, const Image* color = nullptr);
    /// Fills in what only the end knows. Nothing can be added then. \throw Error
    void finish();

    [[nodiscard]] std::uint32_t frame_count() const { return count_; }

  private:
    class Bytes;
    void put(const Bytes& bytes);
    void begin_node(std::uint32_t node, double frames_per_second);
    void add_data(std::uint32_t node, std::uint64_t time_us, std::span<const std::uint8_t> payload);
    [[nodiscard]] std::uint32_t node_count() const { return color_ ? 2 : 1; }

    std::filesystem::path file_;
    Intrinsics intrinsics_;
    bool color_;
    std::ofstream out_;
    bool open_ = true;
    std::uint32_t count_ = 0;
    std::uint64_t last_us_ = 0;
    double begin_s_ = 0.0;
    std::array<std::uint64_t, 2> last_record_{}; ///< where each node's last data stand
    std::array<std::uint64_t, 2> node_record_{}; ///< where each node is introduced
    std::array<std::vector<std::array<std::uint64_t, 2>>, 2> index_; ///< time and place of frames
    std::vector<std::uint8_t> payload_;
};

} // namespace toile::imaging
