// toile tryon: an avatar dressed and drawn, standing in a pose or moving through a motion.
#include "apps/commands.h"
#include "apps/contact_sheet.h"
#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/look_file.h"
#include "apps/picture_folder.h"
#include "apps/picture_options.h"
#include "apps/run_output.h"
#include "apps/still_look.h"
#include "core/error.h"
#include "core/log.h"
#include "garment/fit_file.h"
#include "pipeline/motion_source.h"
#include "pipeline/person_fit.h"
#include "pipeline/try_on_run.h"

namespace toile::apps {
namespace {

struct TryOnOptions {
    std::string body = "mannequin";
    std::string garments;
    std::string size = "auto";
    std::string pose;
    std::string animation;
    std::string out;
    std::string views = "front";
    std::string glb;
    std::string cache;
    std::string report;
    std::string fit;
    std::string fit_map;
    std::string spoil;
    std::uint64_t frames = 0;
    PictureOptions picture;
};

class TryOn {
  public:
    TryOn(const TryOnOptions& options, const GlobalOptions& global)
        : options_(options),
          room_(global, {options.body, split_names(options.garments, "--garment"), options.size},
                false),
          views_(render::views_from_names(options.views)), map_(fit_map_from_name(options.fit_map)),
          spoil_(spoil_from_name(options.spoil)) {
        run_options_.measure_contact = !options_.report.empty();
        run_options_.seed = global.seed;
        run_options_.interrupted = [] { return host::interrupt_flag().load(); };
    }

    // Stands in the pose until the cloth hangs, then draws every view side by side.
    void still() {
        const pipeline::RunReport report = leave_to_hang(room_, options_.pose, run_options_);
        // Written first, so that it is there even if drawing fails.
        if (!options_.fit.empty())
            report_fit();
        else if (map_ != FitMapKind::none)
            fit_for_legend();
        const auto context = render::make_offscreen_context();
        Look look(*context, options_.picture.renderer(), room_.person(), options_.picture.colourway,
                  map_);
        look.spoil(spoil_);
        look.update();
        imaging::save_image(draw(look, bounds_now(room_.person())), options_.out);
        finish(report);
    }

    // Every frame of a motion as a picture.
    void moving() {
        const body::BodyModel& model = room_.body().model();
        const body::Skeleton& skeleton = model.skeleton;
        const body::BodyVolumes volumes =
            body::measure_volumes(skeleton, model.rest.positions, model.parts);
        const body::Motion motion = body::load_motion(options_.animation, skeleton, &volumes);
        pipeline::MotionSource source(motion, skeleton, kFramesPerSecond);
        if (options_.frames > 0) run_options_.most_frames = options_.frames;
        pipeline::TryOnRun run(source, room_.person(), run_options_);
        PictureFolder pictures(options_.out);
        TrackFile track(options_.out);
        LookCache cache(options_.cache);
        const auto context = render::make_offscreen_context();
        Look look(*context, options_.picture.renderer(), room_.person(), options_.picture.colourway,
                  map_);
        look.spoil(spoil_);
        RunProgress progress;
        std::unique_ptr<StageBox> stage;
        while (run.next()) {
            if (!stage)
                stage = std::make_unique<StageBox>(room_.person());
            else
                stage->follow(room_.person(), 1.0 / kFramesPerSecond);
            run.begin_drawing();
            look.update();
            const imaging::Image picture = draw(look, stage->box());
            run.end_drawing();
            pictures.add(picture);
            track.add(run.frame());
            cache.add(room_.person(), run.frame());
            progress.frame();
        }
        pictures.make_film("tryon", kFramesPerSecond);
        finish(run.report());
    }

  private:
    // Every view, side by side.
    imaging::Image draw(Look& look, const render::Box& box) {
        std::vector<imaging::Image> pictures;
        for (const render::View& view : views_) {
            look.draw(view, box);
            pictures.push_back(look.renderer().read());
        }
        if (map_ != FitMapKind::none)
            pictures.push_back(fit_legend(map_, look.renderer().height(), fit_ ? &*fit_ : nullptr));
        return side_by_side(pictures);
    }

