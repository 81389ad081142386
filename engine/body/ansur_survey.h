// The people of ANSUR II (public data, 4082 men and 1986 women) as targets for a population.
#pragma once

#include "body/sex.h"
#include "core/random.h"

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace toile::body {

/// People of one sex: rows in the order of `ansur_measures`, metres and kilograms, each times its
/// factor, so that they compare with the template's readings. (people x measures)
[[nodiscard]] Eigen::MatrixXd read_ansur(const std::filesystem::path& folder, Sex sex);

/// Means, deviations and correlations of rows.
struct Statistics {
    Eigen::VectorXd mean, deviation; ///< (measures)
    Eigen::MatrixXd correlation;     ///< (measures x measures)
};
[[nodiscard]] Statistics statistics(const Eigen::MatrixXd& rows);

/// `count` people heavier than the survey has them: rows of it moved along its regression on the
/// weight (at equal stature) to a body mass index drawn evenly from [low, high] kg/m^2.
[[nodiscard]] Eigen::MatrixXd heavy_people(const Eigen::MatrixXd& rows, std::size_t count,
                                           double low, double high, Random& random);

/// Places of rows in random order.
[[nodiscard]] std::vector<int> shuffled(int count, Random& random);

} // namespace toile::body
