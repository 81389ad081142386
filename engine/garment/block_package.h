// Basic blocks as garment packages: `toile garment new --block`.
#pragma once

#include "garment/block_design.h"
#include "garment/block_drape.h"
#include "garment/package.h"

#include <memory>

namespace toile::garment::block {

/// A size to make and the body that it is drafted for and stands on.
struct SizeOrder {
    std::string name; ///< "M"
    std::shared_ptr<const body::BodyModel> body;
};

/// A drape whose result is no garment: the text says why, the rest with what it was tried.
class DrapeRefused : public Error {
  public:
    DrapeRefused(const std::string& text, std::string size, DrapeOptions options,
                 DrapeReport report, std::string panel)
        : Error(text), size_(std::move(size)), panel_(std::move(panel)), options_(options),
          report_(report) {}

    [[nodiscard]] const std::string& size() const { return size_; }
    [[nodiscard]] const std::string& panel() const { return panel_; } ///< "" : all of it
    [[nodiscard]] const DrapeOptions& options() const { return options_; }
    [[nodiscard]] const DrapeReport& report() const { return report_; }

  private:
    std::string size_, panel_;
    DrapeOptions options_;
    DrapeReport report_;
};

/// Told of each size before and after its drape: positions (nv) and triangles, metres. Helps to
/// see why a pattern does not hang.
using WatchDrape =
    std::function<void(const std::string& size, const std::string& stage,
                       std::span<const Vec3d> positions, std::span<const Triangle> triangles)>;

/// Drafts, sews, drapes and dresses up a block in all sizes, from the smallest to the largest;
/// the topology is that of the middle one. The package is in memory only: see write_package.
/// Deterministic; some seconds a size.
/// \throw Error for an unknown block, or when a size's bodies do not grow from size to size;
/// DrapeRefused
[[nodiscard]] GarmentPackage make_block(const std::string& block, std::span<const SizeOrder> sizes);
/// The same for a design of one's own.
[[nodiscard]] GarmentPackage make_block(const Design& design, std::span<const SizeOrder> sizes,
                                        const WatchDrape& watch = {});

} // namespace toile::garment::block
