// All views of a subject that moved laid on each other at once, over the nodes of a graph (P2 4.3
// and 4.4 in one sparse system: pairwise registration, loop closure and smoothness together).
#pragma once

#include "core/row_loop.h"
#include "scan/registration.h"
#include "scan/warped_view.h"

namespace toile::scan {

struct JointWarpOptions {
    float reach_m = 0.04f; ///< pairs farther apart are no pairs
    float angle = 0.8f;    ///< most between their normals, radians
    int stride = 4;        ///< of the readings that look for a partner
    double huber_m = 0.005;
    // Against what an average node's readings weigh:
    double smoothness = 0.1;  ///< of neighbouring nodes
    double steadiness = 0.02; ///< of a node from a view to the next
    double trust = 0.001;     ///< in the template's motions
};

struct JointWarpRound {
    double rms_m = 0.0;   ///< of the pairs along the normals, before the step
    double overlap = 0.0; ///< share of the readings that found a partner
    double step_m = 0.0;  ///< largest move of a node
    std::size_t pairs = 0;
};

/// One step: pairs anew, then the least squares motions of all nodes of all views but the first,
/// whose pose is the scan's. `order`: views in the order of time.
[[nodiscard]] JointWarpRound warp_jointly(const DeformationGraph& graph,
                                          std::span<const ViewPair> pairs,
                                          const JointWarpOptions& options,
                                          std::vector<WarpedView>& views, const RowLoop& rows);

} // namespace toile::scan
