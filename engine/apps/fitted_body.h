// A body found in a scan or in cameras' pictures, for every command that takes one.
#pragma once

#include "apps/global_options.h"
#include "body/body_file.h"
#include "pipeline/body_fit.h"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace toile::apps {

struct FitInput {
    std::filesystem::path scan;       ///< a mesh or a cloud, or:
    std::vector<std::string> sources; ///< URIs of cameras
    std::uint32_t frames = 0;         ///< how many are used, spread over the recording; 0: one
    std::string sex;                  ///< "female", "male" or empty
    bool dressed = false;
};

/// --scan, --source, --frames, --sex, --dressed.
void add_fit_input(CLI::App& command, FitInput& input);

/// \throw UsageError when neither or both are named, Error when there is no body to be found
[[nodiscard]] pipeline::FittedBody fit_body(const FitInput& input, const GlobalOptions& global);

/// \throw Error when the model is not at hand
[[nodiscard]] body::BodyFile body_file_of(const pipeline::FittedBody& body);

} // namespace toile::apps
