// A body with the tapes on it that its measurements were taken with, and their values beside it.
#pragma once

#include "body/body_model.h"
#include "body/measurement.h"
#include "imaging/image.h"

#include <span>
#include <string>

namespace toile::apps {

struct TapePictureOptions {
    std::string views = "front,back"; ///< as `toile tryon --views`
    int width = 560, height = 800;    ///< of each view, pixels
    std::string title;                ///< stands above the values
};

/// `model` at rest; tapes in the same frame. Each measurement has a colour and a number, which
/// stand on its tape and beside its value. \throw Error
[[nodiscard]] imaging::Image draw_tapes(const body::BodyModel& model,
                                        std::span<const body::LaidMeasurement> measurements,
                                        const TapePictureOptions& options = {});

} // namespace toile::apps
