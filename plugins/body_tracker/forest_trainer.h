// Grows a forest on labelled pixels, all nodes of a level together, and can go on where it stopped.
#pragma once

#include "body_tracker/training_set.h"
#include "core/row_loop.h"

#include <functional>
#include <optional>
#include <string>

namespace toile::body_tracker {

struct TrainerOptions {
    int class_count = 0;
    int tree_count = 3;
    int depth = 18;                     ///< levels of questions
    int candidates = 250;               ///< features tried at a node
    int thresholds = 20;                ///< tried for each, at most 31
    int reach_mm = 1000;                ///< largest offset along an axis
    std::uint32_t min_samples = 20;     ///< a node with fewer becomes a leaf
    std::uint32_t split_samples = 2500; ///< a question is chosen by at most so many, evenly taken
    std::uint32_t max_leaves = 60000;   ///< of a tree; a full level keeps the best splits only
    /// Weight of a class: (mean number of samples / its number) to this power. 0: rare classes are
    /// ignored, 1: all count the same.
    double balance = 0.5;
    std::uint64_t seed = 1;
    std::filesystem::path checkpoint; ///< written after each level when not empty
};

/// Share done in [0, 1] and a line of text; answers whether to go on.
using TrainerProgress = std::function<bool(double, const std::string&)>;

/// Grows the forest; a question is chosen by the Gini impurity, which needs no logarithm and is the
/// same everywhere. The bytes depend on the samples and options only, never on `rows`. A checkpoint
/// of the same samples and options is gone on with. Nothing when `progress` says stop: the
/// checkpoint keeps the levels that are done. \throw Error for options or samples that make no
/// sense, FileError for a damaged checkpoint or one of another training
[[nodiscard]] std::optional<Forest> train_forest(const TrainingSet& set,
                                                 const TrainerOptions& options, const RowLoop& rows,
                                                 const TrainerProgress& progress);

} // namespace toile::body_tracker
