#include "apps/fitted_body.h"

#include "apps/plugin_limits.h"
#include "assets/colored_mesh.h"
#include "core/error.h"
#include "core/log.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace toile::apps {
namespace {

constexpr std::uint32_t kDressedFrames = 5; // P5 4: the fewest that tell cloth from skin
constexpr std::uint32_t kMostFrames = 20;

/// All frames that a fit shall use, each of all cameras.
struct Pictures {
    std::vector<pipeline::SensorStream> streams;
    std::vector<std::vector<pipeline::SensorFrame>> instants;
};

/// Takes every other away.
void halve(std::vector<std::vector<pipeline::SensorFrame>>& frames) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < frames.size(); i += 2)
        std::swap(frames[kept++], frames[i]);
    frames.resize(kept);
}

/// Frames of every camera of one URI, in order, spread over a recording.
void read_pictures(const std::string& uri, host::Registry& registry, host::Services& services,
                   const toile_limits& limits, host::Job& job, std::size_t wanted, bool color,
                   Pictures& out) {
    constexpr std::size_t kMostRead = 600;
    constexpr std::size_t kMostKept = 64;
    pipeline::SensorSource source(uri, registry, services, limits, job);
    const std::size_t first = out.streams.size();
    out.streams.insert(out.streams.end(), source.streams().begin(), source.streams().end());
    const auto count = static_cast<std::uint32_t>(source.streams().size());
    std::vector<std::vector<pipeline::SensorFrame>> frames;
    bool more = true;
    std::size_t every = 1; // which are kept
    for (std::size_t read = 0; more && read < kMostRead && !job.cancelled(); ++read) {
        std::vector<pipeline::SensorFrame> instant(count);
        for (std::uint32_t c = 0; c < count && more; ++c) {
            int waits = 0;
            while (!source.next(c, instant[c])) {
                more = !source.ended(c) && ++waits < 5000;
                if (!more) break;
                usleep(1000); // a live sensor has no new picture yet
            }
            if (!color) instant[c].color = {};
        }
        if (more && read % every == 0) frames.push_back(std::move(instant));
        if (frames.size() > kMostKept) {
            halve(frames);
            every *= 2;
        }
        if (wanted == 1 && frames.size() == 1) break;
    }
    if (frames.empty()) throw Error(uri + ": gave no frame");
    const std::size_t used = std::min(wanted, frames.size());
    if (first == 0)
        out.instants.resize(used);
    else if (out.instants.size() != used)
        throw Error(uri + ": has fewer frames than the other cameras");
    for (std::size_t i = 0; i < used; ++i) {
        const std::size_t at = used == 1 ? 0 : i * (frames.size() - 1) / (used - 1);
        for (auto& frame : frames[at])
            out.instants[i].push_back(std::move(frame));
    }
}

} // namespace

void add_fit_input(CLI::App& command, FitInput& input) {
    command
        .add_option("--scan", input.scan, "A mesh or a point cloud; unit and way up are guessed")
        ->type_name("FILE");
    command
        .add_option("--source", input.sources,
                    "Cameras, once for each: capture:DIR, simulated:SCENARIO.json")
        ->type_name("URI");
    command.add_option("--frames", input.frames,
                       "How many frames of a source are used, spread over it (1; dressed: 5)");
    command.add_option("--sex", input.sex, "Whose population to expect; without, the likelier one")
        ->check(CLI::IsMember({"female", "male"}));
    command.add_flag("--dressed", input.dressed,
                     "The person wears clothes: the body is looked for beneath them");
}

pipeline::FittedBody fit_body(const FitInput& input, const GlobalOptions& global) {
    if (input.scan.empty() == input.sources.empty())
        throw UsageError("name either --scan FILE or --source URI");
    if (input.frames > kMostFrames)
        throw UsageError("--frames " + std::to_string(input.frames) + ": at most 20 are of use");
    host::catch_interrupts();
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    const bool terminal = isatty(STDERR_FILENO) != 0;
    host::Job job(
        [terminal](double share, std::string_view) {
            if (terminal) std::fprintf(stderr, "\rfitting %3.0f %%", 100.0 * share);
        },
        &host::interrupt_flag());
    const toile_limits limits = limits_of(global, services, kScannedPerson);
    pipeline::BodyFit fit(registry, services, limits);
    if (!input.scan.empty()) {
        const assets::ColoredMesh scan = assets::load_colored_mesh(input.scan);
        fit.feed_scan(scan.mesh, job, scan.colors);
    } else {
        Pictures pictures;
        const std::uint32_t wanted =
            input.frames > 0 ? input.frames : (input.dressed ? kDressedFrames : 1);
        for (const std::string& uri : input.sources)
            read_pictures(uri, registry, services, limits, job, wanted, input.dressed, pictures);
        fit.begin_cameras(pictures.streams, job);
        for (const auto& instant : pictures.instants)
            fit.feed_frames(instant);
    }
    pipeline::FitRequest request;
    request.dressed = input.dressed;
    if (!input.sex.empty())
        request.sex = input.sex == "female" ? body::Sex::female : body::Sex::male;
    auto out = fit.fit(request, job);
    if (terminal) std::fputs("\r", stderr);
    return out;
}

body::BodyFile body_file_of(const pipeline::FittedBody& fitted) {
    const auto space = body::BodySpace::load(body::find_avatar(fitted.model));
    body::BodyFile out;
    out.model = fitted.model;
    out.model_version = space.model().version;
    out.made_by = "fit";
    const std::string sex = fitted.report.value("sex", "");
    if (!sex.empty()) out.sex = sex == "female" ? body::Sex::female : body::Sex::male;
    out.coefficients = fitted.coefficients;
    out.detail = body::detail_of(space, fitted.coefficients, fitted.rest, fitted.skeleton);
    out.pose = fitted.pose;
    for (const auto& [name, length] : fitted.measurements)
        out.measurements[name] = {length.value_m, length.confidence};
    out.fit = fitted.report;
    return out;
}

} // namespace toile::apps
