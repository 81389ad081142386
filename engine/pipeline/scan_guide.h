// The body of somebody who moves while scanned, found in some of the frames: what a scanner with
// the extension toile.scan_guide/1 starts from.
#pragma once

#include "pipeline/body_fit.h"

namespace toile::pipeline {

class ScanGuide {
  public:
    /// Instants that are fitted at most: one in every 30 degrees of a turn.
    static constexpr std::size_t kMostInstants = 13;

    explicit ScanGuide(std::span<const SensorStream> streams);

    /// Copies some of the frames, spread evenly over however many there will be.
    void keep(std::span<const SensorFrame> frames);

    /// Fits one body to what was kept and tells the scanner where it stood. What came of it, with
    /// the reason where there is no body: the scanner then goes on without. \throw host::Cancelled
    [[nodiscard]] nlohmann::ordered_json give(host::Registry& registry, host::Services& services,
                                              const toile_limits& limits, host::Instance& scanner,
                                              host::Job& job);

  private:
    struct Kept {
        std::uint32_t number = 0;
        std::vector<SensorFrame> frames;
    };
    [[nodiscard]] std::vector<const Kept*> chosen() const;
    [[nodiscard]] double beside_share(const FittedBody& body) const;
    [[nodiscard]] FittedBody fitted(host::Registry& registry, host::Services& services,
                                    const toile_limits& limits, const FittedBody* known,
                                    float most_m, host::Job& job) const;

    std::vector<SensorStream> streams_;
    std::vector<Kept> kept_;
    std::uint32_t fed_ = 0, stride_ = 1;
};

} // namespace toile::pipeline
