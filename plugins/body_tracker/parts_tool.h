// `toile avatar train-parts`: the command of this plugin's tool.
#pragma once

#include "core/row_loop.h"
#include "sdk/tool.h"

namespace toile::body_tracker {

/// What the tool says of itself; its words stand in plugin.json too.
[[nodiscard]] toile_tool_info parts_tool_info();

/// Where, from what and with how many threads: everything that the host gives.
struct PartsToolSetting {
    std::uint64_t seed = 1;
    RowLoop rows = serial_rows;
};

/// Trains a forest and writes it; answers the one line that tells of it.
/// \throw sdk::Failure TOILE_CANCELLED when the job stops it (a checkpoint keeps what is done);
/// Error naming what cannot be read, trained or written
[[nodiscard]] std::string train_parts_by(const sdk::ToolArguments& arguments,
                                         const PartsToolSetting& setting, sdk::Job job);

} // namespace toile::body_tracker
