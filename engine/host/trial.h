// Trying an unknown library in a child process: a library that crashes, hangs, aborts or exits
// costs only the child.
#pragma once

#include "host/manifest.h"

namespace toile::host {

/// Opens the library, makes one instance and destroys it, in a child. \throw PluginRefused
void try_opening(const Manifest& manifest, double timeout_s);

/// The same, and runs the contract of every kind that it provides on tiny inputs.
/// \throw PluginRefused naming the first thing that is wrong
void try_contract(const Manifest& manifest, double timeout_s);

} // namespace toile::host
