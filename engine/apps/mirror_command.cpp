// toile mirror: a garment bound to a tracked person each frame, shown or written as pictures.
#include "apps/commands.h"
#include "apps/fitting_room.h"
#include "apps/look.h"
#include "apps/picture_folder.h"
#include "apps/picture_options.h"
#include "apps/run_output.h"
#include "core/error.h"
#include "core/log.h"
#include "pipeline/try_on_run.h"
#include "render/window.h"

namespace toile::apps {
namespace {

struct MirrorOptions {
    std::string source;
    std::string garments;
    std::string size = "auto";
    std::string body = "mannequin";
    bool headless = false;
    std::string out;
    std::uint64_t frames = 0;
    bool realtime = false;
    std::string record;
    std::string report;
    PictureOptions picture;
};

class Mirror {
  public:
    Mirror(const MirrorOptions& options, const GlobalOptions& global)
        : options_(options),
          room_(global, {options.body, split_names(options.garments, "--garment"), options.size},
                options.realtime || !options.headless),
          source_(pipeline::open_source(options.source, room_.registry(), room_.services(),
                                        room_.body(), room_.limits(), room_.job())),
          run_(*source_, room_.person(), run_options(global)) {
        for (const std::string& choice : room_.choices())
            log::info(choice);
    }

    void run_headless() {
        PictureFolder pictures(options_.out);
        const auto context = render::make_offscreen_context();
        Look look(*context, options_.picture.renderer(), room_.person(),
                  options_.picture.colourway);
        TrackFile track(options_.record.empty() ? options_.out : options_.record);
        RunProgress progress;
        imaging::Image picture;
        loop(look, track, progress, [&] {
            look.renderer().read(picture);
            pictures.add(picture);
            return true;
        });
        pictures.make_film("mirror", track.frames_per_second());
        finish();
    }

    void run_in_window() {
        const render::RendererOptions size = options_.picture.renderer();
        render::WindowOptions shape;
        shape.width = size.width;
        shape.height = size.height;
        render::Window window(shape);
        Look look(window.context(), size, room_.person(), options_.picture.colourway);
        TrackFile track(options_.record);
        RunProgress progress;
        loop(look, track, progress, [&] {
            window.show(look.renderer());
            return window.poll();
        });
        finish();
    }

  private:
    [[nodiscard]] pipeline::RunOptions run_options(const GlobalOptions& global) const {
        pipeline::RunOptions out;
        out.realtime = options_.realtime || !options_.headless;
        if (options_.frames > 0) out.most_frames = options_.frames;
        out.measure_contact = !options_.report.empty();
        out.seed = global.seed;
        out.interrupted = [] { return host::interrupt_flag().load(); };
        return out;
    }

    // show() puts out the drawn picture and tells whether to go on.
    template <class Show>
    void loop(Look& look, TrackFile& track, RunProgress& progress, const Show& show) {
        const render::View front = render::view_from_name("front");
        std::unique_ptr<StageBox> stage;
        std::int64_t last_ns = 0;
        bool go_on = true;
        while (go_on && run_.next()) {
            const pipeline::BodyFrame& frame = run_.frame();
            if (!stage)
                stage = std::make_unique<StageBox>(room_.person());
            else
                stage->follow(room_.person(),
                              1e-9 * static_cast<double>(frame.timestamp_ns - last_ns));
            last_ns = frame.timestamp_ns;
            run_.begin_drawing();
            look.update();
            look.draw(front, stage->box());
            go_on = show();
            run_.end_drawing();
            track.add(frame);
            progress.frame();
        }
        if (!stage) throw Error(options_.source + ": no frame with a person in it");
    }

    void finish() {
        for (const std::string& fault : room_.person().faults())
            log::warning(fault);
        put_out_report(run_.report(), room_, options_.report);
    }

    const MirrorOptions& options_;
    FittingRoom room_;
    std::unique_ptr<pipeline::FrameSource> source_;
    pipeline::TryOnRun run_;
};

void mirror(const MirrorOptions& options, const GlobalOptions& global) {
    if (options.headless && options.out.empty())
        throw UsageError("mirror --headless needs --out DIR for its pictures");
    if (!options.headless && !options.out.empty())
        throw UsageError("mirror --out writes pictures only with --headless; a window shows them");
    (void)options.picture.renderer(); // refuses a wrong size before anything is loaded
    host::catch_interrupts();
    Mirror mirror(options, global);
    if (options.headless)
        mirror.run_headless();
    else
        mirror.run_in_window();
}

} // namespace

void add_mirror_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("mirror", "Dresses a tracked person, frame by frame");
    auto options = std::make_shared<MirrorOptions>();
    command
        ->add_option("--source", options->source,
                     "Where the person comes from: openni2: (a camera, its number or FILE.oni), "
                     "capture:DIR, "
                     "simulated:SCENARIO.json, kinect-log:FILE")
        ->type_name("URI")
        ->required();
    command->add_option("--garment", options->garments, "Garments, by id, folder or zip")
        ->type_name("ID[,ID...]")
        ->required();
    command->add_option("--size", options->size, "Size of the garments; auto: by the size chart")
        ->capture_default_str();
    command->add_option("--body", options->body, "Body that the person is shown as")
        ->type_name("AVATAR|body.json")
        ->capture_default_str();
    command->add_flag("--headless", options->headless, "Writes pictures, opens no window");
    command->add_option("--out", options->out, "Folder for the pictures, the film and the track")
        ->type_name("DIR");
    command->add_option("--frames", options->frames, "Stops after this many frames");
    command->add_flag("--realtime", options->realtime,
                      "Headless too, keeps to the source's time and drops late frames");
    command->add_option("--record", options->record, "Folder for the person's track")
        ->type_name("DIR");
    command->add_option("--report", options->report, "File for the figures of the run, as JSON")
        ->type_name("FILE");
    options->picture.add_to(*command);
    command->footer("Example: toile mirror --source kinect-log:wave.csv --garment t-shirt,skirt "
                    "--headless --out pictures");
    command->callback([options, &global] { mirror(*options, global); });
}

} // namespace toile::apps
