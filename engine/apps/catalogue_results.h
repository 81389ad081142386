// A catalogue as a whole: results.json, summary.md, contact sheets.
#pragma once

#include "apps/catalogue_item.h"

namespace toile::apps {

struct CatalogueCounts {
    std::size_t items = 0, done = 0, failed = 0, missing = 0, beyond = 0; ///< beyond: of the done
};

/// Reads every item's record and writes what tells of all of them into the plan's folder; the same
/// items give the same bytes, however they were made. \throw Error when it cannot be written
CatalogueCounts write_results(const CataloguePlan& plan, const std::vector<CatalogueItem>& items);

/// sheet-001.png ...: the pictures of every item with its name; of one that failed, the reason.
/// Sheets of an earlier run are removed. \throw Error
void write_sheets(const CataloguePlan& plan, const std::vector<CatalogueItem>& items);

} // namespace toile::apps
