// Rules of toile.body_source/1.
#include "host/contract_bench.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace toile::host {
namespace {

using PluginPtr = std::shared_ptr<const Plugin>;

constexpr int kMostFrames = 3000;
constexpr const char* kNoSchemes = nullptr;

toile_body_source_info describe(Bench& bench) {
    auto info = sized<toile_body_source_info>();
    bench.ok("describe",
             [&](auto* i) { return bench.table<toile_body_source>().describe(i, &info); });
    return info;
}

toile_body_source_setup setup_for(const CapsuleFigure& figure, const std::string& uri) {
    auto out = sized<toile_body_source_setup>();
    out.uri = uri.c_str();
    out.body = &figure.abi();
    out.max_people = 1;
    return out;
}

void describes_itself(const PluginPtr& plugin) {
    Bench bench(plugin);
    const toile_body_source_info info = describe(bench);
    bench.rule(info.input >= TOILE_SOURCE_FRAMES && info.input <= TOILE_SOURCE_OWN,
               "describe: an unknown kind of input");
    std::size_t count = 0;
    for (; info.schemes != nullptr && info.schemes[count] != nullptr; ++count)
        bench.rule(plugin->manifest().serves_scheme(info.schemes[count]),
                   "describe: the scheme '" + std::string(info.schemes[count]) +
                       "' is not in the manifest");
    bench.rule(count == plugin->manifest().schemes.size(),
               "describe: lacks a scheme that the manifest promises");
    // An older host's struct ends after `input`.
    auto older = sized<toile_body_source_info>();
    older.size = offsetof(toile_body_source_info, schemes);
    const char* const* const untouched = &kNoSchemes;
    older.schemes = untouched;
    bench.ok("describe into an older struct",
             [&](auto* i) { return bench.table<toile_body_source>().describe(i, &older); });
    bench.rule(older.size == offsetof(toile_body_source_info, schemes) &&
                   older.schemes == untouched,
               "describe: writes beyond the size that the struct has");
}

void refuses_bad_sources(const PluginPtr& plugin) {
    Bench bench(plugin);
    if (describe(bench).input != TOILE_SOURCE_OWN) return;
    bench.activate();
    const CapsuleFigure figure;
    const auto begin = [&](const std::string& uri) {
        return [&bench, &figure, uri](toile_instance* i) {
            const toile_body_source_setup setup = setup_for(figure, uri);
            return bench.table<toile_body_source>().begin(i, &setup, nullptr);
        };
    };
    bench.fails("begin", "without a setup", [&](auto* i) {
        return bench.table<toile_body_source>().begin(i, nullptr, nullptr);
    });
    bench.fails("begin", "for a file that is not there", begin("/no/such/file.contract"));
    bench.fails("begin", "for a folder", begin("/"));
    bench.fails("begin", "for an empty file", begin("/dev/null"));
    bench.fails("begin", "for a program instead of a recording", begin("/proc/self/exe"));
}

// Bytes of every person of every frame of the plugin's own sample.
std::vector<float> play(const PluginPtr& plugin, const std::string& sample, std::uint32_t threads) {
    Bench bench(plugin, threads);
    bench.activate();
    const auto& table = bench.table<toile_body_source>();
    const CapsuleFigure figure;
    const toile_body_source_setup setup = setup_for(figure, sample);
    Job job;
    bench.ok("begin", [&](auto* i) { return table.begin(i, &setup, job.handle()); });
    std::vector<float> out;
    std::int64_t last_ns = INT64_MIN;
    toile_status status = TOILE_OK;
    for (int frame = 0; frame < kMostFrames && status != TOILE_END_OF_STREAM; ++frame) {
        status = bench.ok("feed", [&](auto* i) { return table.feed(i, nullptr); });
        if (status != TOILE_OK) continue;
        std::vector<toile_joint> joints(TOILE_JOINT_COUNT);
        auto person = sized<toile_person>();
        person.joints = view_mut(joints);
        Longer<toile_person> people(person);
        std::uint32_t count = 1;
        bench.ok("result", [&](auto* i) { return table.result(i, people.get(), &count); });
        bench.rule(count <= 1, "result: gives more people than there is room for");
        if (count == 0) continue;
        const toile_body_state& state = people.get()->state;
        bench.rule(state.person_id != 0, "result: gives the person the id 0");
        bench.rule(state.tracking >= TOILE_TRACKING_DETECTED &&
                       state.tracking <= TOILE_TRACKING_LOST,
                   "result: an unknown tracking state");
        bench.rule(state.timestamp_ns >= last_ns, "result: time runs backwards");
        last_ns = state.timestamp_ns;
        for (const toile_joint& joint : joints) {
            const auto values = std::span(joint.position, sizeof(toile_joint) / sizeof(float));
            bench.finite("result", values);
            const float* r = joint.rotation;
            bench.rule(std::abs(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] - 1) < 1e-3f,
                       "result: a rotation that is not a unit quaternion");
            out.insert(out.end(), values.begin(), values.end());
        }
    }
    bench.ok("feed", [&](auto* i) { return status = table.feed(i, nullptr); });
    bench.rule(status == TOILE_END_OF_STREAM, "feed: goes on after the end of the recording");
    table.end(bench.instance().handle());
    return out;
}

