// The body space as the fit moves it: body/fit_model.h under this plugin's names.
#pragma once

#include "body/fit_model.h"

namespace toile::scape_fit {

using body::FitLevel;
using body::FitModel;
using body::FitShape;
using body::kPoseUnknowns;
using body::PosedLevel;
using body::ShapeRows;
using body::ShapeVector;

using body::motion_row;
using body::moved_pose;
using body::pose_level;
using body::rest_shape;

} // namespace toile::scape_fit
