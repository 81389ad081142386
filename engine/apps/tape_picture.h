// A body with the tapes on it that its measurements were taken with, and their values beside it.
#pragma once

#include "body/body_model.h"
#include "body/measurement.h"
#include "imaging/image.h"

#include <span>
#include <string>

namespace toile::apps {

struct TapePictureOptions {
    std::string views = "front,left"; ///< as `toile tryon --views`
    int width = 480, height = 720;    ///< of each view, pixels
    bool legend = true;
};

/// `model` at rest; tapes in the same frame. \throw Error
[[nodiscard]] imaging::Image draw_tapes(const body::BodyModel& model,
                                        std::span<const body::LaidMeasurement> measurements,
                                        const TapePictureOptions& options = {});

} // namespace toile::apps
