// A catalogue split over machines by Slurm.
#pragma once

#include "apps/catalogue_plan.h"
#include "apps/global_options.h"

#include <string>

namespace toile::apps {

struct SlurmOptions {
    std::size_t tasks = 16; ///< of the job array
    std::string partition;  ///< "" : Slurm's own choice
    std::uint32_t cpus_per_task = 2;
    bool wait = false; ///< until everything is merged
};

/// Writes two scripts into the plan's folder (make.sbatch, an array in which each task makes its
/// share; merge.sbatch, which follows it), submits both, and tells their numbers. All machines must
/// see the folder and the program under the same names. \throw Error with what Slurm said, or when
/// there is no sbatch (the scripts are kept)
void submit_to_slurm(const CataloguePlan& plan, const GlobalOptions& global,
                     const SlurmOptions& options);

} // namespace toile::apps
