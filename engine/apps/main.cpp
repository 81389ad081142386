#include "apps/commands.h"
#include "core/error.h"
#include "core/log.h"

#include <cstdio>
#include <exception>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

int run(int argc, char** argv) {
    CLI::App app("Toile, a garment try-on engine", "toile");
    app.set_version_flag("--version", TOILE_VERSION);
    app.require_subcommand(1);
    app.fallthrough();
    toile::apps::GlobalOptions options;
    app.add_option("--plugins", options.plugin_folders, "Further folders to look for plugins in")
        ->type_name("DIR");
    app.add_option("--seed", options.seed, "Seed of all random numbers")->capture_default_str();
    app.add_option("--threads", options.threads, "Threads to compute with; 0: all cores");
    app.add_flag("--verbose", options.verbose, "Say more on standard error");
    toile::apps::add_avatar_commands(app, options);
    toile::apps::add_mirror_commands(app, options);
    toile::apps::add_tryon_commands(app, options);
    toile::apps::add_compare_commands(app, options);
    toile::apps::add_view_commands(app, options);
    toile::apps::add_plugin_commands(app, options);
    toile::apps::add_garment_commands(app, options);
    toile::apps::add_record_commands(app, options);
    toile::apps::add_track_commands(app, options);
    toile::apps::add_fit_commands(app, options);
    toile::apps::add_scan_commands(app, options);
    toile::apps::add_dress_commands(app, options);
    toile::apps::add_measure_commands(app, options);
    toile::apps::add_catalogue_commands(app, options);
    toile::apps::add_report_commands(app, options);
    toile::apps::add_bench_commands(app, options);
    toile::apps::add_kiosk_commands(app, options);
    toile::apps::add_tool_commands(app, options, {argv, static_cast<std::size_t>(argc)});
    app.parse_complete_callback([&] {
        if (options.verbose) toile::log::set_level(toile::log::Level::debug);
    });

    try {
        app.parse(argc, argv);
    } catch (const CLI::RequiredError& e) {
        const std::vector<std::string> words = app.remaining();
        if (!app.get_subcommands().empty() || words.empty()) return app.exit(e), kWrongUsage;
        toile::log::error("'" + words.front() + "' is no command; toile --help lists them");
        return kWrongUsage;
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : kWrongUsage;
    } catch (const toile::UsageError& e) {
        toile::log::error(e.what());
        return kWrongUsage;
    } catch (const std::exception& e) {
        toile::log::error(e.what());
        return kFailed;
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    // By feature: clang 16 does not know "x86-64-v3" here.
    if (__builtin_cpu_supports("avx2") == 0 || __builtin_cpu_supports("fma") == 0 ||
        __builtin_cpu_supports("bmi2") == 0) {
        std::fputs("toile: this processor lacks AVX2 and FMA (x86-64-v3), which Toile needs\n",
                   stderr);
        return kFailed;
    }
    return run(argc, argv);
}
