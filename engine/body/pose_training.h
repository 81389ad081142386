// Learns what poses do to flesh: relaxes many poses of the mean body, then fits SCAPE's Q and the
// correctives of the real-time form.
#pragma once

#include "body/flesh.h"
#include "body/pose_tables.h"

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

namespace toile::body {

struct PoseOptions {
    int training_poses = 280;
    int test_poses = 24;
    int baked_poses = 800;      ///< posed by SCAPE, for the correctives: cheap
    double ridge = 0.05;        ///< of each feature's mean square
    double baked_ridge = 0.002; ///< the same for the correctives, which have more poses
    std::uint64_t seed = 7;
    FleshOptions flesh;
    std::function<void(double)> progress = [](double) {};
};

struct TrainedPose {
    PoseTables tables;
    nlohmann::ordered_json report; ///< errors on the test poses, volumes kept
};

/// `model`: the mean body, closed. Poses are random up to the joints' limits. Equal input gives
/// equal results. \throw Error
[[nodiscard]] TrainedPose train_pose(const BodyModel& model, const PoseOptions& options);

/// The same for the model in `folder`, written beside it (see pose_tables.h); returns the report,
/// and puts it into training.json where there is one.
nlohmann::ordered_json train_pose_tables(const std::filesystem::path& folder,
                                         const PoseOptions& options);

} // namespace toile::body
