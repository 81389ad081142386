// toile track: people before a depth camera, as joints frame by frame.
#include "apps/commands.h"
#include "apps/label_folder.h"
#include "apps/picture_folder.h"
#include "apps/plugin_limits.h"
#include "apps/run_output.h"
#include "apps/track_picture.h"
#include "core/bytes.h"
#include "core/error.h"
#include "host/job.h"
#include "pipeline/people_source.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

namespace toile::apps {
namespace {

struct TrackOptions {
    std::string source, out, pictures, labels, report;
    std::uint32_t people = 1;
    std::uint64_t frames = 0;
    bool realtime = false, smoothing = true;
};

constexpr std::uint32_t kMostPeople = 6;

/// Counts what is said at the end.
struct TrackCounts {
    std::uint64_t frames = 0, with_people = 0, tracked = 0, dropped = 0;
    std::map<std::uint32_t, std::uint64_t> people; ///< frames of each id
    std::uint32_t last_sequence = 0;

    void add(const pipeline::PeopleFrame& frame) {
        if (frames > 0 && frame.sequence > last_sequence + 1)
            dropped += frame.sequence - last_sequence - 1;
        last_sequence = frame.sequence;
        ++frames;
        bool any = false, sure = false;
        for (const pipeline::BodyFrame& person : frame.people) {
            if (person.tracking == TOILE_TRACKING_LOST) continue;
            ++people[person.person_id];
            any = true;
            sure = sure || person.tracking != TOILE_TRACKING_UNCERTAIN;
        }
        with_people += any ? 1 : 0;
        tracked += sure ? 1 : 0;
    }
};

void write_track_report(const TrackOptions& options, const GlobalOptions& global,
                        const pipeline::PeopleSource& source, const TrackCounts& counts) {
    if (options.report.empty()) return;
    const pipeline::Quantiles time = source.tracking_time().quantiles();
    nlohmann::ordered_json json;
    json["frames"] = counts.frames;
    json["dropped"] = counts.dropped;
    json["frames_with_people"] = counts.with_people;
    json["frames_tracked"] = counts.tracked;
    for (const auto& [id, frames] : counts.people)
        json["people"][std::to_string(id)]["frames"] = frames;
    json["stages"]["source"] = {
        {"median_ms", time.median_ms}, {"p95_ms", time.p95_ms}, {"max_ms", time.max_ms}};
    json["versions"] = {{"toile", TOILE_VERSION}, {"tracker", source.tracker_id()}};
    json["seed"] = global.seed;
    write_text(options.report, json.dump(2) + "\n");
}

void track(const TrackOptions& options, const GlobalOptions& global) {
    if (options.people < 1 || options.people > kMostPeople)
        throw UsageError("track --people must be 1 to " + std::to_string(kMostPeople));
    host::catch_interrupts();
    host::Services services(global.threads);
    host::Registry registry(services, registry_options(global));
    host::Job job({}, &host::interrupt_flag());
    pipeline::PeopleSource source(options.source, registry, services,
                                  limits_of(global, services, kSensedScene, options.realtime),
                                  {options.people, nullptr, options.smoothing, {}}, job);
    TrackFile track = TrackFile::named(options.out);
    std::optional<PictureFolder> folder;
    std::optional<TrackPicture> picture;
    if (!options.pictures.empty()) {
        folder.emplace(options.pictures);
        picture.emplace(source);
    }
    std::optional<LabelFolder> labels;
    if (!options.labels.empty()) labels.emplace(options.labels, source, options.people);
    RunProgress progress;
    TrackCounts counts;
    pipeline::PeopleFrame frame;
    while (!source.ended() && !host::interrupt_flag()) {
        if (options.frames > 0 && counts.frames >= options.frames) break;
        if (!source.next(frame)) {
            if (!source.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        counts.add(frame);
        track.add(frame.sequence, frame.timestamp_ns, frame.people);
        if (labels) labels->add(source);
        if (picture) folder->add(picture->draw(frame));
        progress.frame();
    }
    if (counts.frames == 0) throw Error(options.source + ": gave no frame");
    if (folder) folder->make_film("track", track.frames_per_second());
    write_track_report(options, global, source, counts);
    const pipeline::Quantiles time = source.tracking_time().quantiles();
    std::printf("%s: %llu frames, %llu with somebody, %zu people; %.1f ms a frame (95 %%: %.1f)\n",
                options.out.c_str(), static_cast<unsigned long long>(counts.frames),
                static_cast<unsigned long long>(counts.with_people), counts.people.size(),
                time.median_ms, time.p95_ms);
}

} // namespace

void add_track_commands(CLI::App& app, const GlobalOptions& global) {
    CLI::App* command = app.add_subcommand("track", "Follows people before a depth camera");
    const auto options = std::make_shared<TrackOptions>();
    command
        ->add_option("--source", options->source,
                     "Where the pictures come from: openni2: (a camera, its number or FILE.oni), "
                     "capture:DIR, simulated:SCENARIO.json")
        ->type_name("URI")
        ->required();
    command->add_option("--out", options->out, "File for the track, a line a frame")
        ->type_name("track.jsonl")
        ->required();
    command->add_option("--people", options->people, "How many are followed at most, 1 to 6")
        ->capture_default_str();
    command->add_option("--frames", options->frames, "Stops after this many");
    command->add_flag("--realtime", options->realtime,
                      "Keeps to the source's time and drops late frames");
    command->add_flag("!--no-smoothing", options->smoothing,
                      "Joints as each frame shows them, without the filter and its lag");
    command
        ->add_option("--pictures", options->pictures,
                     "Folder for pictures of bones and bodies over what the camera saw, and a film")
        ->type_name("DIR");
    command
        ->add_option("--labels", options->labels,
                     "Folder for pictures of the body part that each pixel shows, and labels.json, "
                     "which says what their values mean")
        ->type_name("DIR");
    command->add_option("--report", options->report, "File for the figures of the run, as JSON")
        ->type_name("FILE");
    command->footer("Example: toile track --source capture:captures/anna --out track.jsonl\n"
                    "         toile track --source openni2: --people 2 --out track.jsonl "
                    "--pictures look");
    command->callback([options, &global] { track(*options, global); });
}

} // namespace toile::apps
