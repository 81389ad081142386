// A cleaned scan with its parts as a body of the plugin boundary.
#pragma once

#include "abi/body.h"
#include "mannequin_scan/scan_session.h"

namespace toile::mannequin_scan {

/// Owns what `abi` points to. Each vertex is held by one joint, the one that carries its part. Not
/// movable.
class PartBody {
  public:
    /// \throw Error when the scan has no parts
    PartBody(const CleanScan& scan, std::uint64_t revision);
    PartBody(const PartBody&) = delete;
    PartBody& operator=(const PartBody&) = delete;

    [[nodiscard]] const toile_body& abi() const noexcept { return abi_; }
    [[nodiscard]] const std::array<Vec3f, body::kJointCount>& joints() const { return joints_; }

  private:
    std::array<Vec3f, body::kJointCount> joints_;
    std::vector<std::uint8_t> labels_;
    std::vector<std::array<std::uint16_t, 4>> indices_;
    std::vector<std::array<float, 4>> weights_;
    toile_body abi_{};
};

} // namespace toile::mannequin_scan
