// Trying an unknown library in a child process: a library that crashes, hangs, aborts or exits
// costs only the child.
#pragma once

#include "host/manifest.h"

namespace toile::host {

/// `toile-plugin-trial` beside the running program.
[[nodiscard]] std::filesystem::path trial_program();

/// Opens the library, makes one instance and destroys it, in a child. \throw PluginRefused
void try_opening(const Manifest& manifest, double timeout_s,
                 const std::filesystem::path& program = trial_program());

/// The same, and runs the contract of every kind that it provides on tiny inputs.
/// \throw PluginRefused naming the first thing that is wrong
void try_contract(const Manifest& manifest, double timeout_s,
                  const std::filesystem::path& program = trial_program());

/// The manifests that a path stands for: a manifest itself, those beside a library that name it,
/// or those of a folder. \throw PluginRefused when there is none
[[nodiscard]] std::vector<std::filesystem::path> manifests_of(const std::filesystem::path& path);

} // namespace toile::host
