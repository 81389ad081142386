// The items of a catalogue, each in a process of its own.
#pragma once

#include "apps/catalogue_item.h"

namespace toile::apps {

/// Which of the items: every `count`th, beginning with `index`.
struct CatalogueShare {
    std::size_t index = 0, count = 1;
};

struct CatalogueRun {
    std::size_t kept = 0; ///< were there, of the same inputs
    std::size_t made = 0;
    std::size_t failed = 0; ///< each was named in the log
    bool interrupted = false;
};

/// Makes what is missing, failed before, or was made of other inputs; as many at a time as there
/// are threads. An item that fails, or whose process dies, is named, kept as failed, and the next
/// one is made. `fresh`: everything anew. \throw Error when records cannot be written
[[nodiscard]] CatalogueRun make_items(const CataloguePlan& plan,
                                      const std::vector<CatalogueItem>& items,
                                      const CatalogueShare& share, const GlobalOptions& global,
                                      bool fresh);

/// Options of this program that its children need to do the same: plugins, seed.
[[nodiscard]] std::vector<std::string> same_options(const GlobalOptions& global);

} // namespace toile::apps
