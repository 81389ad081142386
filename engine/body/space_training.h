// Makes the space of adult bodies: people, components, levels, files. `toile avatar train-space`.
#pragma once

#include "body/population.h"
#include "body/pose_training.h"

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace toile::body {

struct SpaceOptions {
    std::filesystem::path data;   ///< see MakeHumanData
    std::filesystem::path survey; ///< folder of ANSUR II
    std::filesystem::path check;  ///< the other layout of the data, to hold it against; or empty
    std::filesystem::path out;    ///< gets one folder, named by the id
    std::string id = "adult";
    int components = 40;
    int people_per_sex = 1600;
    int heavy_per_sex = 150, unseen_per_sex = 60; ///< see PopulationOptions
    std::uint64_t seed = 1;
    PoseOptions poses;
    float coarseness = 1.0f; ///< of the template's edges; more only to test the training
    std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// Trains and writes <out>/<id>/ (model, space.json, space.tables, scape.tables, baked.tables,
/// training.json, PROVENANCE.md); equal options and data give equal bytes. Returns what
/// training.json holds: how the population and the space did. Takes about ten minutes on two cores.
/// \throw Error
nlohmann::ordered_json train_body_space(const SpaceOptions& options);

/// What training.json says of a population: per sex and measure mean and deviation of survey and
/// people, and the largest difference of correlations between matched measures.
[[nodiscard]] nlohmann::ordered_json population_report(const Population& population);

} // namespace toile::body
