#include "body/ansur_survey.h"

#include "body/ansur_paths.h"
#include "core/error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace toile::body {
namespace {

constexpr int kStature = 0, kWeight = 1; // in ansur_measures
constexpr double kMillimetre = 1e-3, kTenthOfKilogram = 0.1;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);)
        out.push_back(part);
    return out;
}

/// The columns whose sum a measure is.
std::vector<std::size_t> columns_of(const AnsurMeasure& measure,
                                    const std::vector<std::string>& header,
                                    const std::string& file) {
    std::vector<std::size_t> out;
    for (const auto& name : split(measure.column, '+')) {
        const auto found = std::find(header.begin(), header.end(), name);
        if (found == header.end()) throw FileError(file, "has no column '" + name + "'");
        out.push_back(static_cast<std::size_t>(found - header.begin()));
    }
    return out;
}

double number(const std::string& text, const std::string& file, std::size_t line) {
    double value = 0.0;
    const auto end = text.data() + text.size();
    if (std::from_chars(text.data(), end, value).ptr != end || text.empty())
        throw FileError(file, "line " + std::to_string(line) + ": '" + text + "' is no number");
    return value;
}

} // namespace

Eigen::MatrixXd read_ansur(const std::filesystem::path& folder, Sex sex) {
    const auto path =
        folder / (sex == Sex::female ? "ANSUR_II_FEMALE_Public.csv" : "ANSUR_II_MALE_Public.csv");
    const std::string file = path.string();
    std::ifstream in(path);
    std::string line;
    if (!std::getline(in, line))
        throw FileError(file, "cannot be read; is this ANSUR II's folder?");
    const auto header = split(line, ',');
    const auto& measures = ansur_measures();
    std::vector<std::vector<std::size_t>> columns;
    for (const auto& measure : measures)
        columns.push_back(columns_of(measure, header, file));

    std::vector<Eigen::VectorXd> rows;
    for (std::size_t number_of_line = 2; std::getline(in, line); ++number_of_line) {
        const auto cells = split(line, ',');
        Eigen::VectorXd row(static_cast<int>(measures.size()));
        for (std::size_t m = 0; m < measures.size(); ++m) {
            double sum = 0.0;
            for (const auto c : columns[m]) {
                if (c >= cells.size())
                    throw FileError(file, "line " + std::to_string(number_of_line) + " is short");
                sum += number(cells[c], file, number_of_line);
            }
            const double unit = m == kWeight ? kTenthOfKilogram : kMillimetre;
            row[static_cast<int>(m)] = unit * measures[m].factor * sum;
        }
        rows.push_back(std::move(row));
    }
    if (rows.size() < 2) throw FileError(file, "has no people");
    Eigen::MatrixXd out(static_cast<int>(rows.size()), static_cast<int>(measures.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
        out.row(static_cast<int>(i)) = rows[i];
    return out;
}

Statistics statistics(const Eigen::MatrixXd& rows) {
    Statistics out;
    out.mean = rows.colwise().mean();
    const Eigen::MatrixXd centred = rows.rowwise() - out.mean.transpose();
    const Eigen::MatrixXd covariance =
        centred.transpose() * centred / static_cast<double>(rows.rows() - 1);
    out.deviation = covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd inverse = out.deviation.cwiseInverse();
    out.correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
    return out;
}

Eigen::MatrixXd heavy_people(const Eigen::MatrixXd& rows, std::size_t count, double low,
                             double high, Random& random) {
    // Every measure's regression on stature and weight.
    const Eigen::RowVectorXd mean = rows.colwise().mean();
    const Eigen::MatrixXd centred = rows.rowwise() - mean;
    Eigen::MatrixXd known(rows.rows(), 2);
    known << centred.col(kStature), centred.col(kWeight);
    const Eigen::MatrixXd slopes =
        (known.transpose() * known).ldlt().solve(known.transpose() * centred);

    Eigen::MatrixXd out(static_cast<int>(count), rows.cols());
    for (int i = 0; i < out.rows(); ++i) {
        const auto person =
            static_cast<int>(random.next() % static_cast<std::uint64_t>(rows.rows()));
        out.row(i) = rows.row(person);
        const double stature = out(i, kStature);
        const double weight = random.uniform(low, high) * stature * stature;
        out.row(i) += (weight - out(i, kWeight)) * slopes.row(1);
    }
    return out;
}

std::vector<int> shuffled(int count, Random& random) {
    std::vector<int> out(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        out[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = out.size(); i > 1; --i)
        std::swap(out[i - 1], out[random.next() % i]);
    return out;
}

} // namespace toile::body
