// Each measurement by itself: small pictures of where its tape runs.
#pragma once

#include "body/body_model.h"
#include "body/measurement.h"
#include "imaging/image.h"

#include <span>

namespace toile::apps {

struct TapeSheetOptions {
    int columns = 6;
    int width = 220, height = 240; ///< of each picture, pixels
};

/// A small picture of each measurement, near and from where most of its tape is seen, with its
/// name; of a tape that is hidden there for more than a fifth and can be seen from elsewhere, two.
/// `model` at rest. \throw Error
[[nodiscard]] imaging::Image draw_tape_sheet(const body::BodyModel& model,
                                             std::span<const body::LaidMeasurement> measurements,
                                             const TapeSheetOptions& options = {});

} // namespace toile::apps
