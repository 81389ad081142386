// toile scan: one coloured surface of a person or thing from cameras' pictures.
#include "apps/commands.h"
#include "apps/plugin_limits.h"
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
    std::string method;
    std::uint32_t frames = 0;
    ScanOutput output;
};

/// All cameras of all sources, and their frames in step.
class Cameras {
  public:
    Cameras(const std::vector<std::string>& uris, host::Registry& registry,
            host::Services& services, const toile_limits& limits, host::Job& job)
        : job_(job) {
        for (const std::string& uri : uris) {
            sources_.push_back(
                std::make_unique<pipeline::SensorSource>(uri, registry, services, limits, job));
            const auto& streams = sources_.back()->streams();
            streams_.insert(streams_.end(), streams.begin(), streams.end());
        }
    }

    [[nodiscard]] const std::vector<pipeline::SensorStream>& streams() const { return streams_; }

    /// One frame of each camera; false at the end of one of them.
    bool next(std::vector<pipeline::SensorFrame>& out) {
        out.resize(streams_.size());
        std::size_t at = 0;
        for (const auto& source : sources_)
            for (std::uint32_t c = 0; c < source->streams().size(); ++c)
                if (!wait(*source, c, out[at++])) return false;
        return true;
    }

  private:
    bool wait(pipeline::SensorSource& source, std::uint32_t stream, pipeline::SensorFrame& out) {
        constexpr int kMostWaits = 5000; // of a millisecond: a live sensor without a new picture
        for (int waits = 0; !source.next(stream, out); ++waits) {
            if (source.ended(stream) || waits > kMostWaits || job_.cancelled()) return false;
            usleep(1000);
        }
        return true;
    }

    host::Job& job_;
    std::vector<std::unique_ptr<pipeline::SensorSource>> sources_;
    std::vector<pipeline::SensorStream> streams_;
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
std::size_t feed_all(Cameras& cameras, pipeline::Scanning& scanning, std::uint32_t most) {
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

void scan(const ScanCommand& command, const GlobalOptions& global) {
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
    Cameras cameras(command.sources, registry, services, limits, feeding);
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
    add_scan_output(*command, options->output);
    command->footer("Example: toile scan --source capture:turn --out anna.ply --triangles 50000 "
                    "--picture anna.png\n"
                    "         toile scan --source openni2: --frames 300 --out anna.glb --rig");
    command->callback([options, &global] { scan(*options, global); });
}

} // namespace toile::apps
