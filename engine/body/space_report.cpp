// training.json: what a trained space is held to.
#include "body/space_training.h"

#include <cmath>

namespace toile::body {
namespace {

double rounded(double value) {
    return std::round(value * 1e5) / 1e5;
}

double largest_correlation_difference(const Statistics& a, const Statistics& b) {
    const auto& measures = ansur_measures();
    double out = 0.0;
    for (std::size_t i = 0; i < measures.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (measures[i].matched && measures[j].matched) {
                const auto r = static_cast<int>(i), c = static_cast<int>(j);
                out = std::max(out, std::abs(a.correlation(r, c) - b.correlation(r, c)));
            }
    return out;
}

} // namespace

nlohmann::ordered_json population_report(const Population& population) {
    nlohmann::ordered_json out;
    out["people"] = population.matched.size();
    out["heavy_people"] = population.heavy.size();
    out["dropped_people"] = population.dropped;
    double heaviest = 0.0;
    for (const auto& person : population.heavy)
        heaviest = std::max(heaviest, person.measures[1] / std::pow(person.measures[0], 2));
    out["largest_body_mass_index"] = rounded(heaviest);
    for (std::size_t s = 0; s < kSexes.size(); ++s) {
        const Statistics& survey = population.survey[s];
        const Statistics made = measure_statistics(population.matched, kSexes[s]);
        auto& sex = out[sex_name(kSexes[s])];
        for (std::size_t m = 0; m < ansur_measures().size(); ++m) {
            const auto i = static_cast<int>(m);
            auto& row = sex["measures"][ansur_measures()[m].name];
            row["matched"] = ansur_measures()[m].matched;
            row["survey_mean"] = rounded(survey.mean[i]);
            row["survey_deviation"] = rounded(survey.deviation[i]);
            row["mean"] = rounded(made.mean[i]);
            row["deviation"] = rounded(made.deviation[i]);
            row["mean_difference_in_deviations"] =
                rounded((made.mean[i] - survey.mean[i]) / survey.deviation[i]);
            row["deviation_ratio"] = rounded(made.deviation[i] / survey.deviation[i]);
        }
        sex["largest_correlation_difference"] =
            rounded(largest_correlation_difference(survey, made));
    }
    return out;
}

} // namespace toile::body