void plays_its_sample(const PluginPtr& plugin) {
    const Bench bench(plugin);
    if (plugin->manifest().sample.empty()) return;
    const std::string sample = plugin->manifest().sample.string();
    const auto once = play(plugin, sample, 1);
    bench.rule(!once.empty(), "result: gives nobody in the plugin's own sample");
    const auto again = play(plugin, sample, 2);
    bench.rule(once.size() == again.size() &&
                   std::memcmp(once.data(), again.data(), once.size() * sizeof(float)) == 0,
               "result: two runs give different bytes");
}

/// A camera of 64 x 48 pixels, 1 m above a floor.
toile_stream small_camera() {
    auto out = sized<toile_stream>();
    out.depth = {64, 48, 58.0, 58.0, 31.5, 23.5, {}};
    for (const int i : {0, 5, 10, 15})
        out.color_from_depth[i] = out.world_from_camera[i] = 1.0;
    out.world_from_camera[13] = 1.0;
    out.has_world = out.registered = 1;
    out.frame_period_s = 1.0 / 30.0;
    return out;
}

/// What broken cameras send: nothing, zeros, the farthest, the nearest, noise.
std::vector<std::vector<float>> broken_pictures() {
    constexpr std::size_t kPixels = 64 * 48;
    std::vector<std::vector<float>> out;
    for (const float depth : {std::nanf(""), 0.0f, 65.535f, 0.01f, -1.0f, HUGE_VALF})
        out.emplace_back(kPixels, depth);
    auto& noise = out.emplace_back(kPixels);
    for (std::size_t i = 0; i < kPixels; ++i)
        noise[i] = 0.5f + static_cast<float>(i * 2654435761u % 7919) / 1600.0f;
    return out;
}

void feeds_one(Bench& bench, const std::vector<float>& depth, std::uint32_t sequence) {
    auto frame = sized<toile_frame>();
    frame.sequence = sequence;
    frame.timestamp_ns = 33'333'333ll * sequence;
    frame.depth_m = view_of(depth);
    auto input = sized<toile_body_source_input>();
    input.frame_count = 1;
    input.frames = &frame;
    bench.ok("feed", [&](auto* i) { return bench.table<toile_body_source>().feed(i, &input); });
}

void begin_with_small_camera(Bench& bench) {
    const auto& table = bench.table<toile_body_source>();
    const toile_stream stream = small_camera();
    auto setup = sized<toile_body_source_setup>();
    setup.uri = "";
    setup.stream_count = 1;
    setup.streams = &stream;
    setup.max_people = 2;
    Job job;
    bench.ok("begin", [&](auto* i) { return table.begin(i, &setup, job.handle()); });
}

