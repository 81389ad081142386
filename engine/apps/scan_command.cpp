// toile scan: one coloured surface of a person or thing from cameras' pictures.
#include "apps/camera_set.h"
#include "apps/commands.h"
#include "apps/plugin_limits.h"
#include "apps/rig_calibration.h"
#include "apps/scan_output.h"
#include "assets/files.h"
#include "core/error.h"
#include "core/log.h"

#include <chrono>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <unistd.h>

namespace toile::apps {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

struct ScanCommand {
    std::vector<std::string> sources, settings;
    std::string method, calibrate;
    double ball_radius_m = 0.0;
    fs::path extrinsics; ///< where the cameras stand
    std::uint32_t frames = 0;
    ScanOutput output;
};

void set(pipeline::Scanning& scanning, const std::string& setting) {
    const auto at = setting.find('=');
    char* end = nullptr;
    const double value =
        at == std::string::npos ? 0.0 : std::strtod(setting.c_str() + at + 1, &end);
    if (at == std::string::npos || end == setting.c_str() + at + 1 || *end != '\0')
        throw UsageError("scan --set '" + setting + "': write NAME=NUMBER");
    scanning.set(setting.substr(0, at), value);
}

/// Until the sources end, enough frames are there, or somebody wants it to stop.
std::size_t feed_all(CameraSet& cameras, pipeline::Scanning& scanning, std::uint32_t most) {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    std::vector<pipeline::SensorFrame> instant;
    std::size_t count = 0;
    while ((most == 0 || count < most) && !host::interrupt_flag() && cameras.next(instant)) {
        scanning.feed(instant);
        ++count;
        if (terminal) std::fprintf(stderr, "\r%zu frames", count);
    }
    if (terminal) std::fputs("\r", stderr);
    return count;
}

/// toile scan --calibrate: writes where the cameras stand.
void calibrate(const ScanCommand& command, const GlobalOptions& global) {
    const fs::path& out = command.output.file;
    if (out.extension() != ".json")
        throw UsageError("scan --calibrate --out '" + out.string() + "': name a .json file");
    if (!out.parent_path().empty() && !fs::is_directory(out.parent_path()))
        throw UsageError("scan --out '" + out.string() + "': its folder does not exist");
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    const toile_limits limits = limits_of(global, services, kScannedPerson);
    host::catch_interrupts();
    host::Job feeding({}, &host::interrupt_flag());
    CameraSet cameras(command.sources, registry, services, limits, feeding);
    const imaging::RigFile rig =
        calibrate_rig(cameras, {command.calibrate, command.ball_radius_m, command.frames}, registry,
                      services, limits);
    save_rig(rig, out);
    std::cout << rig.report.dump(2) << "\nwrote " << out.string() << "\n";
}

void scan(const ScanCommand& command, const GlobalOptions& global) {
    if (!command.calibrate.empty()) return calibrate(command, global);
    check(command.output);
    const auto start = std::chrono::steady_clock::now();
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    if (command.sources.empty()) throw UsageError("scan: name at least one --source URI");
    const toile_limits limits = limits_of(global, services, kScannedPerson);
    pipeline::Scanning scanning(registry, services, limits, command.method);
    for (const std::string& setting : command.settings)
        set(scanning, setting);
    host::catch_interrupts();
    host::Job feeding({}, &host::interrupt_flag());
    CameraSet cameras(command.sources, registry, services, limits, feeding);
    if (!command.extrinsics.empty()) cameras.place(command.extrinsics);
    scanning.begin(cameras.streams());
    const std::size_t count = feed_all(cameras, scanning, command.frames);
    if (count == 0) throw Error(command.sources.front() + ": gave no frame");
    const auto fed = std::chrono::steady_clock::now();
    host::Job job; // what was fed is used, also after an interruption
    pipeline::ScannedSurface scanned = scanning.finish(job);
    const auto done = std::chrono::steady_clock::now();
    nlohmann::ordered_json report = {{"method", scanning.method()}, {"frames_fed", count}};
    report.update(scanned.report);
    report["seconds"] = {{"frames", Seconds(fed - start).count()},
                         {"surface", Seconds(done - fed).count()}};
    scanned.report = std::move(report);
    save(std::move(scanned), command.output, registry, services, limits);
    std::cout << std::fixed << std::setprecision(1)
              << Seconds(std::chrono::steady_clock::now() - start).count() << " s, wrote "
              << command.output.file.string() << "\n";
}

} // namespace

void add_scan_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand(
        "scan", "Makes one coloured surface of a person or thing from depth pictures");
    const auto options = std::make_shared<ScanCommand>();
    command
        ->add_option("--source", options->sources,
                     "Cameras: capture:DIR, openni2:, simulated:SCENARIO.json; once for each")
        ->type_name("URI")
        ->required();
    command
        ->add_option("--method", options->method,
                     "How: what the scanners among the plugins are called, as fusion (a rigid "
                     "subject); without, the one of highest priority")
        ->type_name("NAME");
    command->add_option("--set", options->settings, "A parameter of the method, once for each")
        ->type_name("NAME=NUMBER");
    command->add_option("--frames", options->frames, "Use the first so many frames only");
    command
        ->add_option("--calibrate", options->calibrate,
                     "Instead of a surface, find out where the cameras stand to each other: from "
                     "a ball that is moved about, or from a person whom all see")
        ->check(CLI::IsMember({"ball", "person"}));
    command
        ->add_option("--ball-radius", options->ball_radius_m,
                     "Metres, if you know it; else it is found out")
        ->check(CLI::Range(0.02, 0.5));
    command
        ->add_option("--extrinsics", options->extrinsics,
                     "Where the cameras stand, as --calibrate wrote it")
        ->check(CLI::ExistingFile)
        ->type_name("FILE");
    add_scan_output(*command, options->output);
    command->footer(
        "Example: toile scan --source capture:turn --out anna.ply --triangles 50000 "
        "--picture anna.png\n"
        "         toile scan --source openni2: --frames 300 --out anna.glb --rig\n"
        "         toile scan --source capture:turn --out anna.glb --triangles 5000 --texture\n"
        "         toile scan --source capture:ball --calibrate ball --out rig.json\n"
        "         toile scan --source capture:four --extrinsics rig.json --out anna.ply");
    command->callback([options, &global] { scan(*options, global); });
}

} // namespace toile::apps
