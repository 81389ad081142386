// toile kiosk: the mirror of a shop.
#include "apps/commands.h"
#include "apps/kiosk/kiosk.h"
#include "apps/kiosk/preview.h"
#include "apps/kiosk/watchdog.h"
#include "apps/spoil.h"
#include "core/error.h"
#include "core/paths.h"
#include "host/job.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace toile::apps {
namespace {

struct KioskOptions {
    std::string config, source, language, orientation, screen, out, script, preview, report, spoil;
    bool headless = false, realtime = false, safe = false, stock = false, no_watchdog = false,
         no_draw = false;
    std::uint64_t frames = 0, restarts = 0;
    int heartbeat = -1;
};

void set_size(kiosk::KioskConfig& config, const KioskOptions& options) {
    if (!options.screen.empty()) {
        const std::size_t x = options.screen.find('x');
        try {
            config.width = std::stoi(options.screen.substr(0, x));
            config.height = std::stoi(options.screen.substr(x + 1));
        } catch (const std::exception&) {
            config.width = 0;
        }
        if (x == std::string::npos || config.width < 240 || config.height < 240 ||
            config.width > 8192 || config.height > 8192)
            throw UsageError("--screen '" + options.screen +
                             "': a size such as 1080x1920, each side 240 to 8192");
    }
    const bool upright = config.height > config.width;
    if ((options.orientation == "portrait" && !upright) ||
        (options.orientation == "landscape" && upright))
        std::swap(config.width, config.height);
}

kiosk::KioskRun run_of(const KioskOptions& options) {
    kiosk::KioskRun out;
    if (!options.config.empty()) out.config = kiosk::load_config(options.config);
    out.config_file = options.config;
    if (!options.source.empty()) out.config.source = options.source;
    if (!options.language.empty()) out.config.language = options.language;
    set_size(out.config, options);
    out.headless = options.headless;
    out.realtime = options.realtime;
    out.out = options.out;
    if (!options.script.empty()) out.script = kiosk::load_script(options.script);
    out.frames = options.frames;
    out.draw = !options.no_draw;
    out.stock = options.stock;
    out.safe = options.safe;
    out.restarts = options.restarts;
    out.heartbeat = options.heartbeat;
    out.report = options.report;
    out.spoil = spoil_from_name(options.spoil);
    return out;
}

// The same command once more, as the mirror itself.
std::vector<std::string> child_arguments(const KioskOptions& options, const GlobalOptions& global) {
    std::vector<std::string> out = {program_file().string(), "kiosk"};
    const auto add = [&](const char* name, const std::string& value) {
        if (!value.empty()) out.insert(out.end(), {name, value});
    };
    add("--config", options.config);
    add("--source", options.source);
    add("--language", options.language);
    add("--orientation", options.orientation);
    add("--screen", options.screen);
    add("--out", options.out);
    add("--script", options.script);
    add("--report", options.report);
    add("--spoil", options.spoil);
    if (options.headless) out.emplace_back("--headless");
    if (options.realtime) out.emplace_back("--realtime");
    if (options.no_draw) out.emplace_back("--no-draw");
    if (options.frames > 0) add("--frames", std::to_string(options.frames));
    for (const std::filesystem::path& folder : global.plugin_folders)
        add("--plugins", folder.string());
    add("--seed", std::to_string(global.seed));
    add("--threads", std::to_string(global.threads));
    if (global.verbose) out.emplace_back("--verbose");
    return out;
}

int kiosk_command(const KioskOptions& options, const GlobalOptions& global) {
    kiosk::KioskRun run = run_of(options);
    if (!options.preview.empty()) {
        if (options.out.empty()) throw UsageError("kiosk --preview needs --out FILE.png");
        kiosk::preview(run.config, options.preview, options.out);
        return 0;
    }
    if (run.config.source.empty())
        throw UsageError("kiosk needs --source URI, or a source in its --config FILE");
    if (run.out.empty() && std::any_of(run.script.steps.begin(), run.script.steps.end(),
                                       [](const kiosk::ScriptStep& step) {
                                           return step.kind == kiosk::ScriptStep::Kind::picture;
                                       }))
        throw UsageError("kiosk: the script asks for pictures; --out DIR says where");
    if (!run.out.empty() && run.out.extension() != ".png")
        std::filesystem::create_directories(run.out);
    if (!run.draw && !run.headless) throw UsageError("kiosk --no-draw needs --headless");
    const bool live = !run.headless || run.realtime;
    if (options.heartbeat < 0 && live && run.config.watchdog && !options.no_watchdog)
        return kiosk::watch(child_arguments(options, global), {run.config.stall_s});
    // The graphics library would keep compiled shaders in the home folder.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("MESA_GLSL_CACHE_DISABLE", "true", 1);
    host::catch_interrupts();
    kiosk::Kiosk mirror(std::move(run), global);
    mirror.run();
    return 0;
}

} // namespace

void add_kiosk_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("kiosk", "The mirror of a shop, full screen");
    const auto options = std::make_shared<KioskOptions>();
    command->add_option("--config", options->config, "What the operator sets; docs/kiosk.md")
        ->type_name("FILE");
    command->add_option("--source", options->source, "Depth camera, instead of the file's")
        ->type_name("URI");
    command->add_option("--language", options->language, "en, de, or a file of your own")
        ->type_name("NAME");
    command->add_option("--orientation", options->orientation, "Turns the screen's size")
        ->check(CLI::IsMember({"portrait", "landscape"}));
    command->add_option("--screen", options->screen, "Pixels of the screen")
        ->type_name("WIDTHxHEIGHT");
    command->add_flag("--headless", options->headless, "No window; lock-step");
    command->add_flag("--realtime", options->realtime, "Headless too, keeps to the source's time");
    command
        ->add_option("--out", options->out,
                     "Headless: folder for a picture of every frame, or FILE.png for the last of "
                     "--frames")
        ->type_name("DIR");
    command->add_option("--script", options->script, "What is pressed at which frame")
        ->type_name("FILE");
    command->add_option("--frames", options->frames,
                        "Ends after so many; recordings begin again until then");
    command
        ->add_option("--preview", options->preview,
                     "Draws one screen without a camera: attract, consent, measure, mirror, "
                     "frozen, goodbye, setup, safe")
        ->type_name("SCREEN");
    command->add_option("--report", options->report, "Figures of the run, as JSON")
        ->type_name("FILE");
    command->add_flag("--no-draw", options->no_draw,
                      "Headless: all but pictures, to measure the rest with --report");
    command->add_flag("--no-watchdog", options->no_watchdog, "One process, not started again");
    // Between the watchdog and the mirror.
    command->add_option("--spoil", options->spoil, "Draws the camera's view wrongly on purpose")
        ->check(CLI::IsMember({"shift", "shadows", "occlusion"}))
        ->type_name("shift|shadows|occlusion")
        ->group("For tests of pictures");
    command->add_flag("--stock", options->stock)->group("");
    command->add_flag("--safe", options->safe)->group("");
    command->add_option("--restarts", options->restarts)->group("");
    command->add_option("--heartbeat", options->heartbeat)->group("");
    command->footer("Example: toile kiosk --config shop.json\n"
                    "         toile kiosk --preview consent --language de --out consent.png");
    command->callback([options, &global] {
        const int status = kiosk_command(*options, global);
        if (status != 0) throw Error("the mirror ended with status " + std::to_string(status));
    });
}

} // namespace toile::apps
