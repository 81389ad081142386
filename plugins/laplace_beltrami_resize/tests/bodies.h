// Mannequins and customers of the body space, at rest.
#pragma once

#include "body/fit_model.h"
#include "core/random.h"

namespace toile::laplace_beltrami_resize {

inline const body::FitModel& adult() {
    static const body::FitModel kModel(std::filesystem::path(TOILE_SOURCE_DIR) / "avatars" /
                                       "adult");
    return kModel;
}

/// Seed 0: the mean adult; else somebody of the population, women for even numbers.
inline geometry::TriangleMesh person(std::uint64_t seed) {
    body::ShapeVector shape = body::ShapeVector::Zero(adult().component_count());
    if (seed != 0) {
        Random random(seed);
        const body::CoefficientPrior& prior = adult().space().prior(body::kSexes[seed % 2]);
        for (double& n : shape)
            n = random.normal();
        shape = (prior.mean + prior.covariance.llt().matrixL() * shape).eval();
    }
    body::PosedLevel posed;
    body::pose_level(adult(), adult().level(0), {shape, {}}, {}, posed);
    return {posed.positions, {}, adult().level(0).triangles};
}

} // namespace toile::laplace_beltrami_resize