void survives_broken_pictures(const PluginPtr& plugin) {
    Bench bench(plugin);
    if (describe(bench).input != TOILE_SOURCE_FRAMES) return;
    bench.activate();
    const auto& table = bench.table<toile_body_source>();
    const std::vector<float> some(64 * 48, 2.0f), short_one(64 * 47, 2.0f);
    auto frame = sized<toile_frame>();
    frame.depth_m = view_of(some);
    auto input = sized<toile_body_source_input>();
    input.frame_count = 1;
    input.frames = &frame;
    bench.fails("feed", "before begin", [&](auto* i) { return table.feed(i, &input); });
    begin_with_small_camera(bench);
    frame.depth_m = view_of(short_one);
    bench.fails("feed", "with a picture of another size than announced",
                [&](auto* i) { return table.feed(i, &input); });
    std::uint32_t sequence = 0;
    for (const auto& picture : broken_pictures()) {
        feeds_one(bench, picture, ++sequence);
        std::vector<toile_joint> joints(TOILE_JOINT_COUNT);
        auto person = sized<toile_person>();
        person.state.size = sizeof(person.state);
        person.joints = view_mut(joints);
        std::uint32_t count = 1;
        bench.ok("result", [&](auto* i) { return table.result(i, &person, &count); });
        bench.rule(count <= 1, "result: gives more people than there is room for");
        for (const toile_joint& joint : joints)
            bench.finite("result", std::span(joint.position, sizeof(toile_joint) / sizeof(float)));
    }
    table.end(bench.instance().handle());
}

void labels_pixels(const PluginPtr& plugin) {
    Bench bench(plugin);
    const auto* labels = bench.instance().find<toile_part_labels>();
    if (labels == nullptr || describe(bench).input != TOILE_SOURCE_FRAMES) return;
    bench.activate();
    const auto& table = bench.table<toile_body_source>();
    const std::vector<float> some(64 * 48, 2.0f);
    auto frame = sized<toile_frame>();
    frame.depth_m = view_of(some);
    const auto ask = [&](std::size_t parts_count, std::size_t people_count) {
        return [&, parts_count, people_count](toile_instance* i) {
            std::vector<std::uint8_t> parts(parts_count), people(people_count);
            auto out = sized<toile_part_picture>();
            out.parts = view_mut(parts);
            out.people = view_mut(people);
            return labels->labels(i, &frame, &out);
        };
    };
    bench.fails("labels", "before begin", ask(64 * 48, 64 * 48));
    begin_with_small_camera(bench);
    bench.fails("labels", "into a picture of another size", ask(64 * 47, 0));
    bench.fails("labels", "with people of another size", ask(64 * 48, 64));
    std::uint32_t sequence = 0;
    for (const auto& picture : broken_pictures()) {
        feeds_one(bench, picture, ++sequence);
        frame.depth_m = view_of(picture);
        frame.sequence = sequence;
        Guarded<std::uint8_t> parts(picture.size()), people(picture.size());
        auto out = sized<toile_part_picture>();
        out.parts = parts.view();
        out.people = people.view();
        bench.ok("labels", [&](auto* i) { return labels->labels(i, &frame, &out); });
        bench.rule(parts.intact() && people.intact(), "labels: writes beyond the pictures");
        const auto told = parts.rows(), whose = people.rows();
        for (std::size_t i = 0; i < told.size(); ++i) {
            bench.rule(told[i] <= TOILE_PART_NECK, "labels: an unknown body part");
            bench.rule((told[i] == 0) == (whose[i] == 0) && whose[i] <= 2,
                       "labels: parts of nobody, or somebody without a part");
        }
    }
    table.end(bench.instance().handle());
}

constexpr ContractCase kCases[] = {
    {TOILE_BODY_SOURCE, "body_source: describes its input and schemes", &describes_itself},
    {TOILE_BODY_SOURCE, "body_source: bad sources are refused with a text", &refuses_bad_sources},
    {TOILE_BODY_SOURCE, "body_source: its sample plays to the end, twice the same",
     &plays_its_sample},
    {TOILE_BODY_SOURCE, "body_source: broken camera pictures are refused or survived",
     &survives_broken_pictures},
    {TOILE_BODY_SOURCE, "body_source: labels of pixels fill the pictures and name known parts",
     &labels_pixels},
};

} // namespace

std::span<const ContractCase> body_source_cases() {
    return kCases;
}

} // namespace toile::host