    void report_fit() {
        fit_ = pipeline::fit_of(room_.person());
        for (const garment::FitFailure& failure : fit_->failures)
            log::warning(failure.text);
        if (!options_.fit.empty()) garment::write_fit(*fit_, options_.fit);
    }

    // A body without landmarks has no girths; its map can be drawn all the same.
    void fit_for_legend() {
        try {
            report_fit();
        } catch (const Error& e) {
            log::warning(std::string("the legend has no girths: ") + e.what());
        }
    }

    void finish(const pipeline::RunReport& report) {
        for (const std::string& choice : room_.choices())
            log::info(choice);
        for (const std::string& fault : room_.person().faults())
            if (!fit_) log::warning(fault);
        if (!options_.glb.empty()) save_look(room_.person(), options_.glb);
        put_out_report(report, room_, options_.report);
    }

    const TryOnOptions& options_;
    FittingRoom room_;
    std::vector<render::View> views_;
    FitMapKind map_;
    Spoil spoil_;
    std::optional<garment::FitReport> fit_;
    pipeline::RunOptions run_options_;
};

void try_on(const TryOnOptions& options, const GlobalOptions& global) {
    if (!options.pose.empty() && !options.animation.empty())
        throw UsageError("tryon takes either --pose or --animation, not both");
    if (options.animation.empty() && std::filesystem::path(options.out).extension() != ".png")
        throw UsageError("tryon --out '" + options.out +
                         "': a still is written as .png (with --animation: a folder)");
    if (options.animation.empty() && !options.cache.empty())
        throw UsageError("tryon --cache keeps the frames of an --animation; there is none");
    if (!options.animation.empty() && !options.fit.empty())
        throw UsageError("tryon --fit tells how clothes fit that have come to rest; leave "
                         "--animation out, and give a --pose if it is another than the usual one");
    // What is wrong with the call is said before anything is loaded.
    (void)fit_map_from_name(options.fit_map);
    (void)render::views_from_names(options.views);
    (void)options.picture.renderer();
    host::catch_interrupts();
    TryOn look(options, global);
    if (options.animation.empty())
        look.still();
    else
        look.moving();
}

} // namespace

void add_tryon_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("tryon", "Dresses an avatar and draws it");
    auto options = std::make_shared<TryOnOptions>();
    command->add_option("--body", options->body, "Body to dress")
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
    command->add_option("--animation", options->animation, "Motion to play: .bvh, .json, .jsonl")
        ->type_name("FILE");
    command->add_option("--out", options->out, "Picture; with --animation a folder of pictures")
        ->type_name("look.png|DIR")
        ->required();
    command
        ->add_option("--views", options->views,
                     "Views, side by side: front, back, left, right, ...")
        ->type_name("VIEW[,VIEW...]")
        ->capture_default_str();
    command->add_option("--glb", options->glb, "Writes the dressed body as a 3D file too")
        ->type_name("look.glb");
    command->add_option("--frames", options->frames, "With --animation: stops after this many");
    command
        ->add_option("--cache", options->cache,
                     "With --animation: keeps body and garment surfaces of every frame")
        ->type_name("DIR");
    command->add_option("--report", options->report, "File for the figures of the run, as JSON")
        ->type_name("FILE");
    command->add_option("--fit", options->fit, "File that says how it fits, as JSON")
        ->type_name("fit.json");
    command
        ->add_option("--fit-map", options->fit_map,
                     "Colours the garments by the room they leave or by how they are stretched")
        ->type_name("ease|strain");
    options->picture.add_to(*command);
    command
        ->add_option("--spoil", options->spoil,
                     "Draws wrongly on purpose: garments 1 cm to the side, no shadows, no body")
        ->check(CLI::IsMember({"shift", "shadows", "body"}))
        ->type_name("shift|shadows|body")
        ->group("For tests of pictures");
    command->footer("Example: toile tryon --body woman --garment t-shirt,skirt --views front,back "
                    "--out look.png");
    command->callback([options, &global] { try_on(*options, global); });
}

} // namespace toile::apps
