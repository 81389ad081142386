#include "body/body_from_numbers.h"

#include "body/measurer.h"
#include "core/error.h"

#include <Eigen/Dense>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace toile::body {
namespace {

constexpr double kStep = 0.2; // deviations, of the differences: larger than girths' 5 mm search
constexpr double kUsual = 3.0;

Eigen::VectorXd values_of(const NamedLengths& all, const NamedLengths& wanted) {
    Eigen::VectorXd out(static_cast<int>(wanted.size()));
    int i = 0;
    for (const auto& [name, value] : wanted)
        out[i++] = all.at(name);
    return out;
}

/// The wanted measurement that fits worst with the others, and what would fit (P(m | others)).
std::string conflict(const NamedLengths& wanted, const Eigen::VectorXd& mean,
                     const Eigen::MatrixXd& covariance) {
    const auto n = static_cast<int>(wanted.size());
    const Eigen::MatrixXd precision =
        (covariance + 1e-8 * Eigen::MatrixXd::Identity(n, n)).inverse();
    std::ostringstream out;
    double worst = -1.0;
    int i = 0;
    Eigen::VectorXd off(n);
    for (const auto& [name, value] : wanted)
        off[i] = value - mean[i], ++i;
    i = 0;
    for (const auto& [name, value] : wanted) {
        // Of a normal distribution: variance 1 / P_ii, mean off by -(P off)_i / P_ii.
        const double deviation = 1.0 / std::sqrt(precision(i, i));
        const double expected = value - (precision * off)[i] / precision(i, i);
        const double z = std::abs(value - expected) / deviation;
        if (z > worst) {
            worst = z;
            out.str("");
            out << std::fixed << std::setprecision(3) << name << " of " << value
                << " m does not go with " << (n > 1 ? "the others" : "any adult") << ": "
                << expected - kUsual * deviation << " to " << expected + kUsual * deviation
                << " m would";
        }
        ++i;
    }
    return out.str();
}

} // namespace

MeasureBody measure_by_definitions(const BodyModel& model, std::span<const std::string> names) {
    const auto definitions = measurement_definitions(names);
    return [measurer = Measurer(model), definitions](const BodyShape& shape) {
        return as_map(measurer.measure(shape.positions, shape.skeleton, definitions));
    };
}

BodyFromNumbers body_from_numbers(const BodySpace& space, Sex sex, const NamedLengths& wanted,
                                  const MeasureBody& measure, const NumbersOptions& options) {
    const CoefficientPrior& prior = space.prior(sex);
    const auto shape_of = [&](const Eigen::VectorXd& c) {
        return space.shape({c.data(), static_cast<std::size_t>(c.size())});
    };
    BodyFromNumbers out;
    out.coefficients = prior.mean;
    out.measurements = measure(shape_of(out.coefficients));
    for (const auto& [name, value] : wanted)
        if (out.measurements.count(name) == 0) {
            std::string known;
            for (const auto& [other, unused] : out.measurements)
                known += (known.empty() ? "" : ", ") + other;
            throw Error("no measurement '" + name + "'; known: " + known);
        }
    Eigen::VectorXd goal(static_cast<int>(wanted.size()));
    int row = 0;
    for (const auto& [name, value] : wanted)
        goal[row++] = value;

    const auto distance = [&](const Eigen::VectorXd& c) {
        const Eigen::VectorXd off = c - prior.mean;
        return std::sqrt(std::max(0.0, off.dot(prior.covariance.ldlt().solve(off))));
    };
    std::string why;
    for (int round = 0; round <= options.rounds; ++round) {
        const Eigen::VectorXd have = values_of(out.measurements, wanted);
        out.deviations = distance(out.coefficients);
        const bool hit =
            wanted.empty() || (goal - have).cwiseAbs().maxCoeff() <= 0.5 * options.tolerance_m;
        if (hit && out.deviations <= options.farthest_deviations) return out;
        if (hit || round == options.rounds) break;

        Eigen::MatrixXd J(have.size(), out.coefficients.size());
        for (int c = 0; c < J.cols(); ++c) {
            Eigen::VectorXd moved = out.coefficients;
            moved[c] += kStep;
            J.col(c) = (values_of(measure(shape_of(moved)), wanted) - have) / kStep;
        }
        // min (c - mean)' C^-1 (c - mean) so that J (c - now) = goal - have.
        const Eigen::MatrixXd CJt = prior.covariance * J.transpose();
        const Eigen::MatrixXd spread = J * CJt;
        if (round == 0) why = conflict(wanted, have, spread);
        const Eigen::VectorXd back = prior.mean - out.coefficients;
        out.coefficients +=
            back + CJt * (spread + 1e-9 * Eigen::MatrixXd::Identity(J.rows(), J.rows()))
                             .ldlt()
                             .solve(goal - have - J * back);
        out.measurements = measure(shape_of(out.coefficients));
    }
    throw Error("nobody measures like that: " + why);
}

} // namespace toile::body
