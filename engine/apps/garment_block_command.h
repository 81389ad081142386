// `toile garment new --block`: a garment package drafted from our own basic blocks.
#pragma once

#include "garment/package.h"

#include <filesystem>
#include <optional>
#include <string>

namespace toile::apps {

/// What was asked for.
struct BlockOptions {
    std::string block;                               ///< "t-shirt"; empty: no block is wanted
    std::string sizes = "S=woman,M=mannequin,L=man"; ///< smallest to largest, each on its avatar
    std::string id;                                  ///< of the garment; empty: the block's
    std::optional<double> girth_ease_m;              ///< beyond chest or hip; none: the block's own
    std::filesystem::path out;
};

/// Makes the package, replacing what `out` held, checks it and prints what came of it.
/// \throw Error, UsageError
void make_block_package(const BlockOptions& options, const garment::PackageLimits& limits);

} // namespace toile::apps
