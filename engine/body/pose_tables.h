// What a body space knows of poses, as files beside its model: scape.tables and baked.tables.
#pragma once

#include "body/corrective_skin.h"

namespace toile::body {

struct PoseTables {
    PoseDeformation deformation; ///< for ScapeModel
    Correctives correctives;     ///< for CorrectiveSkin
};

/// Writes both into model.folder, 16 bits a number. \throw Error
void save_pose_tables(const PoseTables& tables, const BodyModel& model);

/// Reads them again. Each number is off by at most 1/65534 of the largest in its column.
/// \throw Error when one is missing, damaged or does not fit `model`
[[nodiscard]] PoseTables load_pose_tables(const BodyModel& model);

} // namespace toile::body
