// toile report: a page for the shopper to take along.
#include "apps/commands.h"
#include "apps/contact_sheet.h"
#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/look_file.h"
#include "apps/report_page.h"
#include "apps/still_look.h"
#include "apps/tape_picture.h"
#include "body/measurer.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"
#include "pipeline/person_fit.h"

#include <iostream>
#include <unistd.h>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
    std::string body = "woman", garments, size = "auto", pose, colourway, title;
    fs::path out;
};

constexpr int kWidth = 400, kHeight = 560; // of each picture, pixels
constexpr std::size_t kMostLook = std::size_t{256} << 20;

const std::vector<std::string> kTapes = {
    "neck_girth", "bust_girth",      "waist_girth", "hip_girth",         "thigh_girth",
    "knee_girth", "upper_arm_girth", "wrist_girth", "back_waist_length", "inside_leg_length",
};

std::vector<std::pair<std::string, imaging::Image>> draw_views(FittingRoom& room,
                                                               const ReportOptions& options) {
    const auto context = render::make_offscreen_context();
    render::RendererOptions picture;
    picture.width = kWidth;
    picture.height = kHeight;
    Look look(*context, picture, room.person(), options.colourway);
    look.update();
    std::vector<std::pair<std::string, imaging::Image>> out;
    for (const auto& [name, caption] : {std::pair("front", "From the front"),
                                        {"left", "From the left"},
                                        {"back", "From the back"},
                                        {"right", "From the right"}}) {
        look.draw(render::view_from_name(name), bounds_now(room.person()));
        out.emplace_back(caption, look.renderer().read());
    }
    return out;
}

imaging::Image draw_map(FittingRoom& room, FitMapKind kind, const garment::FitReport& fit) {
    const auto context = render::make_offscreen_context();
    render::RendererOptions picture;
    picture.width = kWidth;
    picture.height = kHeight;
    Look look(*context, picture, room.person(), "", kind);
    look.update();
    std::vector<imaging::Image> pictures;
    for (const char* view : {"front", "back"}) {
        look.draw(render::view_from_name(view), bounds_now(room.person()));
        pictures.push_back(look.renderer().read());
    }
    pictures.push_back(fit_legend(kind, kHeight, &fit));
    return side_by_side(pictures);
}

/// Through a file beside the page, which is removed again.
std::vector<std::uint8_t> look_bytes(FittingRoom& room, const fs::path& page) {
    const fs::path file = page.parent_path() / (".look_" + std::to_string(getpid()) + ".glb");
    save_look(room.person(), file);
    const auto bytes = read_bytes(file, kMostLook);
    fs::remove(file);
    return {bytes.begin(), bytes.end()};
}

void measure(const body::BodyModel& model, ReportContent& content) {
    const body::Measurer measurer(model);
    const body::Figure figure = measurer.figure(model.rest.positions, model.skeleton);
    std::vector<const body::MeasurementDefinition*> all;
    for (const auto& definition : body::measurement_definitions())
        all.push_back(&definition);
    content.measurements = body::lay_tapes(figure, all);
    content.pictures.tapes =
        draw_tapes(model, body::lay_tapes(figure, body::measurement_definitions(kTapes)));
}

std::string title_of(const garment::FitReport& fit) {
    std::string out;
    for (const garment::GarmentFit& garment : fit.garments)
        out += (out.empty() ? "" : " with ") + garment.name;
    return out;
}

void report(const ReportOptions& options, const GlobalOptions& global) {
    if (options.out.extension() != ".html")
        throw UsageError("report --out '" + options.out.string() +
                         "': a report is written as .html");
    host::catch_interrupts();
    FittingRoom room(
        global, {options.body, split_names(options.garments, "--garment"), options.size}, false);
    const body::BodyModel& model = room.body().model();
    pipeline::RunOptions run;
    run.seed = global.seed;
    run.interrupted = [] { return host::interrupt_flag().load(); };
    leave_to_hang(room, options.pose, run);
    if (host::interrupt_flag()) throw host::Cancelled("interrupted; no report was written");

    ReportContent content;
    content.fit = pipeline::fit_of(room.person());
    content.title = options.title.empty() ? title_of(content.fit) : options.title;
    content.subtitle = "On the body " + fs::path(options.body).stem().string();
    content.pictures.views = draw_views(room, options);
    content.pictures.ease_map = draw_map(room, FitMapKind::ease, content.fit);
    content.pictures.strain_map = draw_map(room, FitMapKind::strain, content.fit);
    measure(model, content);
    if (options.out.has_parent_path()) fs::create_directories(options.out.parent_path());
    content.look = look_bytes(room, options.out);
    for (const garment::FitFailure& failure : content.fit.failures)
        content.notes.push_back(failure.text);
    content.notes.emplace_back("Cloth is simulated; how it feels, a mirror cannot say");
    content.notes.emplace_back("This page holds body measurements: it was written because somebody "
                               "asked for it, needs no network, and is gone when it is deleted");
    write_text(options.out, report_page(content, program_folder() / "report"));
    for (const std::string& choice : room.choices())
        log::info(choice);
    std::cout << "wrote " << options.out.string() << "\n";
}

} // namespace

void add_report_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand(
        "report", "Writes a page about how clothes fit somebody: one file, to take along");
    auto options = std::make_shared<ReportOptions>();
    command->add_option("--body", options->body, "Who wears it")
        ->type_name("AVATAR|body.json")
        ->capture_default_str();
    command->add_option("--garment", options->garments, "Garments, by id, folder or zip")
        ->type_name("ID[,ID...]")
        ->required();
    command->add_option("--size", options->size, "Size of the garments; auto: by the size chart")
        ->capture_default_str();
    command
        ->add_option("--pose", options->pose,
                     "Pose or motion file: its first frame, or the one at a time")
        ->type_name("FILE[@SECONDS]");
    command->add_option("--colourway", options->colourway, "Colourway of the garments that have it")
        ->type_name("NAME");
    command->add_option("--title", options->title, "Heading of the page; else the garments' names");
    command->add_option("--out", options->out, "The page")->type_name("report.html")->required();
    command->footer("Example: toile report --body anna.json --garment dress --out dress.html");
    command->callback([options, &global] { report(*options, global); });
}

} // namespace toile::apps
