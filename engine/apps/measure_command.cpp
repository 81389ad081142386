// toile measure: a tailor's measurements of a body or of any scan of one.
#include "apps/commands.h"
#include "apps/fitted_body.h"
#include "apps/tape_picture.h"
#include "apps/tape_sheet.h"
#include "body/body_file.h"
#include "body/measurer.h"
#include "core/error.h"
#include "core/log.h"
#include "render/views.h"

#include <iomanip>
#include <iostream>
#include <sstream>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct MeasureCommand {
    std::string body;
    bool json = false;
    fs::path picture, sheet;
    std::vector<std::string> names;
    std::string sex;
    TapePictureOptions drawing;
};

// Those that size charts ask for, and that can be told apart in one picture.
const std::vector<std::string> kDrawn = {
    "neck_girth",      "bust_girth",  "under_bust_girth",  "waist_girth",
    "hip_girth",       "thigh_girth", "knee_girth",        "calf_girth",
    "upper_arm_girth", "wrist_girth", "back_waist_length", "inside_leg_length",
};

/// An avatar, a body.json, or a mesh: of that, the body found in it.
body::BodyModel body_of(const MeasureCommand& command, const GlobalOptions& global) {
    const fs::path path(command.body);
    if (body::is_body_file(path)) return body::load_body(path);
    if (!path.has_extension() || fs::is_directory(path))
        return body::load_body_model(fs::is_directory(path) ? path
                                                            : body::find_avatar(command.body));
    FitInput input;
    input.scan = path;
    input.sex = command.sex;
    const pipeline::FittedBody fitted = fit_body(input, global);
    log::info(command.body + ": measured on the body found in it, unit " +
              fitted.report.value("unit", "m") + ", a " + fitted.report.value("sex", "person"));
    return body::model_of(body_file_of(fitted));
}

void print_table(std::span<const body::LaidMeasurement> measured) {
    std::cout << std::fixed << std::setprecision(1);
    for (const body::LaidMeasurement& m : measured)
        std::cout << std::left << std::setw(30) << m.definition->name << std::right << std::setw(7)
                  << 100.0 * m.reading.value_m << " cm  confidence " << std::setprecision(2)
                  << m.reading.confidence << std::setprecision(1) << "\n";
}

/// "anna, 168.0 cm tall".
std::string title_of(const MeasureCommand& command, const body::BodyModel& model) {
    const auto stature = model.measurements.find("stature");
    std::ostringstream out;
    out << fs::path(command.body).stem().string();
    if (stature != model.measurements.end())
        out << std::fixed << std::setprecision(1) << ", " << 100.0 * stature->second << " cm tall";
    return out.str();
}

/// What is wrong with the call is said before the long work.
void check(const MeasureCommand& command) {
    (void)render::views_from_names(command.drawing.views);
    for (const fs::path& file : {command.picture, command.sheet})
        if (!file.empty() && file.extension() != ".png" && file.extension() != ".jpg")
            throw UsageError("measure: a picture is written as .png or .jpg, not '" +
                             file.string() + "'");
}

void measure(const MeasureCommand& command, const GlobalOptions& global) {
    const auto definitions = [&](const std::vector<std::string>& names) {
        std::vector<const body::MeasurementDefinition*> out;
        if (!names.empty()) return body::measurement_definitions(names);
        for (const auto& definition : body::measurement_definitions())
            out.push_back(&definition);
        return out;
    };
    check(command);
    const auto wanted = definitions(command.names);
    const body::BodyModel model = body_of(command, global);
    const body::Measurer measurer(model);
    const body::Figure figure = measurer.figure(model.rest.positions, model.skeleton);
    const auto measured = body::lay_tapes(figure, wanted);
    if (!command.picture.empty()) {
        TapePictureOptions drawing = command.drawing;
        drawing.title = title_of(command, model);
        const auto drawn =
            command.names.empty() ? body::lay_tapes(figure, definitions(kDrawn)) : measured;
        imaging::save_image(draw_tapes(model, drawn, drawing), command.picture);
    }
    if (!command.sheet.empty())
        imaging::save_image(draw_tape_sheet(model, measured), command.sheet);
    if (!command.json) {
        print_table(measured);
        for (const fs::path& file : {command.picture, command.sheet})
            if (!file.empty()) std::cout << "wrote " << file.string() << "\n";
        return;
    }
    nlohmann::ordered_json json;
    json["body"] = command.body;
    for (const body::LaidMeasurement& m : measured)
        json["measurements"][std::string(m.definition->name)] = {
            {"value", m.reading.value_m}, {"confidence", m.reading.confidence}};
    std::cout << json.dump(2) << "\n";
}

} // namespace

void add_measure_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("measure", "Measures a body as a tailor does");
    const auto options = std::make_shared<MeasureCommand>();
    command
        ->add_option("body", options->body,
                     "A body.json, an avatar, or a scan (a mesh or cloud, in any unit)")
        ->required();
    command->add_flag("--json", options->json, "Machine-readable, metres");
    command
        ->add_option("--measurement", options->names, "Only these; docs/measurements.md lists them")
        ->type_name("NAME");
    command->add_option("--picture", options->picture, "Draws the tapes on the body")
        ->type_name("FILE");
    command
        ->add_option("--sheet", options->sheet,
                     "Draws each measurement by itself, small, with its name")
        ->type_name("FILE");
    command->add_option("--views", options->drawing.views, "Views in the picture")
        ->capture_default_str();
    command->add_option("--sex", options->sex, "Of a scan: whose population to expect")
        ->check(CLI::IsMember({"female", "male"}));
    command->footer("Example: toile measure anna.json --picture anna.png");
    command->callback([options, &global] { measure(*options, global); });
}

} // namespace toile::apps
