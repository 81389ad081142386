// One item of a catalogue: made, kept, read again.
#pragma once

#include "apps/catalogue_plan.h"
#include "apps/global_options.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace toile::apps {

enum class ItemState : std::uint8_t { missing, done, failed };

/// What item.json holds.
struct ItemRecord {
    ItemState state = ItemState::missing;
    std::string inputs; ///< CatalogueInputs::digest
    std::string error;  ///< why it failed
    nlohmann::ordered_json json;

    [[nodiscard]] std::optional<double> figure(const std::string& name) const;
};

/// Dresses the body, lets the clothes hang, and writes pictures (`VIEW.png`), `fit.json`,
/// `look.glb` if wished and item.json into a folder of the item's name under `out`, all at once:
/// what was there is replaced when everything is written. \throw Error
void make_item(const CataloguePlan& plan, const CatalogueItem& item, const GlobalOptions& global);

/// Keeps that it could not be made. \throw Error when that cannot be written
void keep_failure(const CataloguePlan& plan, const CatalogueItem& item, const std::string& inputs,
                  const std::string& error);

/// Of what there is; a damaged record counts as missing.
[[nodiscard]] ItemRecord read_record(const CataloguePlan& plan, const CatalogueItem& item);

/// Figures above the plan's limits, in words; empty when it keeps them all.
[[nodiscard]] std::vector<std::string> beyond_limits(const CataloguePlan& plan,
                                                     const ItemRecord& record);

} // namespace toile::apps
