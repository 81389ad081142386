#include "apps/freesewing.h"

#include "apps/child_process.h"
#include "core/error.h"
#include "core/paths.h"

#include <filesystem>

namespace toile::apps {
namespace {

std::filesystem::path find_script() {
    for (const auto& folder : data_folders("freesewing")) {
        if (std::filesystem::exists(folder / "draft.mjs")) {
            if (!std::filesystem::exists(folder / "node_modules")) {
                throw Error("FreeSewing's designs are not installed in " + folder.string() +
                            ": run scripts/setup (or `npm ci` there)");
            }
            return folder / "draft.mjs";
        }
    }
    throw Error("freesewing/draft.mjs stands in no data folder (see TOILE_DATA_PATH): the "
                "installation is incomplete");
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

} // namespace

std::vector<garment::block::PatternPiece>
draft_freesewing(const std::string& design, const nlohmann::json& options,
                 const std::map<std::string, double>& measurements) {
    const nlohmann::json input = {
        {"design", design}, {"options", options}, {"measurements", measurements}};
    const std::filesystem::path script = find_script();
    // scripts/setup puts a newer Node.js here where the system's is too old.
    const std::filesystem::path own = script.parent_path() / "node_modules/node/bin/node";
    ChildResult result;
    try {
        result = run_child({std::filesystem::exists(own) ? own.string() : "node", script.string()},
                           input.dump());
    } catch (const Error& error) {
        throw Error(std::string(error.what()) + " (FreeSewing's designs need Node.js 20 or newer)");
    }
    if (result.status != 0) {
        throw Error("FreeSewing: " + (result.err.empty()
                                          ? "ended with status " + std::to_string(result.status)
                                          : first_line(result.err)));
    }
    return garment::block::read_drafted_pieces(result.out, "FreeSewing's '" + design + "'");
}

} // namespace toile::apps
